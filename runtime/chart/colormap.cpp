#include "runtime/chart/colormap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "runtime/chart/markup.h"
#include "vm/number/decimal.h"

namespace fathom::runtime {
namespace {

constexpr Rgb kViridis[] = {{0x44, 0x01, 0x54}, {0x48, 0x25, 0x76}, {0x41, 0x44, 0x87}, {0x35, 0x60, 0x8d},
                            {0x2a, 0x78, 0x8e}, {0x21, 0x90, 0x8c}, {0x22, 0xa8, 0x84}, {0x43, 0xbf, 0x71},
                            {0x7a, 0xd1, 0x51}, {0xbb, 0xdf, 0x27}, {0xfd, 0xe7, 0x25}};

// A character of the numbers on the scale: 5 by 7 pixels, rows from the top, the leftmost pixel in bit 4.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 7> rows;
};
constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kAdvance = 6;
constexpr Glyph kGlyphs[] = {
    {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}}, {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'2', {0x0e, 0x11, 0x01, 0x06, 0x08, 0x10, 0x1f}}, {'3', {0x0e, 0x11, 0x01, 0x06, 0x01, 0x11, 0x0e}},
    {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}}, {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}}, {'7', {0x1f, 0x01, 0x02, 0x04, 0x04, 0x04, 0x04}},
    {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}}, {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}}, {'-', {0x00, 0x00, 0x00, 0x0e, 0x00, 0x00, 0x00}},
    {'e', {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e}}, {'n', {0x00, 0x00, 0x16, 0x19, 0x11, 0x11, 0x11}},
    {'a', {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f}},
};

int width_of(std::string_view text) { return static_cast<int>(text.size()) * kAdvance - 1; }

void paint(ByteImage& picture, int x, int y, const Rgb& color) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
  std::copy(color.begin(), color.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(at));
}

void fill(ByteImage& picture, int left, int top, int width, int height, const Rgb& color) {
  for (int y = top; y < top + height; ++y) {
    for (int x = left; x < left + width; ++x) paint(picture, x, y, color);
  }
}

void write(ByteImage& picture, int left, int top, std::string_view text, const Rgb& color) {
  for (const char letter : text) {
    for (const Glyph& glyph : kGlyphs) {
      if (glyph.letter != letter) continue;
      for (int y = 0; y < kGlyphHeight; ++y) {
        for (int x = 0; x < kGlyphWidth; ++x) {
          if (glyph.rows[static_cast<std::size_t>(y)] >> (kGlyphWidth - 1 - x) & 1)
            paint(picture, left + x, top + y, color);
        }
      }
    }
    left += kAdvance;
  }
}

constexpr Rgb kPaper{255, 255, 255}, kLabelInk{40, 40, 40};
constexpr int kMargin = 8, kBarHeight = 12, kBoxWidth = 18, kNarrowest = 160;
constexpr int kBarTop = 5, kTickHeight = 3, kTextGap = 2;

// Returns the smallest 1, 2 or 5 times a power of ten that is not less than `value`.
double round_up(double value) {
  const double power = vm::real::power_of_ten(vm::real::decimal_exponent(value));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

// Returns the numbers on the strip, about `most` of them: every n-th decade on a logarithmic scale, multiples of 1, 2
// or 5 times a power of ten on a linear one.
std::vector<double> marks_of(const ColorScale& scale, int most) {
  std::vector<double> marks;
  if (scale.logarithmic) {
    const double lo = vm::real::log10(scale.lo), hi = vm::real::log10(scale.hi);
    const int stride = std::max(1, static_cast<int>(std::ceil((hi - lo) / most)));
    for (int decade = static_cast<int>(std::ceil(lo - 1e-9)); decade <= hi + 1e-9; decade += stride) {
      marks.push_back(vm::real::power_of_ten(decade));
    }
    return marks;
  }
  const double step = round_up((scale.hi - scale.lo) / most);
  const double first = std::ceil(scale.lo / step - 1e-9), last = scale.hi / step + 1e-9;
  for (double i = first; i <= last; ++i) marks.push_back(i * step + 0.0);  // turns -0 into 0
  return marks;
}

// Draws a box of one colour with its name below. Returns the left end of the next element.
int draw_box(ByteImage& picture, int left, int top, const Rgb& color, std::string_view name) {
  fill(picture, left, top + kBarTop, kBoxWidth, kBarHeight, color);
  write(picture, left + (kBoxWidth - width_of(name)) / 2, top + kBarTop + kBarHeight + kTickHeight + kTextGap, name,
        kLabelInk);
  return left + kBoxWidth + kMargin;
}

void draw_scale(ByteImage& picture, int top, const ColorScale& scale) {
  fill(picture, 0, top, picture.width, kScaleHeight, kPaper);
  const bool named = picture.width >= kNarrowest;
  int left = kMargin;
  if (named) left = draw_box(picture, left, top, kMissing, "nan");
  if (named && scale.logarithmic) left = draw_box(picture, left, top, kNothing, "0");
  const int width = picture.width - kMargin - left;
  for (int x = 0; x < width; ++x) {
    fill(picture, left + x, top + kBarTop, 1, kBarHeight, viridis(width > 1 ? x / (width - 1.0) : 0));
  }
  if (!named) return;
  const double lo = scale.logarithmic ? vm::real::log10(scale.lo) : scale.lo;
  const double hi = scale.logarithmic ? vm::real::log10(scale.hi) : scale.hi;
  for (const double mark : marks_of(scale, std::max(1, width / 48))) {
    const double at = ((scale.logarithmic ? vm::real::log10(mark) : mark) - lo) / (hi - lo);
    const int x = left + static_cast<int>(std::lround(at * (width - 1)));
    const std::string text = readable(mark);
    const int text_left = std::clamp(x - width_of(text) / 2, left, picture.width - 2 - width_of(text));
    fill(picture, x, top + kBarTop + kBarHeight, 1, kTickHeight, kLabelInk);
    write(picture, text_left, top + kBarTop + kBarHeight + kTickHeight + kTextGap, text, kLabelInk);
  }
}

}  // namespace

Rgb viridis(double fraction) {
  const std::size_t last = std::size(kViridis) - 1;
  const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(last);
  const auto below = std::min(last - 1, static_cast<std::size_t>(place));
  const double part = place - static_cast<double>(below);
  Rgb color{};
  for (std::size_t i = 0; i < 3; ++i) {
    color[i] =
        static_cast<std::uint8_t>(std::lround((1 - part) * kViridis[below][i] + part * kViridis[below + 1][i]));
  }
  return color;
}

Rgb ColorScale::color(double value) const {
  if (std::isnan(value)) return kMissing;
  if (!logarithmic) return viridis((value - lo) / (hi - lo));
  if (value <= 0) return kNothing;
  return viridis((vm::real::log10(value) - vm::real::log10(lo)) / (vm::real::log10(hi) - vm::real::log10(lo)));
}

ColorScale scale_for(std::span<const float> values, bool logarithmic) {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (const float value : values) {
    if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
    lo = std::min(lo, static_cast<double>(value));
    hi = std::max(hi, static_cast<double>(value));
  }
  if (logarithmic) {
    if (lo > hi) return {true, 1, 10};
    const auto low = static_cast<int>(std::floor(vm::real::log10(lo) + 1e-6));
    const auto high = static_cast<int>(std::ceil(vm::real::log10(hi) - 1e-6));
    return {true, vm::real::power_of_ten(low), vm::real::power_of_ten(std::max(high, low + 1))};
  }
  if (lo > hi || (lo == 0 && hi == 0)) return {false, 0, 1};
  return {false, lo < 0 ? -round_up(-lo) : 0, hi > 0 ? round_up(hi) : 0};
}

ByteImage draw_map(std::span<const float> values, int width, int height, const ColorScale& scale) {
  if (width < 1 || height < 1 ||
      values.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::invalid_argument(
        fmt::format("a map of {} x {} pixels cannot have {} values", width, height, values.size()));
  }
  ByteImage picture{width, height + kScaleHeight, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(picture.height));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Rgb color = scale.color(static_cast<double>(values[i]));
    std::copy(color.begin(), color.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  draw_scale(picture, height, scale);
  return picture;
}

}  // namespace fathom::runtime
