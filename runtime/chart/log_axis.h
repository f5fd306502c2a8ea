// A logarithmic axis: values to pixels, and where its ticks are.
//
// Zero has no place on a logarithmic scale, yet errors are 0 now and then. An axis that is asked for one has a slot
// before its lowest value, behind a break, where all zeros are drawn.
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
  // An axis of `length` pixels that holds the values, `padding` pixels from its ends or farther. It spans a decade or
  // more. Values that are 0 give it the slot for zeros; what is negative or not finite is not looked at.
  LogAxis(std::span<const double> values, double length, double padding);

  // Pixels from the axis's low end: for 0 the middle of the slot. The value is 0, or positive and finite.
  double position(double value) const;

  // Ascending, positive; every decade, and between them what there is room for: 2 and 5, or 2 to 9. Labels are
  // `label_room` pixels apart or more.
  std::vector<Tick> ticks(double label_room) const;

  bool has_zero() const { return has_zero_; }
  double length() const { return length_; }
  double break_position() const;  // between the slot and the scale, pixels; there is a slot

  static bool can_show(double value);

 private:
  double low_ = 0, decades_ = 1;  // log10 of the value at the scale's low end, and how many decades it spans
  double begin_ = 0, length_;     // pixels; the scale is [begin, length]
  bool has_zero_ = false;
};

// How a tick is written: as a plain number, or as mantissa and power of ten.
struct TickLabel {
  std::string text;   // `200`, `10`, `5×10`
  std::string power;  // the exponent; empty for a plain number
};

// The labels of the ticks in their order, empty where there is none: plain numbers where all are short, else powers.
std::vector<TickLabel> tick_labels(std::span<const Tick> ticks);

}  // namespace fathom::runtime
