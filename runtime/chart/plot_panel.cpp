#include "runtime/chart/plot_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <vector>

#include "runtime/chart/markup.h"
#include "runtime/chart/plot_draw.h"

namespace fathom::runtime {
namespace {

constexpr const char* kGrid = "#e4e4e4";
constexpr const char* kMinorGrid = "#f3f3f3";
constexpr const char* kAxisColor = "#9a9a9a";

bool can_show(const PlotPoint& point) { return LogAxis::can_show(point.x) && LogAxis::can_show(point.y); }
bool can_show(const Range& range) { return LogAxis::can_show(range.lo) && LogAxis::can_show(range.hi); }
bool is_zero(const PlotPoint& point) { return point.x == 0 || point.y == 0; }

std::string with_tooltip(const PlotPoint& point, const std::string& svg) {
  return fmt::format("<g class=\"point\"><title>{}</title>\n{}</g>\n", escape_markup(point.tooltip), svg);
}

// SVG path data of a polyline: `solid` between points on the scale, `dotted` to and from points in a slot for zeros.
struct Polyline {
  std::string solid, dotted;
};

class PanelDrawing {
 public:
  PanelDrawing(const PlotPanel& panel, const Rectangle& area, const LogAxis& x, const LogAxis& y)
      : panel_(panel), area_(area), x_(x), y_(y) {
    // Emphasised series are drawn last, over the others.
    for (const PlotSeries& series : panel.series) series_.push_back(&series);
    std::stable_partition(series_.begin(), series_.end(), [](const PlotSeries* s) { return !s->emphasised; });
  }

  std::string grid(bool labels_of_y) const;
  std::string title() const;
  std::string front() const;
  std::string discs() const;
  std::string lines() const;
  std::string markers() const;
  std::string labels() const;

 private:
  double left(double value) const { return area_.lo.x + x_.position(value); }
  double top(double value) const { return area_.hi.y - y_.position(value); }
  glm::dvec2 at(const PlotPoint& point) const { return {left(point.x), top(point.y)}; }
  // An end of a bar that is 0 is drawn where the scale begins.
  double bar_left(double x) const { return x > 0 ? left(x) : area_.lo.x + x_.break_position(); }
  double bar_top(double y) const { return y > 0 ? top(y) : area_.hi.y - y_.break_position(); }

  std::string x_grid() const;
  std::string y_grid(bool labels) const;
  Polyline polyline(const PlotSeries& series) const;
  std::string bars(const PlotSeries& series) const;
  LabelLayout obstacles() const;

  const PlotPanel& panel_;
  const Rectangle& area_;
  const LogAxis& x_;
  const LogAxis& y_;
  std::vector<const PlotSeries*> series_;
};

std::string PanelDrawing::x_grid() const {
  std::string svg;
  const TextStyle style{kTickSize, kSoftInk, "middle", false, false};
  const std::vector<Tick> ticks = x_.ticks(38);
  const std::vector<TickLabel> labels = tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double x = left(ticks[i].value);
    svg += draw_line({x, area_.lo.y}, {x, area_.hi.y}, ticks[i].labelled ? kGrid : kMinorGrid, 1);
    if (ticks[i].labelled) svg += draw_tick_label({x, area_.hi.y + 17}, labels[i], style);
  }
  if (x_.has_zero()) {
    const double end = area_.lo.x + x_.break_position();
    svg += draw_line({end, area_.lo.y}, {end, area_.hi.y}, kAxisColor, 0.8, R"(stroke-dasharray="1 3")");
    svg += draw_text({left(0), area_.hi.y + 17}, "0", style);
  }
  return svg;
}

std::string PanelDrawing::y_grid(bool labels) const {
  std::string svg;
  const TextStyle style{kTickSize, kSoftInk, "end", false, false};
  const std::vector<Tick> ticks = y_.ticks(20);
  const std::vector<TickLabel> texts = tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double y = top(ticks[i].value);
    svg += draw_line({area_.lo.x, y}, {area_.hi.x, y}, ticks[i].labelled ? kGrid : kMinorGrid, 1);
    if (ticks[i].labelled && labels) svg += draw_tick_label({area_.lo.x - 8, y + 4}, texts[i], style);
  }
  if (y_.has_zero()) {
    const double end = area_.hi.y - y_.break_position();
    svg += draw_line({area_.lo.x, end}, {area_.hi.x, end}, kAxisColor, 0.8, R"(stroke-dasharray="1 3")");
    if (labels) svg += draw_text({area_.lo.x - 8, top(0) + 4}, "0", style);
  }
  return svg;
}

std::string PanelDrawing::grid(bool labels_of_y) const {
  return x_grid() + y_grid(labels_of_y) +
         draw_line({area_.lo.x, area_.lo.y}, {area_.lo.x, area_.hi.y}, kAxisColor, 1) +
         draw_line({area_.lo.x, area_.hi.y}, {area_.hi.x, area_.hi.y}, kAxisColor, 1);
}

std::string PanelDrawing::title() const {
  std::string missing;
  int count = 0;
  for (const PlotSeries* series : series_) {
    for (const PlotPoint& point : series->points) {
      if (can_show(point)) continue;
      ++count;
      missing += fmt::format("{}{} {}", missing.empty() ? "" : ", ", series->name, point.label);
    }
  }
  std::string svg = draw_text({area_.lo.x, area_.lo.y - 10}, panel_.title, {13.5, kInk, "start", true, false});
  if (count == 0) return svg;
  return svg + fmt::format("<g class=\"missing\"><title>{}</title>\n{}</g>\n", escape_markup(missing),
                           draw_text({area_.hi.x, area_.lo.y - 10}, fmt::format("{} not measured", count),
                                     {kLabelSize, kSoftInk, "end", false, false}));
}

std::string PanelDrawing::front() const {
  std::string steps;
  for (const PlotPoint& corner : panel_.front) {
    if (!can_show(corner)) continue;
    if (steps.empty()) steps = fmt::format("M{} {}", coordinate(left(corner.x)), coordinate(area_.lo.y));
    steps += fmt::format("H{}V{}", coordinate(left(corner.x)), coordinate(top(corner.y)));
  }
  if (steps.empty()) return "";
  steps += fmt::format("H{}", coordinate(area_.hi.x));
  return fmt::format("<path d=\"{}V{}Z\" fill=\"#000000\" fill-opacity=\"0.035\"/>\n", steps,
                     coordinate(area_.lo.y)) +
         fmt::format("<path class=\"front\" d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1\"/>\n", steps,
                     kFrontColor);
}

std::string PanelDrawing::discs() const {
  std::string svg;
  for (const PlotSeries* series : series_) {
    for (const PlotPoint& point : series->points) {
      if (!can_show(point) || !(point.failures_ppm > 0)) continue;
      svg += with_tooltip(point, draw_disc(at(point), point.failures_ppm, series->color));
    }
  }
  return svg;
}

Polyline PanelDrawing::polyline(const PlotSeries& series) const {
  Polyline line;
  const PlotPoint* last = nullptr;
  for (const PlotPoint& point : series.points) {
    if (!can_show(point)) continue;
    if (last) {
      std::string& path = is_zero(point) || is_zero(*last) ? line.dotted : line.solid;
      path += fmt::format("M{} {}L{} {}", coordinate(at(*last).x), coordinate(at(*last).y), coordinate(at(point).x),
                          coordinate(at(point).y));
    }
    last = &point;
  }
  return line;
}

std::string PanelDrawing::bars(const PlotSeries& series) const {
  constexpr double kCap = 3;
  std::string svg;
  const auto bar = [&](glm::dvec2 from, glm::dvec2 to, glm::dvec2 cap) {
    svg += draw_line(from, to, series.color, 1, R"(stroke-opacity="0.8")");
    for (const glm::dvec2 end : {from, to}) {
      svg += draw_line(end - cap, end + cap, series.color, 1, R"(stroke-opacity="0.8")");
    }
  };
  for (const PlotPoint& point : series.points) {
    if (!can_show(point)) continue;
    const glm::dvec2 middle = at(point);
    if (point.x_range && can_show(*point.x_range)) {
      bar({bar_left(point.x_range->lo), middle.y}, {bar_left(point.x_range->hi), middle.y}, {0, kCap});
    }
    if (point.y_range && can_show(*point.y_range)) {
      bar({middle.x, bar_top(point.y_range->lo)}, {middle.x, bar_top(point.y_range->hi)}, {kCap, 0});
    }
  }
  return svg;
}

std::string PanelDrawing::lines() const {
  std::string svg;
  for (const PlotSeries* series : series_) {
    if (series->level && LogAxis::can_show(*series->level)) {
      const double y = top(*series->level);
      svg += draw_line({area_.lo.x, y}, {area_.hi.x, y}, series->color, 1.2,
                       R"(class="level" stroke-dasharray="7 4" stroke-opacity="0.75")");
    }
    svg += bars(*series);
    const auto path = [&](const std::string& d, const char* dashes) {
      if (d.empty()) return;
      svg +=
          fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\"{}/>\n",
                      d, series->color, series->emphasised ? "2.6" : "1.4", dashes);
    };
    const Polyline line = polyline(*series);
    path(line.solid, series->dashed ? R"( stroke-dasharray="5 4")" : "");
    path(line.dotted, R"( stroke-dasharray="0.5 4")");
  }
  return svg;
}

std::string PanelDrawing::markers() const {
  std::string svg;
  for (const PlotSeries* series : series_) {
    for (const PlotPoint& point : series->points) {
      if (!can_show(point)) continue;
      svg += with_tooltip(
          point, (point.ringed ? draw_ring(at(point)) : "") + draw_marker(*series, at(point), is_zero(point)));
    }
  }
  return svg;
}

// Returns a label layout that keeps clear of all markers and, where possible, of the lines.
LabelLayout PanelDrawing::obstacles() const {
  LabelLayout layout(area_);
  const auto avoid = [&](const std::vector<PlotPoint>& points, bool markers) {
    const PlotPoint* last = nullptr;
    for (const PlotPoint& point : points) {
      if (!can_show(point)) continue;
      const glm::dvec2 here = at(point), reach{kMarkerRadius + 2};
      if (markers) layout.block({here - reach, here + reach});
      if (last) layout.avoid_segment(at(*last), here);
      last = &point;
    }
  };
  for (const PlotSeries* series : series_) avoid(series->points, true);
  if (panel_.front.empty() || !can_show(panel_.front.front()) || !can_show(panel_.front.back())) return layout;
  const glm::dvec2 first = at(panel_.front.front()), last = at(panel_.front.back());
  layout.avoid_segment({first.x, area_.lo.y}, first);
  layout.avoid_segment(last, {area_.hi.x, last.y});
  return layout;
}

// Places labels by rank: the emphasised series first, then the ends of every series, then the points between. Skips a
// label if an equal one is nearby.
std::string PanelDrawing::labels() const {
  struct Wish {
    const PlotSeries* series;
    const PlotPoint* point;
    int rank;
  };
  std::vector<Wish> wishes;
  for (const PlotSeries* series : series_) {
    for (const PlotPoint& point : series->points) {
      if (!can_show(point) || point.label.empty()) continue;
      const bool end = &point == &series->points.front() || &point == &series->points.back();
      wishes.push_back({series, &point, series->emphasised ? 0 : end ? 1 : 2});
    }
  }
  std::stable_sort(wishes.begin(), wishes.end(), [](const Wish& a, const Wish& b) { return a.rank < b.rank; });
  LabelLayout layout = obstacles();
  std::vector<Wish> placed;
  std::string svg;
  for (const Wish& wish : wishes) {
    constexpr double kClose = 36;  // pixels
    const bool said = std::any_of(placed.begin(), placed.end(), [&](const Wish& other) {
      return other.point->label == wish.point->label && glm::distance(at(*other.point), at(*wish.point)) < kClose;
    });
    if (said) continue;
    const bool bold = wish.series->emphasised;
    const double size = bold ? kTickSize : kLabelSize;
    const glm::dvec2 extent{text_width(wish.point->label, size, bold), size};
    const double clearance = wish.point->ringed ? kRingRadius + 1.5 : kMarkerRadius + 2.5;
    const auto place = layout.place(at(*wish.point), clearance, extent, wish.rank < 2);
    if (!place) continue;
    placed.push_back(wish);
    const glm::dvec2 baseline{(place->lo.x + place->hi.x) / 2, place->hi.y - 0.18 * size};
    svg += draw_text(baseline, wish.point->label,
                     {size, bold ? wish.series->color.c_str() : kSoftInk, "middle", bold, true});
  }
  return svg;
}

}  // namespace

std::string draw_panel(const PlotPanel& panel, const Rectangle& area, const LogAxis& x, const LogAxis& y,
                       bool first) {
  const PanelDrawing drawing(panel, area, x, y);
  return "<g class=\"panel\">\n" + drawing.grid(first) + drawing.title() + drawing.front() + drawing.discs() +
         drawing.lines() + drawing.markers() + drawing.labels() + "</g>\n";
}

}  // namespace fathom::runtime
