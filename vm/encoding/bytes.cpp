#include "vm/encoding/bytes.h"

#include <bit>

namespace fathom::vm {

void ByteWriter::little_endian(std::uint64_t value, int count) {
  std::uint8_t bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
  bytes_.insert(bytes_.end(), bytes, bytes + count);  // one insert, for speed: films are hundreds of megabytes
}

void ByteWriter::f64(double value) { u64(std::bit_cast<std::uint64_t>(value)); }

void ByteWriter::text(std::string_view text) {
  u32(static_cast<std::uint32_t>(text.size()));
  bytes_.insert(bytes_.end(), text.begin(), text.end());
}

void ByteWriter::raw(std::span<const std::uint8_t> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

std::uint64_t ByteReader::little_endian(int count) {
  const std::span<const std::uint8_t> bytes = raw(static_cast<std::size_t>(count));
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
  return value;
}

double ByteReader::f64() { return std::bit_cast<double>(u64()); }

std::string ByteReader::text(std::size_t most) {
  const std::size_t size = u32();
  if (size > most) fail();
  const std::span<const std::uint8_t> bytes = raw(size);
  return {bytes.begin(), bytes.end()};
}

std::span<const std::uint8_t> ByteReader::raw(std::size_t count) {
  if (failed_ || count > left()) {
    failed_ = true;
    return {};
  }
  at_ += count;
  return bytes_.subspan(at_ - count, count);
}

std::size_t ByteReader::count(std::size_t least) {
  const std::size_t count = u32();
  if (failed_ || count > left() / least) {
    failed_ = true;
    return 0;
  }
  return count;
}

}  // namespace fathom::vm
