#include "vm/encoding/escape.h"

#include <fmt/format.h>

#include <charconv>

namespace fathom::vm {
namespace {

// First and last of the control characters U+0080 to U+009F, in UTF-8.
constexpr std::string_view kFirstC1 = "\xC2\x80", kLastC1 = "\xC2\x9F";
constexpr std::string_view kLetters = "nrt\\\"", kMeanings = "\n\r\t\\\"";

std::string escape(std::string_view text, bool quotes) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (const std::size_t known = kMeanings.find(c); known != kMeanings.npos && (quotes || c != '"')) {
      out += '\\';
      out += kLetters[known];
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else if (text.substr(i, 2) >= kFirstC1 && text.substr(i, 2) <= kLastC1) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(text[++i])));
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

std::string escape(std::string_view text) { return escape(text, false); }

std::string quote(std::string_view text) { return '"' + escape(text, true) + '"'; }

std::size_t quoted_length(std::string_view line) {
  for (std::size_t i = 1; i < line.size() && line[i] != '\n'; ++i) {
    if (line[i] == '"') return i + 1;
    if (line[i] == '\\') ++i;
  }
  return 0;
}

bool unescape(std::string_view text, std::string& out) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      out += text[i];
      continue;
    }
    if (++i == text.size()) return false;
    if (const std::size_t known = kLetters.find(text[i]); known != kLetters.npos) {
      out += kMeanings[known];
    } else {
      unsigned code = 0;
      const std::string_view digits = text.substr(std::min(i + 1, text.size()), 4);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
      if (text[i] != 'u' || digits.size() != 4 || error != std::errc() || end != digits.data() + 4 ||
          (code >= 0x20 && code < 0x7f) || code > 0x9f) {
        return false;
      }
      if (code > 0x7f) out += kFirstC1[0];
      out += static_cast<char>(code);
      i += 4;
    }
  }
  return true;
}

}  // namespace fathom::vm
