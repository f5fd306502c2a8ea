// Sizes and marks that panels, legend and titles share, as SVG elements. Lengths are in pixels, y downwards.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <string_view>

#include "runtime/chart/log_axis.h"
#include "runtime/chart/plot.h"

namespace fathom::runtime {

inline constexpr double kPlotWidth = 960;
inline constexpr double kLeft = 78, kRight = 20;                                  // margins of the panels
inline constexpr double kTickSize = 11.5, kLabelSize = 10.5, kLegendSize = 12.5;  // font sizes
inline constexpr double kMarkerRadius = 3.4, kBoldMarkerRadius = 4.6, kRingRadius = 7.2;
inline constexpr const char* kInk = "#1a1a1a";
inline constexpr const char* kSoftInk = "#666666";
inline constexpr const char* kFrontColor = "#8c8c8c";

// Returns an upper bound of the text's width, for the widest of the usual fonts.
double text_width(std::string_view text, double size, bool bold = false);

struct TextStyle {
  double size = kTickSize;
  const char* color = kInk;
  const char* anchor = "start";  // also "middle", "end"
  bool bold = false;
  bool halo = false;  // white outline around the letters
};
std::string draw_text(glm::dvec2 at, std::string_view text, const TextStyle& style);
std::string draw_tick_label(glm::dvec2 at, const TickLabel& label, const TextStyle& style);

// `attributes` are inserted into the element unchanged.
std::string draw_line(glm::dvec2 from, glm::dvec2 to, std::string_view color, double width,
                      std::string_view attributes = "");
std::string draw_circle(glm::dvec2 at, double radius, std::string_view attributes);

// Returns the radius in pixels of the disc for a failure rate, at most a million ppm. The disc's area is proportional
// to log10(1 + ppm).
double disc_radius(double failures_ppm);
std::string draw_disc(glm::dvec2 at, double failures_ppm, std::string_view color);
std::string draw_ring(glm::dvec2 at);
// Draws the series' marker, which is a diamond if `zero`.
std::string draw_marker(const PlotSeries& series, glm::dvec2 at, bool zero);

}  // namespace fathom::runtime
