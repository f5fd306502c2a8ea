#include "vm/encoding/printable.h"

#include <fmt/format.h>

namespace fathom::vm {
namespace {

// Returns the number of bytes of the UTF-8 character that begins the text, a control character or not, or 0 when the
// text begins with no UTF-8 character. Source: RFC 3629, section 4.
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

bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0) < 0x20 || byte(0) == 0x7F;
  return character.size() == 2 && byte(0) == 0xC2 && byte(1) < 0xA0;
}

}  // namespace

std::size_t printable_length(std::string_view text) {
  const std::size_t length = character_length(text);
  return is_control(text.substr(0, length)) ? 0 : length;
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
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = printable_length(text.substr(at));
    if (length > 0 || text[at] == '\n') {
      out += text.substr(at, length > 0 ? length : 1);
    } else {
      out += "\uFFFD";
    }
    at += length > 0 ? length : 1;
  }
  return out;
}

std::string escape_controls(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text.substr(at));
    const std::string_view character = text.substr(at, length);
    if (length == 0) {
      out += "\uFFFD";
    } else if (is_control(character) && character != "\n" && character != "\t") {
      out += fmt::format("\\u{:04x}", unsigned{static_cast<unsigned char>(character.back())});
    } else {
      out += character;
    }
    at += length > 0 ? length : 1;
  }
  return out;
}

}  // namespace fathom::vm
