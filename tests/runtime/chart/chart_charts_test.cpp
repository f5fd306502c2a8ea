#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>

#include "runtime/chart/chart_a.h"
#include "runtime/chart/chart_b.h"
#include "runtime/chart/plot.h"
#include "tests/runtime/chart/chart_samples.h"
#include "tests/runtime/chart/svg_reading.h"
#include "tests/runtime/cli/markup_check.h"
#include "tests/support/catch.h"

namespace fathom::runtime::chart_charts_test {
namespace {

using test::circles;
using test::count_of;
using test::find_text;
using test::kProvenance;
using test::sample_images;
using test::sample_rays;
using test::texts;
using test::what_is_wrong;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("chart A: panels by class, polylines by method and precision, every row drawn", "[chart]") {
  const auto rows = sample_rays();
  const std::string svg = chart_a(rows, "composite", Cost::Time, kProvenance);
  CHECK(what_is_wrong(svg) == "");
  const auto words = texts(svg);
  const test::Text *camera = find_text(words, "camera rays, 50\u00a0000"),
                   *bounce = find_text(words, "bounce rays, 50\u00a0000"),
                   *grazing = find_text(words, "grazing rays, 50\u00a0000");
  REQUIRE((camera && bounce && grazing));
  CHECK(camera->x < bounce->x);
  CHECK(bounce->x < grazing->x);
  for (const char* name : {"tiered f32", "sphere tracing f32", "sphere tracing f32, 64 steps",
                           "sphere tracing f32, relaxed automatically", "sphere tracing f64", "interval f64"}) {
    CAPTURE(name);
    CHECK(find_text(words, name) != nullptr);
  }
  std::size_t references = 0, failing = 0;
  for (const RayMeasurement& row : rows) {
    references += row.reference;
    failing += failures_ppm(row) > 0;
  }
  CHECK(circles(svg, "marker").size() == rows.size() - references + 7);  // the legend has seven markers
  CHECK(count_of(svg, "Z\" class=\"marker\"") == references);            // markers at zero error
  CHECK(circles(svg, "disc").size() == failing + 3);
  CHECK(contains(svg, "0123abc"));
}

TEST_CASE("chart A: the default is bold, on the front and on the staircase", "[chart]") {
  const std::string svg = chart_a(sample_rays(), "composite", Cost::Time, kProvenance);
  for (const test::Circle& marker : circles(svg, "marker")) {
    if (marker.radius < 4) continue;  // the default's bold markers are larger
    bool ringed = false;
    for (const test::Circle& ring : circles(svg, "ring")) ringed |= ring.x == marker.x && ring.y == marker.y;
    const bool in_legend = marker.x < 100 && marker.y > 450;
    CHECK(ringed != in_legend);
    if (in_legend) continue;
    std::ostringstream corner;
    corner << "H" << marker.x << "V" << marker.y;
    CHECK(count_of(svg, corner.str()) == 2);
  }
  CHECK(count_of(svg, ">tiered</text>") == 3);
}

TEST_CASE("chart A: the axes are time or evaluations, and p99", "[chart]") {
  const auto rows = sample_rays();
  for (const Cost cost : {Cost::Time, Cost::Evaluations}) {
    const std::string svg = chart_a(rows, "composite", cost, kProvenance);
    CHECK(what_is_wrong(svg) == "");
    CHECK(contains(svg, "nanoseconds") == (cost == Cost::Time));
    CHECK(contains(svg, "fastest to slowest of 9 rounds") == (cost == Cost::Time));
    // The first series is sphere tracing with eps 1e-3, 1e-5, 1e-6 over camera rays. None of its errors is 0.
    const auto markers = circles(svg, "marker");
    const auto decades = [&](double a, double b) { return std::log10(a / b); };
    const double scale_x = (markers[1].x - markers[0].x) / decades(cost_of(rows[1], cost), cost_of(rows[0], cost));
    const double scale_y = (markers[1].y - markers[0].y) / decades(rows[1].terr_p99, rows[0].terr_p99);
    CHECK(scale_x > 0);
    CHECK(scale_y < 0);
    CHECK((markers[2].x - markers[1].x) / decades(cost_of(rows[2], cost), cost_of(rows[1], cost)) ==
          Approx(scale_x).epsilon(0.01));
    CHECK((markers[2].y - markers[1].y) / decades(rows[2].terr_p99, rows[1].terr_p99) ==
          Approx(scale_y).epsilon(0.01));
  }
}

TEST_CASE("chart A: tooltips have the numbers, and the bound where nothing failed", "[chart]") {
  const std::string svg = chart_a(sample_rays(), "composite", Cost::Time, kProvenance);
  CHECK(
      contains(svg, "sphere tracing f32, eps 1e-3\n820 ns per ray (795 to 886), 23 evaluations per ray (p99 92)\n"));
  CHECK(contains(svg, "|t - t_ref| p50 0.0017, p99 0.017, max 0.51\n"));
  CHECK(contains(svg, "failures 1140 ppm: false hits 1140, false misses 0, out of steps 0, gross errors 0\n"));
  CHECK(contains(svg, "no failure; fewer than 60 ppm with 95 % confidence\n"));
  CHECK(contains(svg, "the reference: its errors are 0 by definition"));
}

TEST_CASE("chart A: names tell apart only what differs", "[chart]") {
  RayMeasurement plain;
  plain.method = "m", plain.precision = "f32", plain.relax = 1;
  RayMeasurement relaxed = plain, limited = plain, automatic = plain;
  relaxed.relax = 1.6, limited.steps_max = 64, automatic.relax = 0;
  CHECK(name_of(relaxed, std::vector{relaxed}) == "m f32");
  const std::vector rows = {plain, relaxed, limited, automatic};
  CHECK(name_of(plain, rows) == "m f32");
  CHECK(name_of(relaxed, rows) == "m f32, relaxed by 1.6");
  CHECK(name_of(limited, rows) == "m f32, 64 steps");
  CHECK(name_of(automatic, rows) == "m f32, relaxed automatically");
}

TEST_CASE("chart A: other scenes' rows are not in it, and names are escaped", "[chart]") {
  auto rows = sample_rays();
  for (RayMeasurement& row : rows) row.method += " <&>";
  rows[0].scene = "another";
  rows[0].method = "alone";
  const std::string svg = chart_a(rows, "composite", Cost::Time, kProvenance);
  CHECK(what_is_wrong(svg) == "");
  CHECK_FALSE(contains(svg, "alone"));
  CHECK(contains(svg, "sphere tracing &lt;&amp;&gt; f32"));
  CHECK(what_is_wrong(chart_a(rows, "nothing", Cost::Time, kProvenance)) == "");
}

TEST_CASE("chart A: more methods than colours are told apart by dashes", "[chart]") {
  std::vector<RayMeasurement> rows;
  for (int i = 0; i < 8; ++i) {
    RayMeasurement row = sample_rays()[0];
    row.method = "method " + std::to_string(i);
    row.ns_med *= 1 + i;
    rows.push_back(row);
    row.eps /= 10;
    row.terr_p99 /= 10;
    rows.push_back(row);
  }
  const std::string svg = chart_a(rows, "composite", Cost::Time, kProvenance);
  // Each method twice: in the panel and in the legend.
  CHECK(count_of(svg, "stroke-dasharray=\"5 4\"") == 2 * (8 - (kPalette.size() - 1)));
}

TEST_CASE("chart A: what was not measured is counted", "[chart]") {
  auto rows = sample_rays();
  rows[1].terr_p99 = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = chart_a(rows, "composite", Cost::Time, kProvenance);
  CHECK(what_is_wrong(svg) == "");
  CHECK(contains(svg, "1 not measured"));
  CHECK(contains(svg, "sphere tracing f32 1e-5"));
}

TEST_CASE("chart B: curves over samples with their slopes, floors and both panels", "[chart]") {
  const auto rows = sample_images();
  const std::string svg = chart_b(rows, "composite", kProvenance);
  CHECK(what_is_wrong(svg) == "");
  const auto words = texts(svg);
  CHECK(find_text(words, "tiered f32, slope −1.00") != nullptr);
  CHECK(find_text(words, "sphere tracing f32, eps 1e-3, slope −0.68") != nullptr);
  CHECK(find_text(words, "all pixels") != nullptr);
  CHECK(find_text(words, "without the worst 0.1 % of pixels") != nullptr);
  CHECK(circles(svg, "marker").size() == 2 * rows.size() + 4);
  CHECK(count_of(svg, "class=\"level\"") == 4);
  CHECK(count_of(svg, ">1024 spp<") == 2);  // the default's, in both panels
  CHECK(contains(svg, "tiered f32\n4 samples per pixel, 16 seeds\n0.084 s (0.0806 to 0.0899)\n"));
  CHECK(contains(svg, "5 to 95 % of 16 seeds"));
}

// Curves that are exact power laws, with relMSE 1e-3 at the time in seconds that equals the number of samples.
std::vector<ImageMeasurement> light_samples() {
  std::vector<ImageMeasurement> rows;
  for (const auto& [sampler, lights, slope] :
       {std::tuple("blue", "mis", -1.25), std::tuple("independent", "mis", -1.0), std::tuple("blue", "bsdf", -1.0)}) {
    for (int spp = 4; spp <= 64; spp *= 4) {
      ImageMeasurement row;
      row.scene = "composite", row.method = "tiered", row.precision = "f32", row.sampler = sampler,
      row.lights = lights;
      row.spp = spp, row.seeds = 8;
      row.seconds_med = row.seconds_min = row.seconds_max = 0.1 * spp;
      row.relmse_med = row.relmse_p05 = row.relmse_p95 = row.relmse_trimmed_med =
          1e-3 * std::pow(0.1 * spp / 20, slope);
      row.floor = 1e-6;
      rows.push_back(row);
    }
  }
  return rows;
}

TEST_CASE("chart light: curves by ways to find light and by samplers, with the time to 1e-3", "[chart]") {
  auto rows = light_samples();
  for (const ImageMeasurement& row : sample_images()) rows.push_back(row);
  const std::string svg = chart_light(light_samples(), "composite", kProvenance);
  CHECK(what_is_wrong(svg) == "");
  const auto words = texts(svg);
  CHECK(find_text(words, "mis, blue, slope −1.25, 1e-3 after 20 s") != nullptr);
  CHECK(find_text(words, "mis, independent, slope −1.00, 1e-3 after 20 s") != nullptr);
  CHECK(find_text(words, "bsdf, blue, slope −1.00, 1e-3 after 20 s") != nullptr);
  CHECK(circles(svg, "marker").size() == 2 * 9 + 3);
  CHECK(count_of(svg, ">64 spp<") == 2);  // the default's, in both panels
  // Each chart shows only the rows that differ from the default in the chart's own parameter.
  CHECK_FALSE(contains(chart_light(rows, "composite", kProvenance), "sphere tracing"));
  CHECK_FALSE(contains(chart_b(rows, "composite", kProvenance), "independent"));
}

TEST_CASE("chart B: points are in the order of samples, whatever the rows' order", "[chart]") {
  auto rows = sample_images();
  const std::string svg = chart_b(rows, "composite", kProvenance);
  std::swap(rows[0], rows[3]);  // two points of one curve
  CHECK(chart_b(rows, "composite", kProvenance) == svg);
}

TEST_CASE("chart B: the floor is that at the most samples", "[chart]") {
  auto rows = sample_images();
  rows.erase(rows.begin() + 5, rows.end());
  for (ImageMeasurement& row : rows) row.floor = 4e-5 / row.spp;  // spp 4 to 1024
  std::swap(rows.front(), rows.back());
  const std::string svg = chart_b(rows, "composite", kProvenance);
  const auto markers = circles(svg, "marker");  // in order of samples; a decade has the same height everywhere
  const double decade = (markers[4].y - markers[0].y) / std::log10(rows.back().relmse_med / rows.front().relmse_med);
  const double level = markers[4].y + decade * std::log10(rows.front().relmse_med / (4e-5 / 1024));
  const std::regex line("y1=\"([0-9.]+)\"[^>]*class=\"level\"");
  std::smatch match;
  REQUIRE(std::regex_search(svg, match, line));
  CHECK(std::stod(match[1]) == Approx(level).margin(0.1));
}

TEST_CASE("chart B: a floor of 0 and a panel that was not measured", "[chart]") {
  auto rows = sample_images();
  for (ImageMeasurement& row : rows) {
    row.floor = 0;
    row.relmse_trimmed_med = std::numeric_limits<double>::quiet_NaN();
  }
  const std::string svg = chart_b(rows, "composite", kProvenance);
  CHECK(what_is_wrong(svg) == "");
  CHECK(find_text(texts(svg), "0") != nullptr);
  CHECK_FALSE(contains(svg, "without the worst 0.1 % of pixels"));
  CHECK(what_is_wrong(chart_b({}, "composite", kProvenance)) == "");
}

}  // namespace
}  // namespace fathom::runtime::chart_charts_test
