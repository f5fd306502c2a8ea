#include "vm/encoding/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace fathom::vm {
namespace {

bool is_control(char32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

bool is_hidden(char32_t code) {
  constexpr std::array<std::array<char32_t, 2>, 6> kRanges = {
      {{0x061C, 0x061C}, {0x200B, 0x200B}, {0x200E, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x2069}, {0xFEFF, 0xFEFF}}};
  return is_control(code) ||
         std::ranges::any_of(kRanges, [&](const auto& range) { return code >= range[0] && code <= range[1]; });
}

std::string escaped(char32_t code) { return fmt::format("\\u{:04x}", static_cast<std::uint32_t>(code)); }

}  // namespace

// Source: RFC 3629, section 4.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool beyond = (first == 0xED && byte(1) >= 0xA0) || (first == 0xF4 && byte(1) >= 0x90);
  return overlong || beyond ? 0 : length;
}

std::optional<char32_t> hidden_code(std::string_view character) {
  if (character.empty() || character.size() > 3) return std::nullopt;
  char32_t code = static_cast<unsigned char>(character[0]);
  if (character.size() > 1) code &= character.size() == 2 ? 0x1F : 0x0F;
  for (const char next : character.substr(1)) code = code << 6 | (static_cast<unsigned char>(next) & 0x3F);
  return is_hidden(code) ? std::optional(code) : std::nullopt;
}

std::size_t printable_length(std::string_view text) {
  const std::size_t length = character_length(text);
  return hidden_code(text.substr(0, length)) ? 0 : length;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t at = 0, length; at < text.size(); at += std::max<std::size_t>(length, 1)) {
    length = character_length(text.substr(at));
    const std::string_view character = text.substr(at, length);
    const auto code = hidden_code(character);
    if (code && !is_control(*code)) {
      out += escaped(*code);
    } else if (length == 0 || (code && character != "\n")) {
      for (std::size_t i = 0; i < std::max<std::size_t>(length, 1); ++i) out += "\uFFFD";
    } else {
      out += character;
    }
  }
  return out;
}

std::string escape_controls(std::string_view text) {
  std::string out;
  for (std::size_t at = 0, length; at < text.size(); at += std::max<std::size_t>(length, 1)) {
    length = character_length(text.substr(at));
    const std::string_view character = text.substr(at, length);
    const auto code = hidden_code(character);
    if (length == 0) {
      out += "\uFFFD";
    } else if (code && character != "\n" && character != "\t") {
      out += escaped(*code);
    } else {
      out += character;
    }
  }
  return out;
}

}  // namespace fathom::vm
