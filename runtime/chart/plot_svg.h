// Plots with logarithmic axes as SVG texts. plot.h says what a plot is.
//
// Every point is drawn: 0 in a slot behind the axis's end, as a diamond; points whose coordinates are negative or not
// finite are counted beside the panel's title.
//
// The text is the same for the same plot on every machine, has no ids, styles or scripts, and may stand within HTML.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <string>

#include "runtime/chart/plot.h"

namespace fathom::runtime {

std::string plot_svg(const Plot& plot);

}  // namespace fathom::runtime
