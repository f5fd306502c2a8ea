// The legend of a plot: the series, and the sentences that explain the marks, as SVG elements.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <string>

#include "runtime/chart/plot.h"

namespace fathom::runtime {

// The legend's SVG, drawn from `top` downwards, and its height in pixels.
struct Legend {
  std::string svg;
  double height = 0;
};
Legend draw_legend(const Plot& plot, double top);

}  // namespace fathom::runtime
