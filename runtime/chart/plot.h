// A plot as data: panels side by side that share both axes' scales and one legend. plot_svg.h draws it.
//
// A series is a polyline through its points; a point may carry bars, a disc whose area grows with how often it fails,
// and a label where there is room.
//
// Colours to choose from are those of M. Okabe, K. Ito, "Color Universal Design", 2008, which the colour-blind tell
// apart. Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fathom::runtime {

// Without the yellow, which is too light for lines on white; the first is for what the plot is about.
inline constexpr std::array kPalette = {"#D55E00", "#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"};
inline constexpr const char* kNeutralColor = "#4d4d4d";

struct Range {
  double lo = 0, hi = 0;
};

struct PlotPoint {
  double x = 0, y = 0;
  std::optional<Range> x_range, y_range;  // bars
  double failures_ppm = 0;                // the disc's area, by logarithm; 0: no disc
  bool ringed = false;
  std::string label;    // a few characters
  std::string tooltip;  // the numbers, lines by '\n'
};

struct PlotSeries {
  std::string name;  // in the legend, once for all panels
  std::string color;
  bool hollow = false;      // its markers
  bool dashed = false;      // its line
  bool emphasised = false;  // drawn last and bold
  std::vector<PlotPoint> points;
  std::optional<double> level;  // a dashed horizontal line
};

struct PlotPanel {
  std::string title;
  std::vector<PlotSeries> series;
  std::vector<PlotPoint> front;  // corners of a staircase, ascending in x, descending in y; what is beyond is shaded
};

// Sentences of the legend are shown where the plot has what they explain.
struct Plot {
  std::string title, subtitle;
  std::string x_title, y_title;  // with units
  std::vector<PlotPanel> panels;
  std::string footer;  // small, at the end
  std::string disc_words, ring_words, front_words, bar_words, level_words;
};

}  // namespace fathom::runtime
