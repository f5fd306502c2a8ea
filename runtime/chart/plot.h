// A plot as data: panels side by side that share both axes and one legend. plot_svg.h draws it.
//
// A series is a polyline through its points. A point may have bars, a disc whose area grows with its failures, and a
// label where space permits.
//
// The colours are those of M. Okabe, K. Ito, "Color Universal Design", 2008, which colour-blind readers can tell
// apart.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace fathom::runtime {

// Okabe and Ito's colours without yellow, which is too light for lines on white. The first colour is for the subject
// of the plot.
inline constexpr std::array kPalette = {"#D55E00", "#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"};
inline constexpr const char* kNeutralColor = "#4d4d4d";

struct Range {
  double lo = 0, hi = 0;
};

struct PlotPoint {
  double x = 0, y = 0;
  std::optional<Range> x_range, y_range;  // error bars
  double failures_ppm = 0;                // disc area grows with its logarithm; 0: no disc
  bool ringed = false;
  std::string label;    // a few characters
  std::string tooltip;  // the numbers, lines separated by '\n'
};

struct PlotSeries {
  std::string name;  // legend entry, shared by all panels
  std::string color;
  bool hollow = false;      // markers without fill
  bool dashed = false;      // dashed polyline
  bool emphasised = false;  // drawn last and bold
  std::vector<PlotPoint> points;
  std::optional<double> level;  // a dashed horizontal line
};

struct PlotPanel {
  std::string title;
  std::vector<PlotSeries> series;
  // Corners of a staircase, ascending in x and descending in y. The region beyond is shaded.
  std::vector<PlotPoint> front;
};

// The legend shows a *_words sentence only if the plot contains the marks that the sentence explains.
struct Plot {
  std::string title, subtitle;
  std::string x_title, y_title;  // with units
  std::vector<PlotPanel> panels;
  std::string footer;  // small, at the end
  std::string disc_words, ring_words, front_words, bar_words, level_words;
};

}  // namespace fathom::runtime
