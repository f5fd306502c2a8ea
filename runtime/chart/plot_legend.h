// The legend of a plot: its series, and the sentences that explain its marks, as SVG elements.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <string>

#include "runtime/chart/plot.h"

namespace fathom::runtime {

// The legend from `top` downwards.
struct Legend {
  std::string svg;
  double height = 0;
};
Legend draw_legend(const Plot& plot, double top);

}  // namespace fathom::runtime
