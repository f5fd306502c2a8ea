// A logarithmic axis: maps values to pixels and places ticks.
//
// A logarithmic scale has no position for 0, but measured errors are sometimes 0. An axis with zeros has a slot
// before its lowest value, separated by a break, in which all zeros are drawn.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <span>
#include <string>
#include <vector>

namespace fathom::runtime {

struct Tick {
  double value = 0;
  bool labelled = false;
};

class LogAxis {
 public:
  // Makes an axis of `length` pixels that holds the values at least `padding` pixels from its ends. The axis spans at
  // least one decade. Zeros among the values give the axis a slot for zeros. Negative and non-finite values are
  // ignored.
  LogAxis(std::span<const double> values, double length, double padding);

  // Returns the pixels from the axis's low end, or the middle of the slot for 0. `value` is 0, or positive and
  // finite.
  double position(double value) const;

  // Returns the ticks, ascending and positive: every decade, and between decades 2 and 5 or 2 to 9 as far as they
  // fit. Labels are at least `label_room` pixels apart.
  std::vector<Tick> ticks(double label_room) const;

  bool has_zero() const { return has_zero_; }
  double length() const { return length_; }
  double break_position() const;  // pixels; end of the slot for zeros, 0 without a slot

  static bool can_show(double value);

 private:
  double low_ = 0, decades_ = 1;  // log10 of the scale's lowest value; decades that the scale spans
  double begin_ = 0, length_;     // pixels; the scale is [begin, length]
  bool has_zero_ = false;
};

// Text of a tick: a plain number, or mantissa and power of ten.
struct TickLabel {
  std::string text;   // `200`, `10`, `5×10`
  std::string power;  // the exponent; empty for a plain number
};

// Returns the labels in the order of the ticks, empty for unlabelled ticks. Numbers are plain if all of them are
// short, else all are powers.
std::vector<TickLabel> tick_labels(std::span<const Tick> ticks);

}  // namespace fathom::runtime
