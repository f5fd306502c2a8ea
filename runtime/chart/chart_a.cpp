#include "runtime/chart/chart_a.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include "runtime/chart/markup.h"
#include "runtime/chart/plot.h"
#include "runtime/chart/plot_svg.h"

namespace fathom::runtime {
namespace {

using MeasuredRows = std::vector<RayMeasurement>;

// Suffix that tells variants of one method apart: relaxation and step limit, where they vary among the rows. Rows
// that differ only in precision share method and suffix, and so a colour.
std::string variant_of(const RayMeasurement& row, std::span<const RayMeasurement> rows) {
  bool relaxed = false, limited = false;
  for (const RayMeasurement& other : rows) {
    if (other.method != row.method || other.reference != row.reference) continue;
    relaxed |= other.relax != row.relax;
    limited |= other.steps_max != row.steps_max;
  }
  std::string variant;
  if (relaxed && row.relax == 0) variant += ", relaxed automatically";
  if (relaxed && row.relax > 0 && row.relax != 1) variant += ", relaxed by " + readable(row.relax);
  if (limited && row.steps_max > 0) variant += fmt::format(", {} steps", row.steps_max);
  return variant;
}

std::string tooltip_of(const RayMeasurement& row, const std::string& name) {
  const double failures = failures_ppm(row);
  std::string text = name;
  if (row.eps > 0) text += ", eps " + scientific(row.eps);
  text += fmt::format("\n{} ns per ray ({} to {}), {} evaluations per ray (p99 {})\n", readable(row.ns_med),
                      readable(row.ns_min), readable(row.ns_max), readable(row.evals_mean), readable(row.evals_p99));
  text += row.reference ? "the reference: its errors are 0 by definition\n"
                        : fmt::format("|t - t_ref| p50 {}, p99 {}, max {}\nnormal p50 {}, p99 {}, max {} rad\n",
                                      readable(row.terr_p50), readable(row.terr_p99), readable(row.terr_max),
                                      readable(row.nerr_p50), readable(row.nerr_p99), readable(row.nerr_max));
  text += failures == 0
              ? fmt::format("no failure; fewer than {} ppm with 95 % confidence\n",
                            readable(unseen_failures_ppm(row.rays)))
              : fmt::format("failures {} ppm: false hits {}, false misses {}, out of steps {}, gross errors {}\n",
                            readable(failures), readable(row.false_hit_ppm), readable(row.false_miss_ppm),
                            readable(row.exhausted_ppm), readable(row.gross_ppm));
  return text + fmt::format("near misses {} ppm; {} rays", readable(row.near_miss_ppm), row.rays);
}

// Assigns colours to the methods of one scene, the same in every panel.
class Colors {
 public:
  explicit Colors(const MeasuredRows& rows) : rows_(rows) {
    for (const RayMeasurement& row : rows) {
      if (has_own_color(row)) continue;
      const std::string method = row.method + variant_of(row, rows_);
      if (std::find(methods_.begin(), methods_.end(), method) == methods_.end()) methods_.push_back(method);
    }
  }

  // The default has the first colour. Once all colours are taken, they repeat with dashed lines.
  void paint(PlotSeries& series, const RayMeasurement& row) const {
    const std::string variant = variant_of(row, rows_);
    if (has_own_color(row)) {
      series.color = row.reference ? kNeutralColor : kPalette[0];
      series.dashed = !variant.empty() && !is_default(row);
      return;
    }
    const auto place = std::find(methods_.begin(), methods_.end(), row.method + variant);
    const auto index = static_cast<std::size_t>(place - methods_.begin());
    series.color = kPalette[1 + index % (kPalette.size() - 1)];
    series.dashed = index >= kPalette.size() - 1;
  }

 private:
  static bool has_own_color(const RayMeasurement& row) { return row.reference || row.method == kDefaultMethod; }

  const MeasuredRows& rows_;
  std::vector<std::string> methods_;
};

PlotPoint point_of(const RayMeasurement& row, std::span<const RayMeasurement> rows, Cost cost) {
  PlotPoint point;
  point.x = cost_of(row, cost);
  point.y = row.reference ? 0 : row.terr_p99;
  if (cost == Cost::Time) point.x_range = Range{row.ns_min, row.ns_max};
  point.failures_ppm = failures_ppm(row);
  point.ringed = on_pareto_front(row, rows, cost);
  if (row.eps > 0 && !row.reference) point.label = scientific(row.eps);
  if (row.reference) point.label = "reference";
  if (is_default(row) && row.eps == 0) point.label = row.method;
  point.tooltip = tooltip_of(row, name_of(row, rows));
  return point;
}

std::vector<PlotSeries> series_of(const MeasuredRows& panel, const MeasuredRows& scene, Cost cost,
                                  const Colors& colors) {
  MeasuredRows sorted = panel;
  std::stable_sort(sorted.begin(), sorted.end(), [](const RayMeasurement& a, const RayMeasurement& b) {
    const auto coarseness = [](double eps) { return eps > 0 ? eps : 0; };
    return coarseness(a.eps) > coarseness(b.eps);
  });
  std::vector<PlotSeries> all;
  for (const RayMeasurement& first : panel) {
    PlotSeries series;
    series.name = name_of(first, scene);
    const auto named = [&](const PlotSeries& other) { return other.name == series.name; };
    if (std::any_of(all.begin(), all.end(), named)) continue;
    colors.paint(series, first);
    series.hollow = first.precision == "f64";
    series.emphasised = is_default(first);
    for (const RayMeasurement& row : sorted) {
      if (name_of(row, scene) == series.name) series.points.push_back(point_of(row, panel, cost));
    }
    all.push_back(std::move(series));
  }
  return all;
}

std::vector<std::string> classes_of(const MeasuredRows& rows) {
  std::vector<std::string> classes;
  const auto add = [&](const std::string& name) {
    const bool measured =
        std::any_of(rows.begin(), rows.end(), [&](const RayMeasurement& row) { return row.ray_class == name; });
    if (measured && std::find(classes.begin(), classes.end(), name) == classes.end()) classes.push_back(name);
  };
  for (const char* usual : {"camera", "bounce", "grazing"}) add(usual);
  for (const RayMeasurement& row : rows) add(row.ray_class);
  return classes;
}

PlotPanel panel_of(const std::string& ray_class, const MeasuredRows& scene, Cost cost, const Colors& colors) {
  MeasuredRows rows;
  std::uint64_t fewest = std::numeric_limits<std::uint64_t>::max(), most = 0;
  for (const RayMeasurement& row : scene) {
    if (row.ray_class != ray_class) continue;
    rows.push_back(row);
    fewest = std::min(fewest, row.rays);
    most = std::max(most, row.rays);
  }
  PlotPanel panel;
  panel.title = ray_class + " rays";
  if (fewest == most) panel.title += ", " + grouped(static_cast<std::int64_t>(most));
  panel.series = series_of(rows, scene, cost, colors);
  for (const RayMeasurement& corner : reliable_front(rows, cost)) {
    panel.front.push_back({cost_of(corner, cost), corner.terr_p99, {}, {}, 0, false, "", ""});
  }
  return panel;
}

}  // namespace

std::string name_of(const RayMeasurement& row, std::span<const RayMeasurement> rows) {
  return row.method + (row.method.ends_with(row.precision) ? "" : " " + row.precision) + variant_of(row, rows);
}

std::string chart_a(std::span<const RayMeasurement> rows, const std::string& scene, Cost cost,
                    const Provenance& provenance) {
  MeasuredRows of_scene;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(of_scene),
               [&](const RayMeasurement& row) { return row.scene == scene; });
  Plot plot;
  plot.title = "Speed against accuracy of rays: " + scene;
  plot.subtitle =
      "Each point is a way to intersect rays with the scene; numbers beside points are tolerances of a hit.";
  plot.x_title =
      cost == Cost::Time ? "time per ray, nanoseconds on one thread" : "evaluations of the field per ray, mean";
  plot.y_title = "error of the hit distance, p99, scene units";
  const Colors colors(of_scene);
  for (const std::string& ray_class : classes_of(of_scene)) {
    plot.panels.push_back(panel_of(ray_class, of_scene, cost, colors));
  }
  plot.front_words = "reached by points that fail no more often than the default; one of them beats what is shaded";
  plot.ring_words = "on the Pareto front: no other is as cheap, as accurate and fails as rarely, all at once";
  plot.disc_words = "ppm of rays that fail: false hits and misses, out of steps, gross errors";
  plot.bar_words = fmt::format("fastest to slowest of {} rounds; the point is the median", provenance.rounds);
  plot.footer = source_of(provenance);
  return plot_svg(plot);
}

}  // namespace fathom::runtime
