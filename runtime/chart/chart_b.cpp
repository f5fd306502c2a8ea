#include "runtime/chart/chart_b.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "runtime/chart/fit.h"
#include "runtime/chart/markup.h"
#include "runtime/chart/plot.h"
#include "runtime/chart/plot_svg.h"

namespace fathom::runtime {
namespace {

// The relMSE to which the light chart's names give the time.
constexpr double kGoal = 1e-3;

std::string slope_of(const ImageCurve& curve) {
  if (std::isnan(curve.slope)) return "";
  return fmt::format(", slope {}{:.2f}", curve.slope < 0 ? "−" : "", std::abs(curve.slope));
}

std::string name_by_method(const ImageCurve& curve) {
  std::string name = curve.method + " " + curve.precision;
  if (curve.eps > 0) name += ", eps " + scientific(curve.eps);
  return name + slope_of(curve);
}

std::string name_by_light(const ImageCurve& curve) {
  std::string name = curve.lights + ", " + curve.sampler + slope_of(curve);
  const double seconds = seconds_to(curve, kGoal);
  return std::isnan(seconds) ? name : name + fmt::format(", {} after {} s", scientific(kGoal), readable(seconds));
}

// Selects the curves of one image chart, those that differ from the default in one respect only, and names them.
struct ImageChart {
  const char* title;
  bool (*shows)(const ImageCurve& curve);
  std::string (*name)(const ImageCurve& curve);
};
constexpr ImageChart kByMethod = {
    "Speed against accuracy of pictures: ",
    [](const ImageCurve& curve) { return curve.sampler == kDefaultSampler && curve.lights == kDefaultLights; },
    name_by_method};
constexpr ImageChart kByLight = {
    "Speed against accuracy of finding light: ",
    [](const ImageCurve& curve) { return curve.method == kDefaultMethod && curve.precision == "f32"; },
    name_by_light};

std::string tooltip_of(const ImageMeasurement& row) {
  std::string text = row.method + " " + row.precision;
  if (row.eps > 0) text += ", eps " + scientific(row.eps);
  if (row.sampler != kDefaultSampler || row.lights != kDefaultLights) text += ", " + row.lights + ", " + row.sampler;
  return text +
         fmt::format("\n{} samples per pixel, {} seeds\n{} s ({} to {})\n", row.spp, row.seeds,
                     readable(row.seconds_med), readable(row.seconds_min), readable(row.seconds_max)) +
         fmt::format("relMSE {} (p05 {}, p95 {}), without the worst 0.1 % {}\nmean over the seeds {}",
                     readable(row.relmse_med), readable(row.relmse_p05), readable(row.relmse_p95),
                     readable(row.relmse_trimmed_med), readable(row.floor));
}

// Returns the rows of one curve, ascending in samples per pixel.
std::vector<ImageMeasurement> points_of(const ImageCurve& curve, std::span<const ImageMeasurement> rows) {
  const auto key = [](const auto& of) {
    return std::tie(of.scene, of.method, of.precision, of.eps, of.sampler, of.lights);
  };
  std::vector<ImageMeasurement> points;
  for (const ImageMeasurement& row : rows) {
    if (key(row) == key(curve)) points.push_back(row);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const ImageMeasurement& a, const ImageMeasurement& b) { return a.spp < b.spp; });
  return points;
}

PlotSeries series_of(const ImageCurve& curve, std::span<const ImageMeasurement> rows, bool trimmed) {
  PlotSeries series;
  series.hollow = curve.precision == "f64";
  series.emphasised = kByMethod.shows(curve) && kByLight.shows(curve);
  for (const ImageMeasurement& row : points_of(curve, rows)) {
    PlotPoint point;
    point.x = row.seconds_med;
    point.y = trimmed ? row.relmse_trimmed_med : row.relmse_med;
    point.x_range = Range{row.seconds_min, row.seconds_max};
    if (!trimmed) {
      point.y_range = Range{row.relmse_p05, row.relmse_p95};
      series.level = row.floor;
    }
    // All curves have the same sample counts, so the labels on one curve suffice.
    if (series.emphasised) point.label = fmt::format("{} spp", row.spp);
    point.tooltip = tooltip_of(row);
    series.points.push_back(std::move(point));
  }
  return series;
}

// The default has the first colour. Once all colours are taken, they repeat with dashed lines.
void paint(std::vector<PlotSeries>& all) {
  std::size_t others = 0;
  for (PlotSeries& series : all) {
    if (series.emphasised) {
      series.color = kPalette[0];
      continue;
    }
    series.color = kPalette[1 + others % (kPalette.size() - 1)];
    series.dashed = others >= kPalette.size() - 1;
    ++others;
  }
}

std::string seeds_of(std::span<const ImageMeasurement> rows, const std::string& scene) {
  int fewest = 0, most = 0;
  for (const ImageMeasurement& row : rows) {
    if (row.scene != scene) continue;
    fewest = fewest == 0 ? row.seeds : std::min(fewest, row.seeds);
    most = std::max(most, row.seeds);
  }
  return fewest == most ? fmt::format("{}", most) : fmt::format("{} to {}", fewest, most);
}

std::string draw(const ImageChart& chart, std::span<const ImageMeasurement> rows, const std::string& scene,
                 const Provenance& provenance) {
  Plot plot;
  plot.title = chart.title + scene;
  plot.subtitle =
      "Each point is a number of samples per pixel (spp). relMSE is the squared error over the reference's "
      "square, mean of the pixels.";
  plot.x_title = "time for one picture, seconds";
  plot.y_title = "relMSE";
  for (const bool trimmed : {false, true}) {
    PlotPanel panel{trimmed ? "without the worst 0.1 % of pixels" : "all pixels", {}, {}};
    bool measured = false;
    for (const ImageCurve& curve : fit_curves(rows)) {
      if (curve.scene != scene || !chart.shows(curve)) continue;
      panel.series.push_back(series_of(curve, rows, trimmed));
      panel.series.back().name = chart.name(curve);
      for (const PlotPoint& point : panel.series.back().points) measured |= !std::isnan(point.y);
    }
    paint(panel.series);
    if (measured || !trimmed) plot.panels.push_back(std::move(panel));
  }
  plot.level_words = "the floor, relMSE of the mean over the seeds: bias, which more samples do not remove";
  plot.bar_words = fmt::format("across: fastest to slowest; upright: 5 to 95 % of {} seeds; the point is the median",
                               seeds_of(rows, scene));
  plot.footer = source_of(provenance);
  return plot_svg(plot);
}

}  // namespace

std::string chart_b(std::span<const ImageMeasurement> rows, const std::string& scene, const Provenance& provenance) {
  return draw(kByMethod, rows, scene, provenance);
}

std::string chart_light(std::span<const ImageMeasurement> rows, const std::string& scene,
                        const Provenance& provenance) {
  return draw(kByLight, rows, scene, provenance);
}

}  // namespace fathom::runtime
