// Numbers and texts as bytes, little endian on every machine: what the files that programs and renders are kept in
// are made of. What is read may come from a stranger: a reader never leaves its bytes, and after the first failure
// gives zeros.
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
  void text(std::string_view text);  // u32 bytes, then these
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
  // Fails when it is longer than `most` bytes.
  std::string text(std::size_t most);
  std::span<const std::uint8_t> raw(std::size_t count);
  // A number of things that take `least` bytes each or more; fails when there is no room for so many, so that
  // nothing is set aside for what is not there.
  std::size_t count(std::size_t least);

  void fail() { failed_ = true; }  // what was read makes no sense
  bool failed() const { return failed_; }
  std::size_t offset() const { return at_; }  // of the next byte; after a failure of the last one that was there
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::uint64_t little_endian(int count);

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace fathom::vm
