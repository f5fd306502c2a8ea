#include <cmath>
#include <limits>

#include "runtime/chart/label_layout.h"
#include "runtime/chart/log_axis.h"
#include "runtime/chart/markup.h"
#include "runtime/chart/plot.h"
#include "runtime/chart/plot_draw.h"
#include "runtime/chart/plot_svg.h"
#include "tests/runtime/chart/svg_reading.h"
#include "tests/runtime/cli/markup_check.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::chart_plot_test {
namespace {

using test::circles;
using test::count_of;
using test::find_text;
using test::texts;
using test::what_is_wrong;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Random {
 public:
  double operator()() {  // returns numbers in [0,1)
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 40) / (1 << 24);
  }

 private:
  std::uint64_t state_ = 7;
};

PlotPoint point(double x, double y, const std::string& label = "") {
  PlotPoint made;
  made.x = x, made.y = y, made.label = label;
  return made;
}

Plot plot_of(std::vector<PlotPoint> points) {
  PlotSeries series{"a series", kPalette[1], false, false, false, std::move(points), {}};
  return {"Title", "subtitle", "x, units", "y, units", {{"panel", {series}, {}}}, "", "", "", "", "", ""};
}

TEST_CASE("chart markup: texts are escaped", "[chart]") {
  CHECK(escape_markup("a < b && c > \"d\" 'e'") == "a &lt; b &amp;&amp; c &gt; &quot;d&quot; &#39;e&#39;");
  CHECK(escape_markup("µs → 10⁻³\n\t") == "µs → 10⁻³\n\t");
  CHECK(escape_markup(std::string_view("\0\x1b", 2)) == "\xef\xbf\xbd\xef\xbf\xbd");
}

TEST_CASE("chart markup: numbers", "[chart]") {
  CHECK(coordinate(1.5) == "1.5");
  CHECK(coordinate(100) == "100");
  CHECK(coordinate(-0.001) == "0");
  CHECK(coordinate(2.0 / 3) == "0.67");
  CHECK(readable(0) == "0");
  CHECK(readable(1140.4) == "1140");
  CHECK(readable(999.6) == "1000");
  CHECK(readable(0.0017) == "0.0017");
  CHECK(readable(2.5e-6) == "2.5e-6");
  CHECK(readable(1e-10) == "1e-10");
  CHECK(readable(3e20) == "3e20");
  CHECK(readable(kNaN) == "?");
  CHECK(scientific(1e-3) == "1e-3");
  CHECK(scientific(0.25) == "2.5e-1");
  CHECK(scientific(1) == "1e0");
  CHECK(scientific(10) == "1e1");
  CHECK(scientific(1.06e-12) == "1.06e-12");
  CHECK(scientific(0) == "0e0");
  CHECK(grouped(0) == "0");
  CHECK(grouped(999) == "999");
  CHECK(grouped(-1000) == "-1\u00a0000");
  CHECK(grouped(1234567) == "1\u00a0234\u00a0567");
}

TEST_CASE("chart axis: decades are equally long, the padding is kept", "[chart]") {
  const LogAxis axis(std::vector{1.0, 1000.0}, 340, 20);
  CHECK(axis.position(1) == Approx(20));
  CHECK(axis.position(10) == Approx(120));
  CHECK(axis.position(1000) == Approx(320));
  CHECK_FALSE(axis.has_zero());
}

TEST_CASE("chart axis: an axis spans a decade or more, about its values", "[chart]") {
  const LogAxis axis(std::vector{5.0}, 200, 0);
  CHECK(axis.position(5) == Approx(100));
  CHECK(axis.position(50) == Approx(300));
  const LogAxis none({}, 200, 0);
  CHECK(none.position(1) == Approx(100));
}

TEST_CASE("chart axis: zeros have a slot before the scale", "[chart]") {
  const LogAxis axis(std::vector{0.0, 1.0, 100.0, kNaN, -4.0, kInfinity}, 300, 20);
  CHECK(axis.has_zero());
  CHECK(axis.position(0) > 0);
  CHECK(axis.position(0) < axis.break_position());
  CHECK(axis.position(1) == Approx(axis.break_position() + 20));
  CHECK(axis.position(100) == Approx(280));
  const LogAxis only_zero(std::vector{0.0}, 300, 20);
  CHECK(only_zero.has_zero());
}

TEST_CASE("chart axis: ticks are exact, ascending, on the axis and their labels apart", "[chart]") {
  Random random;
  for (int round = 0; round < 300; ++round) {
    const double low = std::pow(10.0, -300 + 600 * random());
    const double high = low * std::pow(10.0, 12 * random() * random());
    const double length = 150 + 500 * random(), room = 15 + 40 * random();
    const LogAxis axis(std::vector{low, high, random() < 0.5 ? 0 : low}, length, 20 * random());
    double before = 0, label_before = -kInfinity;
    int labels = 0;
    for (const Tick& tick : axis.ticks(room)) {
      CAPTURE(low, high, tick.value);
      CHECK(tick.value > before);
      before = tick.value;
      CHECK(axis.position(tick.value) <= length + 1e-6);
      CHECK(axis.position(tick.value) >= (axis.has_zero() ? axis.break_position() : 0) - 1e-6);
      if (!tick.labelled) continue;
      ++labels;
      CHECK(axis.position(tick.value) >= label_before + room - 1e-6);
      label_before = axis.position(tick.value);
    }
    CHECK(labels >= 1);
  }
  const LogAxis axis(std::vector{1e-5, 1e-2}, 300, 0);
  CHECK(axis.ticks(20).front().value == 1e-5);
  CHECK(axis.ticks(20).back().value == 1e-2);
}

TEST_CASE("chart axis: labels are plain numbers where all are short", "[chart]") {
  const auto words = [](std::vector<Tick> ticks) {
    std::string all;
    for (const TickLabel& label : tick_labels(ticks)) all += label.text + "^" + label.power + " ";
    return all;
  };
  CHECK(words({{0.01, true}, {0.2, true}, {10000, true}}) == "0.01^ 0.2^ 10\u00a0000^ ");
  CHECK(words({{1e-7, true}, {2e-7, true}, {1, true}, {5, false}, {1000, true}}) == "10^−7 2×10^−7 10^0 ^ 10^3 ");
}

TEST_CASE("chart labels: they meet neither each other nor what is blocked, and stay within", "[chart]") {
  Random random;
  const Rectangle bounds{{0, 0}, {300, 200}};
  for (int round = 0; round < 100; ++round) {
    LabelLayout layout(bounds);
    std::vector<Rectangle> taken;
    std::vector<glm::dvec2> points;
    for (int i = 0; i < 30; ++i) {
      points.push_back({300 * random(), 200 * random()});
      taken.push_back({points.back() - 4.0, points.back() + 4.0});
      layout.block(taken.back());
    }
    layout.avoid_segment({0, 0}, {300, 200});
    int placed = 0;
    for (const glm::dvec2 at : points) {
      const bool important = random() < 0.5;
      const auto area = layout.place(at, 5, {30, 10}, important);
      if (!area) continue;
      ++placed;
      CHECK((area->lo.x >= 0 && area->lo.y >= 0 && area->hi.x <= 300 && area->hi.y <= 200));
      CHECK(area->hi.x - area->lo.x == Approx(30));
      for (const Rectangle& other : taken) CHECK_FALSE(overlap(*area, other));
      if (!important) CHECK_FALSE(meets_segment(*area, {0, 0}, {300, 200}));
      taken.push_back(*area);
    }
    CHECK(placed > 5);
  }
}

TEST_CASE("chart labels: segments and rectangles", "[chart]") {
  const Rectangle box{{0, 0}, {2, 1}};
  CHECK(meets_segment(box, {-1, 0.5}, {3, 0.5}));
  CHECK(meets_segment(box, {0.5, 0.5}, {0.6, 0.5}));
  CHECK(meets_segment(box, {1, -1}, {1, 5}));
  CHECK_FALSE(meets_segment(box, {-1, 0.5}, {-0.1, 0.5}));
  CHECK_FALSE(meets_segment(box, {3, -1}, {3, 5}));
  CHECK_FALSE(meets_segment(box, {-1, 0.5}, {0.5, 2}));  // passes the corner
}

TEST_CASE("chart plot: points are where the ticks of their values are", "[chart]") {
  const std::string svg = plot_svg(plot_of({point(10, 1e-2), point(100, 1e-4), point(1000, 1e-6)}));
  CHECK(what_is_wrong(svg) == "");
  const auto markers = circles(svg, "marker");
  const auto words = texts(svg);
  REQUIRE(markers.size() == 4);  // the last marker is the legend's
  const char* x_labels[] = {"10", "100", "1\u00a0000"};
  const char* y_labels[] = {"10^−2", "10^−4", "10^−6"};
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    const test::Text *x = find_text(words, x_labels[i]), *y = find_text(words, y_labels[i]);
    REQUIRE((x && y));
    CHECK(markers[i].x == Approx(x->x).margin(0.011));
    CHECK(markers[i].y == Approx(y->y - 4).margin(0.011));  // a text's baseline is below its middle
  }
  CHECK(markers[1].x - markers[0].x == Approx(markers[2].x - markers[1].x).margin(0.021));
  CHECK(markers[0].y < markers[1].y);
  for (const char* title : {"Title", "subtitle", "x, units", "y, units", "panel", "a series"}) {
    CHECK(find_text(words, title) != nullptr);
  }
}

TEST_CASE("chart plot: panels share the scales", "[chart]") {
  Plot plot = plot_of({point(10, 1), point(1000, 100)});
  plot.panels.push_back(plot.panels[0]);
  plot.panels[1].series[0].points = {point(100, 10)};
  const std::string svg = plot_svg(plot);
  const auto markers = circles(svg, "marker");
  REQUIRE(markers.size() == 4);
  CHECK(markers[2].y == Approx((markers[0].y + markers[1].y) / 2).margin(0.011));
  const double right_of_first = (markers[0].x + markers[1].x) / 2;
  CHECK(markers[2].x > right_of_first + 300);
  CHECK(count_of(svg, ">a series<") == 1);  // one legend for both panels
  CHECK(count_of(svg, ">y, units<") == 1);
}

TEST_CASE("chart plot: zeros are diamonds in a slot, with a tick", "[chart]") {
  const std::string without = plot_svg(plot_of({point(10, 1e-2), point(100, 1e-4)}));
  CHECK(count_of(without, "class=\"marker\"") == 3);  // two points and the legend's marker
  CHECK(find_text(texts(without), "0") == nullptr);
  const std::string svg = plot_svg(plot_of({point(10, 1e-2), point(100, 1e-4), point(100, 0)}));
  CHECK(what_is_wrong(svg) == "");
  CHECK(circles(svg, "marker").size() == 3);
  CHECK(count_of(svg, "<path d=\"M") == count_of(without, "<path d=\"M") + 2);  // the diamond and its dotted line
  const auto words = texts(svg);
  const test::Text* zero = find_text(words, "0");
  REQUIRE(zero != nullptr);
  CHECK(svg.find("Z\" class=\"marker\"") != std::string::npos);
  CHECK(zero->y > circles(svg, "marker")[1].y + 20);
}

TEST_CASE("chart plot: what cannot be drawn is counted, not dropped in silence", "[chart]") {
  const std::string svg =
      plot_svg(plot_of({point(10, 1e-2), point(kNaN, 1e-4, "1e-4"), point(7, kInfinity), point(-1, 1)}));
  CHECK(what_is_wrong(svg) == "");
  CHECK(circles(svg, "marker").size() == 2);
  CHECK(find_text(texts(svg), "3 not measured") != nullptr);
  CHECK(svg.find("a series 1e-4") != std::string::npos);
  for (const char* not_a_coordinate : {"\"nan", "\"inf", "\"-nan", "\"-inf"})
    CHECK(count_of(svg, not_a_coordinate) == 0);
}

TEST_CASE("chart plot: discs grow with the logarithm of the failures", "[chart]") {
  CHECK(disc_radius(0) == 0);
  CHECK(disc_radius(kNaN) == 0);
  CHECK(disc_radius(1) > 0);
  CHECK(std::pow(disc_radius(999999), 2) == Approx(2 * std::pow(disc_radius(999), 2)));
  Plot plot = plot_of({point(10, 1e-2), point(100, 1e-4), point(200, 1e-5)});
  plot.panels[0].series[0].points[1].failures_ppm = 1000;
  plot.panels[0].series[0].points[2].failures_ppm = 1;
  const auto discs = circles(plot_svg(plot), "disc");
  REQUIRE(discs.size() == 2);  // without `disc_words`, the legend has no discs
  CHECK(discs[0].radius == Approx(disc_radius(1000)).margin(0.005));
  CHECK(discs[1].radius == Approx(disc_radius(1)).margin(0.005));
  plot.disc_words = "failures";
  CHECK(circles(plot_svg(plot), "disc").size() == 5);
}

TEST_CASE("chart plot: bars span their ranges, also when these begin at 0", "[chart]") {
  Plot plot = plot_of({point(10, 1), point(1000, 100)});
  PlotPoint& first = plot.panels[0].series[0].points[0];
  first.x_range = Range{1, 100};
  first.y_range = Range{0, 10};
  const std::string svg = plot_svg(plot);
  CHECK(what_is_wrong(svg) == "");
  const auto markers = circles(svg, "marker");
  const double decade = (markers[1].x - markers[0].x) / 2;
  const std::regex bar(
      "<line x1=\"([0-9.]+)\" y1=\"([0-9.]+)\" x2=\"([0-9.]+)\" y2=\"([0-9.]+)\"[^>]*stroke-opacity=\"0.8\"");
  std::smatch match;
  REQUIRE(std::regex_search(svg, match, bar));
  CHECK(std::stod(match[1]) == Approx(markers[0].x - decade).margin(0.03));
  CHECK(std::stod(match[3]) == Approx(markers[0].x + decade).margin(0.03));
  CHECK(std::stod(match[2]) == Approx(markers[0].y).margin(0.011));
  CHECK(count_of(svg, "stroke-opacity=\"0.8\"") == 6);
}

TEST_CASE("chart plot: rings, levels and the staircase", "[chart]") {
  Plot plot = plot_of({point(10, 1), point(100, 0.1), point(1000, 0.01)});
  plot.panels[0].series[0].points[1].ringed = true;
  plot.panels[0].series[0].level = 1e-3;
  plot.panels[0].front = {point(10, 1), point(100, 0.1)};
  const std::string svg = plot_svg(plot);
  CHECK(what_is_wrong(svg) == "");
  const auto markers = circles(svg, "marker"), rings = circles(svg, "ring");
  REQUIRE(rings.size() == 1);
  CHECK(rings[0].x == markers[1].x);
  CHECK(rings[0].y == markers[1].y);
  const std::string steps = "H" + coordinate(markers[0].x) + "V" + coordinate(markers[0].y) + "H" +
                            coordinate(markers[1].x) + "V" + coordinate(markers[1].y);
  CHECK(count_of(svg, steps) == 2);  // once as the line, once as the border of the shaded area
  CHECK(count_of(svg, "class=\"level\"") == 1);
  CHECK(find_text(texts(svg), "0.001") != nullptr);  // the axis covers the level
}

TEST_CASE("chart plot: whatever the numbers and the words are, the text is well formed", "[chart]") {
  Random random;
  const double odd[] = {0, kNaN, kInfinity, -1, 1e-300, 1e300, 5e-324};
  const auto number = [&] {
    return random() < 0.15 ? odd[static_cast<int>(7 * random())] : std::pow(10.0, 10 * random() - 6);
  };
  for (int round = 0; round < test::scaled_cases(60); ++round) {
    Plot plot = plot_of({});
    plot.title = "<&\"'>\x01";
    plot.footer = "a & b";
    plot.bar_words = plot.ring_words = plot.front_words = plot.level_words = plot.disc_words = "<words>";
    plot.panels.resize(1 + static_cast<std::size_t>(3 * random()));
    std::size_t drawn = 0;
    for (PlotPanel& panel : plot.panels) {
      panel.series.resize(static_cast<std::size_t>(5 * random()));
      for (PlotSeries& series : panel.series) {
        series = {"a < b", kPalette[0], random() < 0.5, random() < 0.5, random() < 0.5, {}, {}};
        if (random() < 0.3) series.level = number();
        for (int i = 0; i < 6 * random(); ++i) {
          PlotPoint made{
              number(), number(),      Range{number(), number()}, Range{number(), number()}, number(), random() < 0.5,
              "<1>",    "a < b\nc & d"};
          drawn += LogAxis::can_show(made.x) && LogAxis::can_show(made.y);
          series.points.push_back(made);
        }
        panel.front = series.points;
      }
    }
    const std::string svg = plot_svg(plot);
    CHECK(what_is_wrong(svg) == "");
    for (const char* bad : {"\"nan", "\"inf", "\"-nan", "\"-inf", " nan", " inf", "Hnan", "Vnan", "Hinf", "Vinf"}) {
      CAPTURE(bad);
      CHECK(count_of(svg, bad) == 0);
    }
    std::size_t points = 0;
    for (const char* part : {"<g class=\"point\"><title>"}) points += count_of(svg, part);
    CHECK(points >= drawn);
    CHECK(plot_svg(plot) == svg);
  }
  CHECK(what_is_wrong(plot_svg({})) == "");
}

TEST_CASE("chart plot: it fits any width, is white whatever is behind, and asks for nothing from elsewhere",
          "[chart]") {
  const std::string svg = plot_svg(plot_of({point(1, 1)}));
  CHECK(svg.find("viewBox=\"0 0 ") != std::string::npos);
  CHECK(svg.find("fill=\"#ffffff\"/>") != std::string::npos);
  CHECK(svg.find("system-ui, sans-serif") != std::string::npos);
  for (const char* foreign : {"href", "url(", "<script", "<style", " id="})
    CHECK(svg.find(foreign) == std::string::npos);
  CHECK(count_of(svg, "http") == 1);  // the only URL is the SVG namespace
}

}  // namespace
}  // namespace fathom::runtime::chart_plot_test
