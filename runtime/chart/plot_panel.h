// One panel of a plot: grid, front, discs, lines, markers and labels, as SVG elements.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <string>

#include "runtime/chart/label_layout.h"
#include "runtime/chart/log_axis.h"
#include "runtime/chart/plot.h"

namespace fathom::runtime {

// Draws the panel into `area`. The axes are shared by all panels, and only the `first` panel labels the y axis.
std::string draw_panel(const PlotPanel& panel, const Rectangle& area, const LogAxis& x, const LogAxis& y, bool first);

}  // namespace fathom::runtime
