// Draws plots with logarithmic axes as SVG. plot.h describes the plot.
//
// Every point is drawn. A coordinate of 0 is a diamond in a slot beyond the axis's low end. Points with a negative or
// non-finite coordinate are counted next to the panel's title.
//
// The text is the same for the same plot on every machine, has no ids, styles or scripts, and may be embedded in
// HTML.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <string>

#include "runtime/chart/plot.h"

namespace fathom::runtime {

std::string plot_svg(const Plot& plot);

}  // namespace fathom::runtime
