#include "runtime/chart/plot_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "runtime/chart/log_axis.h"
#include "runtime/chart/markup.h"
#include "runtime/chart/plot_draw.h"
#include "runtime/chart/plot_legend.h"
#include "runtime/chart/plot_panel.h"

namespace fathom::runtime {
namespace {

constexpr double kPanelTop = 88, kPanelHeight = 330, kPanelGap = 28;
constexpr double kPadding = 20;  // pixels around the data, so that the largest discs stay inside
constexpr double kBelowPanels = 62, kFooter = 24, kBottom = 12;

// Returns the values that an axis must hold. Ends of bars count only if they are positive.
std::vector<double> shown_values(const Plot& plot, double PlotPoint::*value, std::optional<Range> PlotPoint::*range,
                                 bool levels) {
  std::vector<double> values;
  const auto add_positive = [&](double end) {
    if (end > 0) values.push_back(end);
  };
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotSeries& series : panel.series) {
      if (levels && series.level) values.push_back(*series.level);
      for (const PlotPoint& point : series.points) {
        if (!LogAxis::can_show(point.x) || !LogAxis::can_show(point.y)) continue;
        values.push_back(point.*value);
        if (!(point.*range)) continue;
        add_positive((point.*range)->lo);
        add_positive((point.*range)->hi);
      }
    }
  }
  return values;
}

// Draws the arrow and the words that tell in which direction points are better.
std::string draw_direction(glm::dvec2 right) {
  const glm::dvec2 tip = right - glm::dvec2{11, -1};
  return draw_text(tip - glm::dvec2{6, 1}, "lower left is better", {kTickSize, kSoftInk, "end", false, false}) +
         fmt::format("<path d=\"M{0} {1}l10 -10M{0} {2}v6h6\" fill=\"none\" stroke=\"{3}\" stroke-width=\"1.3\"/>\n",
                     coordinate(tip.x), coordinate(tip.y), coordinate(tip.y - 6), kSoftInk);
}

std::string draw_titles(const Plot& plot, double panels_bottom) {
  const double middle_x = (kLeft + kPlotWidth - kRight) / 2, middle_y = (kPanelTop + panels_bottom) / 2;
  const TextStyle axis_style{13, kInk, "middle", false, false};
  return draw_text({kLeft, 27}, plot.title, {17, kInk, "start", true, false}) +
         draw_text({kLeft, 48}, plot.subtitle, {12.5, kSoftInk, "start", false, false}) +
         draw_direction({kPlotWidth - kRight, 27}) +
         draw_text({middle_x, panels_bottom + 42}, plot.x_title, axis_style) +
         fmt::format("<g transform=\"translate(22 {}) rotate(-90)\">{}</g>\n", coordinate(middle_y),
                     draw_text({0, 0}, plot.y_title, axis_style));
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, plot.panels.size()));
  const double width = (kPlotWidth - kLeft - kRight - (count - 1) * kPanelGap) / count;
  const LogAxis x(shown_values(plot, &PlotPoint::x, &PlotPoint::x_range, false), width, kPadding);
  const LogAxis y(shown_values(plot, &PlotPoint::y, &PlotPoint::y_range, true), kPanelHeight, kPadding);
  const double bottom = kPanelTop + kPanelHeight;
  std::string body = draw_titles(plot, bottom);
  double left = kLeft;
  for (const PlotPanel& panel : plot.panels) {
    body += draw_panel(panel, {{left, kPanelTop}, {left + width, bottom}}, x, y, &panel == &plot.panels.front());
    left += width + kPanelGap;
  }
  const Legend legend = draw_legend(plot, bottom + kBelowPanels);
  double end = bottom + kBelowPanels + legend.height;
  if (!plot.footer.empty()) {
    end += kFooter;
    body += draw_text({kLeft, end - 4}, plot.footer, {kLabelSize, kSoftInk, "start", false, false});
  }
  const std::string height = coordinate(end + kBottom);
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
             "role=\"img\" "
             "aria-label=\"{2}\" font-family=\"system-ui, sans-serif\">\n"
             "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
             coordinate(kPlotWidth), height, escape_markup(plot.title)) +
         body + legend.svg + "</svg>\n";
}

}  // namespace fathom::runtime
