#include "runtime/chart/log_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "runtime/chart/markup.h"
#include "vm/number/decimal.h"

namespace fathom::runtime {
namespace {

constexpr double kZeroSlot = 26;           // pixels
constexpr double kRoomForTwoAndFive = 28;  // pixels per decade from which grid lines at 2 and 5 fit
constexpr double kRoomForAll = 90;         // pixels per decade from which grid lines at 2 to 9 fit
constexpr double kAxisEdge = 1e-9;             // decades; tolerance for ticks at the ends of the axis

TickLabel power_label(double value) {
  const std::string text = scientific(value);  // for example `1e-3`, `5e-3`
  const std::size_t e = text.find('e');
  const std::string mantissa = text.substr(0, e), power = text.substr(e + 1);
  return {mantissa == "1" ? "10" : mantissa + "×10", power[0] == '-' ? "−" + power.substr(1) : power};
}

}  // namespace

bool LogAxis::can_show(double value) { return value >= 0 && std::isfinite(value); }

LogAxis::LogAxis(std::span<const double> values, double length, double padding) : length_(length) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!can_show(value)) continue;
    if (value == 0) {
      has_zero_ = true;
    } else {
      low = std::min(low, vm::real::log10(value));
      high = std::max(high, vm::real::log10(value));
    }
  }
  if (low > high) low = high = 0;
  const double widening = std::max(0.0, 1 - (high - low)) / 2;
  low -= widening;
  high += widening;
  begin_ = has_zero_ ? kZeroSlot : 0;
  const double decades_per_pixel = (high - low) / (length - begin_ - 2 * padding);
  low_ = low - padding * decades_per_pixel;
  decades_ = (length - begin_) * decades_per_pixel;
}

double LogAxis::position(double value) const {
  if (value == 0) return begin_ / 2;
  return begin_ + (vm::real::log10(value) - low_) / decades_ * (length_ - begin_);
}

double LogAxis::break_position() const { return begin_; }

std::vector<Tick> LogAxis::ticks(double label_room) const {
  const double pixels_per_decade = (length_ - begin_) / decades_;
  // The narrowest gaps between 1, 2, 5 and 10 are from 1 to 2 and from 5 to 10.
  const bool label_between = pixels_per_decade * vm::real::log10(2.0) >= label_room;
  const int stride = std::max(1, static_cast<int>(std::ceil(label_room / pixels_per_decade)));
  std::vector<Tick> ticks;
  for (int decade = static_cast<int>(std::floor(low_)); decade <= low_ + decades_ + kAxisEdge; ++decade) {
    for (int digit = 1; digit <= 9; ++digit) {
      const bool two_or_five = digit == 2 || digit == 5;
      const double room = digit == 1 ? 0 : two_or_five ? kRoomForTwoAndFive : kRoomForAll;
      if (pixels_per_decade < room) continue;
      const double at = decade + vm::real::log10(digit) - low_;
      if (at < -kAxisEdge || at > decades_ + kAxisEdge) continue;
      // Parsing "1e-5" gives the nearest double. A computed power of ten may be off by one unit in the last place.
      const std::string text = fmt::format("{}e{}", digit, decade);
      double value = 0;
      if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc()) continue;
      const bool labelled = digit == 1 ? decade % stride == 0 : two_or_five && label_between;
      ticks.push_back({value, labelled});
    }
  }
  return ticks;
}

std::vector<TickLabel> tick_labels(std::span<const Tick> ticks) {
  bool plain = true;
  for (const Tick& tick : ticks) plain &= !tick.labelled || (tick.value >= 0.001 && tick.value < 1e6);
  std::vector<TickLabel> labels;
  for (const Tick& tick : ticks) {
    if (!tick.labelled) {
      labels.push_back({"", ""});
    } else if (plain) {
      labels.push_back({tick.value < 1000 ? readable(tick.value) : grouped(std::llround(tick.value)), ""});
    } else {
      labels.push_back(power_label(tick.value));
    }
  }
  return labels;
}

}  // namespace fathom::runtime
