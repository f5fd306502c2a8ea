#include "runtime/chart/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::runtime {
namespace {

// Shortens an exponent: `2.5e-06` becomes `2.5e-6`.
std::string plain_exponent(const std::string& text) {
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const std::size_t digits = std::min(text.find_first_not_of("+-0", exponent + 1), text.size() - 1);
  return text.substr(0, exponent + 1) + (text[exponent + 1] == '-' ? "-" : "") + text.substr(digits);
}

}  // namespace

std::string escape_markup(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      case '\t':
      case '\n':
      case '\r':
        escaped += c;
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20) {
          escaped += "\xef\xbf\xbd";
        } else {
          escaped += c;
        }
    }
  }
  return escaped;
}

std::string coordinate(double number) {
  std::string text = fmt::format("{:.2f}", number);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string readable(double number) {
  if (std::isnan(number)) return "?";
  const double size = std::abs(number);
  if (size >= 999.5 && size < 1e7) return fmt::format("{:.0f}", number);
  return plain_exponent(fmt::format("{:.3g}", number));
}

std::string grouped(std::int64_t count) {
  std::string text = fmt::format("{}", count);
  const std::size_t first = count < 0 ? 1 : 0;
  for (std::size_t end = text.size(); end > first + 3;) {
    end -= 3;
    text.insert(end, "\u00a0");
  }
  return text;
}

std::string scientific(double number) {
  if (std::isnan(number)) return "?";
  std::string text = fmt::format("{:.2e}", number);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  std::size_t end = text.find_last_not_of('0', exponent - 1);
  if (text[end] != '.') ++end;
  return plain_exponent(text.erase(end, exponent - end));
}

}  // namespace fathom::runtime
