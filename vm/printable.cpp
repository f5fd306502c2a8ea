#include "vm/printable.h"

namespace fathom::vm {

std::size_t printable_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x20 || byte(0) == 0x7F) return 0;
  const std::size_t length = byte(0) < 0x80         ? 1
                             : (byte(0) >> 5) == 6  ? 2
                             : (byte(0) >> 4) == 14 ? 3
                             : (byte(0) >> 3) == 30 ? 4
                                                    : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return length == 2 && byte(0) == 0xC2 && byte(1) < 0xA0 ? 0 : length;
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

}  // namespace fathom::vm
