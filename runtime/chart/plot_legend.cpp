#include "runtime/chart/plot_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/chart/plot_draw.h"

namespace fathom::runtime {
namespace {

constexpr double kRow = 21, kSampleWidth = 34, kColumnGap = 22;
constexpr double kInner = kPlotWidth - kLeft - kRight;

// An entry of the legend: a drawn sample, `sample_width` pixels wide, and its explanation.
struct Entry {
  std::string words;
  bool bold;
  double sample_width;
  std::string (*sample)(const PlotSeries* series, glm::dvec2 middle);
  const PlotSeries* series;
};

std::string series_sample(const PlotSeries* series, glm::dvec2 middle) {
  const glm::dvec2 half{13, 0};
  return draw_line(middle - half, middle + half, series->color, series->emphasised ? 2.6 : 1.4,
                   series->dashed ? R"(stroke-dasharray="5 4")" : "") +
         draw_marker(*series, middle, false);
}

std::string ring_sample(const PlotSeries*, glm::dvec2 middle) {
  return draw_ring(middle) + draw_circle(middle, kMarkerRadius, fmt::format("fill=\"{}\"", kFrontColor));
}

std::string front_sample(const PlotSeries*, glm::dvec2 middle) {
  const auto path = [&](const char* end, const char* paint) {
    return fmt::format("<path d=\"M{} {}v6h11v6h11{}\" {}/>\n", middle.x - 11, middle.y - 6, end, paint);
  };
  return path("v-12z", R"(fill="#000000" fill-opacity="0.06")") +
         path("", fmt::format("fill=\"none\" stroke=\"{}\"", kFrontColor).c_str());
}

std::string level_sample(const PlotSeries*, glm::dvec2 middle) {
  return draw_line(middle - glm::dvec2{13, 0}, middle + glm::dvec2{13, 0}, kSoftInk, 1.2,
                   R"(stroke-dasharray="7 4")");
}

std::string bar_sample(const PlotSeries*, glm::dvec2 middle) {
  const glm::dvec2 half{11, 0}, cap{0, 3};
  return draw_line(middle - half, middle + half, kSoftInk, 1) +
         draw_line(middle - half - cap, middle - half + cap, kSoftInk, 1) +
         draw_line(middle + half - cap, middle + half + cap, kSoftInk, 1);
}

constexpr double kDiscSamples[] = {1, 1000, 1e6};  // ppm
constexpr const char* kDiscWords[] = {"1", "1000", "10⁶"};
constexpr double kDiscWidth = 172;

std::string disc_sample(const PlotSeries*, glm::dvec2 middle) {
  std::string svg;
  double x = middle.x - kDiscWidth / 2;
  for (std::size_t i = 0; i < std::size(kDiscSamples); ++i) {
    const double radius = disc_radius(kDiscSamples[i]);
    svg += draw_disc({x + radius, middle.y}, kDiscSamples[i], kNeutralColor);
    svg += draw_text({x + 2 * radius + 4, middle.y + 4}, kDiscWords[i], {kTickSize, kSoftInk, "start", false, false});
    x += 2 * radius + 13 + text_width(kDiscWords[i], kTickSize);
  }
  return svg;
}

bool any_point(const Plot& plot, bool (*holds)(const PlotPoint&)) {
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotSeries& series : panel.series) {
      if (std::any_of(series.points.begin(), series.points.end(), holds)) return true;
    }
  }
  return false;
}

// Lists every series once. A panel may lack some of the series.
std::vector<Entry> series_entries(const Plot& plot) {
  std::vector<Entry> entries;
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotSeries& series : panel.series) {
      const bool known =
          std::any_of(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.words == series.name; });
      if (!known) entries.push_back({series.name, series.emphasised, kSampleWidth, series_sample, &series});
    }
  }
  std::stable_partition(entries.begin(), entries.end(), [](const Entry& entry) { return entry.bold; });
  return entries;
}

std::vector<Entry> sentence_entries(const Plot& plot) {
  std::vector<Entry> entries;
  const auto add = [&](const std::string& words, bool shown, auto* sample, double width = kSampleWidth) {
    if (shown && !words.empty()) entries.push_back({words, false, width, sample, nullptr});
  };
  bool front = false, level = false;
  for (const PlotPanel& panel : plot.panels) {
    front |= !panel.front.empty();
    for (const PlotSeries& series : panel.series) level |= series.level.has_value();
  }
  add(plot.front_words, front, front_sample);
  add(plot.ring_words, any_point(plot, [](const PlotPoint& p) { return p.ringed; }), ring_sample);
  add(plot.level_words, level, level_sample);
  add(plot.bar_words, any_point(plot, [](const PlotPoint& p) { return p.x_range || p.y_range; }), bar_sample);
  add(plot.disc_words, any_point(plot, [](const PlotPoint& p) { return p.failures_ppm > 0; }), disc_sample,
      kDiscWidth);
  return entries;
}

std::string draw_entry(const Entry& entry, glm::dvec2 left_middle) {
  return entry.sample(entry.series, left_middle + glm::dvec2{entry.sample_width / 2, 0}) +
         draw_text(left_middle + glm::dvec2{entry.sample_width + 4, 4}, entry.words,
                   {kLegendSize, kInk, "start", entry.bold, false});
}

}  // namespace

Legend draw_legend(const Plot& plot, double top) {
  Legend legend;
  const std::vector<Entry> series = series_entries(plot);
  double widest = 1;
  for (const Entry& entry : series) {
    widest = std::max(widest, kSampleWidth + 4 + text_width(entry.words, kLegendSize, entry.bold) + kColumnGap);
  }
  // Entries run down as many columns as fit, all of equal height.
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::floor(kInner / widest)));
  const std::size_t rows = (series.size() + columns - 1) / columns;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto column = static_cast<double>(i / rows), row = static_cast<double>(i % rows);
    legend.svg += draw_entry(series[i], {kLeft + column * widest, top + (row + 0.5) * kRow});
  }
  legend.height = static_cast<double>(rows) * kRow + 8;
  for (const Entry& entry : sentence_entries(plot)) {
    const double row = entry.sample_width > kSampleWidth ? 34 : kRow;
    legend.svg += draw_entry(entry, {kLeft, top + legend.height + row / 2});
    legend.height += row;
  }
  return legend;
}

}  // namespace fathom::runtime
