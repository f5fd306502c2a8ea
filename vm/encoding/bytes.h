// Numbers and texts as bytes, little endian on every machine: the encoding of program and film files. The bytes of a
// reader may be hostile: a reader never reads outside them, and returns zeros after the first failure.
//
//     ByteWriter out;              ByteReader in(out.bytes());
//     out.u32(7);                  const std::uint32_t seven = in.u32();
//     out.text("ball");            const std::string name = in.text(64);
//                                  if (in.failed()) ...   // at in.offset()
//
// Tested by: tests/vm/encoding/bytes_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fathom::vm {

class ByteWriter {
 public:
  void u8(std::uint8_t value) { bytes_.push_back(value); }
  void u32(std::uint32_t value) { little_endian(value, 4); }
  void u64(std::uint64_t value) { little_endian(value, 8); }
  void f64(double value);
  void text(std::string_view text);  // the size in bytes as u32, then the bytes
  void raw(std::span<const std::uint8_t> bytes);

  std::size_t size() const { return bytes_.size(); }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  void little_endian(std::uint64_t value, int count);

  std::vector<std::uint8_t> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(little_endian(4)); }
  std::uint64_t u64() { return little_endian(8); }
  double f64();
  // Reads a text; fails when the text is longer than `most` bytes.
  std::string text(std::size_t most);
  std::span<const std::uint8_t> raw(std::size_t count);
  // Reads a count of items that take at least `least` bytes each. Fails when fewer bytes are left than the items
  // need, so that callers never allocate memory for missing items.
  std::size_t count(std::size_t least);

  void fail() { failed_ = true; }  // for bytes that the caller finds invalid
  bool failed() const { return failed_; }
  std::size_t offset() const { return at_; }  // of the next byte; stays there after a failure
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::uint64_t little_endian(int count);

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace fathom::vm
