#include "vm/encoding/escape.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>

#include "vm/encoding/printable.h"

namespace fathom::vm {
namespace {

constexpr std::string_view kLetters = "nrt\\\"", kMeanings = "\n\r\t\\\"";

// Encodes a character of at most three bytes.
std::string to_utf8(unsigned code) {
  const auto next = [&](unsigned shift) { return static_cast<char>(0x80 | (code >> shift & 0x3F)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xC0 | code >> 6), next(0)};
  return {static_cast<char>(0xE0 | code >> 12), next(6), next(0)};
}

std::string escape(std::string_view text, bool quotes) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (const std::size_t known = kMeanings.find(c); known != kMeanings.npos && (quotes || c != '"')) {
      out += '\\';
      out += kLetters[known];
    } else if (const std::size_t length = character_length(text.substr(i));
               const auto code = hidden_code(text.substr(i, length))) {
      out += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(*code));
      i += length - 1;
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
          !hidden_code(to_utf8(code))) {
        return false;
      }
      out += to_utf8(code);
      i += 4;
    }
  }
  return true;
}

}  // namespace fathom::vm
