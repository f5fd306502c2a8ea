#include "compiler/frontend/records/color_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "compiler/frontend/records/css_colors.h"
#include "compiler/scene/srgb.h"

namespace fathom::compiler {
namespace {

constexpr std::string_view kHexDigits = "0123456789abcdef";

// A channel of this size is probably a byte. A smaller channel above 1 may be a linear value that is too large.
constexpr double kMinByte = 16;

// Returns the value of a hexadecimal digit of either case, or npos for other characters.
std::size_t hex_digit(char c) { return kHexDigits.find(c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c); }

const NamedColor* find_css(std::string_view name) {
  const auto* const found = std::ranges::lower_bound(kCssColors, name, {}, &NamedColor::name);
  return found != std::end(kCssColors) && found->name == name ? found : nullptr;
}

bool is_parameter(std::string_view name, const Scope& scope) {
  return std::ranges::any_of(scope.entries(), [&](const auto& entry) { return entry.parameter.name == name; });
}

}  // namespace

bool is_color_text(const syntax::Value& value, ValueType type, const Scope& scope) {
  const auto* text = std::get_if<std::string>(&value.data);
  if (text == nullptr || (type != ValueType::Color && type != ValueType::Background)) return false;
  return text->starts_with('#') || (find_css(*text) && !is_parameter(*text, scope));
}

std::optional<syntax::Value> read_color_text(const syntax::Value& value, Diagnostics& diagnostics) {
  const NamedColor* const named = find_css(std::get<std::string>(value.data));
  const std::string code = named ? fmt::format("#{:06x}", named->code) : std::get<std::string>(value.data);
  const std::string_view digits = std::string_view(code).substr(1);
  const bool all_hex =
      std::all_of(digits.begin(), digits.end(), [](char c) { return hex_digit(c) != kHexDigits.npos; });
  if (!all_hex || (digits.size() != 3 && digits.size() != 6)) {
    diagnostics.error("E0101", value.span, "a colour in hexadecimal has three or six digits", "",
                      {"write red, green and blue as \"#rrggbb\" or \"#rgb\": \"#c04020\", \"#c42\""});
    return std::nullopt;
  }
  syntax::List channels;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t byte =
        digits.size() == 3 ? 17 * hex_digit(digits[i]) : 16 * hex_digit(digits[2 * i]) + hex_digit(digits[2 * i + 1]);
    channels.push_back({value.span, srgb_decode(static_cast<double>(byte) / 255)});
  }
  return syntax::Value{value.span, std::move(channels)};
}

std::string color_text_of(const syntax::Value& value) {
  const auto channels = std::holds_alternative<syntax::List>(value.data) ? three_numbers(value) : std::nullopt;
  if (!channels) return "";
  bool bytes = false;
  for (int i = 0; i < 3; ++i) {
    const double channel = (*channels)[i];
    if (!(channel >= 0 && channel <= 255) || channel != std::floor(channel)) return "";
    bytes = bytes || channel >= kMinByte;
  }
  if (!bytes) return "";
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(channels->r), static_cast<int>(channels->g),
                     static_cast<int>(channels->b));
}

}  // namespace fathom::compiler
