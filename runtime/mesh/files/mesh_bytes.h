// Bytes of mesh files: numbers in little-endian order, and names without characters that a format reserves.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::runtime {

class MeshBytes {
 public:
  void byte(std::uint8_t value) { bytes_.push_back(value); }
  void u16(std::uint16_t value) { byte(value & 0xff), byte(static_cast<std::uint8_t>(value >> 8)); }
  void u32(std::uint32_t value) {
    u16(static_cast<std::uint16_t>(value & 0xffff));
    u16(static_cast<std::uint16_t>(value >> 16));
  }
  void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
  void f32(double value) { f32(static_cast<float>(value)); }
  void text(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  void pad(std::size_t multiple, std::uint8_t with) {
    while (bytes_.size() % multiple != 0) byte(with);
  }
  std::size_t size() const { return bytes_.size(); }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

inline std::vector<std::uint8_t> to_bytes(std::string_view text) { return {text.begin(), text.end()}; }

// Returns the name with `_` in place of blanks, control characters, `#`, which begins a comment, and `\`, which joins
// lines, for formats of words.
inline std::string word_of(std::string_view name, std::string_view if_empty) {
  std::string word(name.empty() ? if_empty : name);
  for (char& c : word) {
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f || c == '#' || c == '\\') c = '_';
  }
  return word;
}

}  // namespace fathom::runtime
