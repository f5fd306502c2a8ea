#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/chart/fit.h"
#include "runtime/chart/pareto.h"
#include "tests/runtime/chart/chart_samples.h"
#include "tests/support/catch.h"

namespace fathom::runtime::chart_pareto_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

RayMeasurement row(const char* method, double ns, double error, double failures) {
  RayMeasurement made;
  made.scene = "s";
  made.ray_class = "camera";
  made.method = method;
  made.precision = "f32";
  made.ns_med = ns;
  made.evals_mean = 1000 - ns;  // falls as the time rises, so that the two costs give different fronts
  made.terr_p99 = error;
  made.gross_ppm = failures;
  return made;
}

std::string front_of(const std::vector<RayMeasurement>& rows, Cost cost) {
  std::string names;
  for (const RayMeasurement& of : rows) {
    if (on_pareto_front(of, rows, cost)) names += of.method;
  }
  return names;
}

std::string names_of(const std::vector<RayMeasurement>& rows) {
  std::string names;
  for (const RayMeasurement& of : rows) names += of.method;
  return names;
}

TEST_CASE("chart pareto: a row is dominated by one no worse in all three and better in one", "[chart]") {
  const RayMeasurement base = row("a", 100, 1e-3, 10);
  CHECK_FALSE(dominates(base, base, Cost::Time));
  for (const auto& better : {row("b", 99, 1e-3, 10), row("b", 100, 9e-4, 10), row("b", 100, 1e-3, 9)}) {
    CHECK(dominates(better, base, Cost::Time));
    CHECK_FALSE(dominates(base, better, Cost::Time));
  }
  CHECK_FALSE(dominates(row("b", 50, 1e-9, 11), base, Cost::Time));
  CHECK_FALSE(dominates(row("b", 101, 1e-9, 0), base, Cost::Time));
  CHECK_FALSE(dominates(row("b", 50, 2e-3, 0), base, Cost::Time));
}

TEST_CASE("chart pareto: only rows of one scene and class are compared", "[chart]") {
  const RayMeasurement worse = row("a", 100, 1e-3, 10);
  RayMeasurement better = row("b", 1, 1e-6, 0);
  CHECK(dominates(better, worse, Cost::Time));
  better.ray_class = "bounce";
  CHECK_FALSE(dominates(better, worse, Cost::Time));
  better.ray_class = "camera";
  better.scene = "other";
  CHECK_FALSE(dominates(better, worse, Cost::Time));
}

TEST_CASE("chart pareto: all kinds of failures count, contacts do not", "[chart]") {
  RayMeasurement of;
  of.false_hit_ppm = 1, of.false_miss_ppm = 10, of.exhausted_ppm = 100, of.gross_ppm = 1000, of.near_miss_ppm = 1e4;
  CHECK(failures_ppm(of) == 1111);
}

TEST_CASE("chart pareto: what no failure in so many rays leaves possible", "[chart]") {
  CHECK(unseen_failures_ppm(1000000) == 3);
  CHECK(unseen_failures_ppm(50000) == 60);
  CHECK(unseen_failures_ppm(1) == 1e6);
  CHECK(unseen_failures_ppm(0) == 1e6);
  // The rule of three approximates the failure rate p with (1 - p)^n = 0.05.
  CHECK(unseen_failures_ppm(50000) == Approx(1e6 * (1 - std::pow(0.05, 1.0 / 50000))).epsilon(0.002));
}

TEST_CASE("chart pareto: the front of a small set", "[chart]") {
  const std::vector<RayMeasurement> rows = {
      row("a", 10, 1e-1, 0),                         // the fastest
      row("b", 20, 1e-2, 5), row("c", 20, 1e-2, 5),  // equal: both stay
      row("d", 25, 1e-2, 0),                         // slower than b, but without failures
      row("e", 30, 2e-2, 0),                         // dominated by d
      row("f", 40, 1e-6, 9),
  };
  CHECK(front_of(rows, Cost::Time) == "abcdf");
  CHECK(front_of(rows, Cost::Evaluations) == "def");
  CHECK(front_of({row("a", 1, 1, 1)}, Cost::Time) == "a");
}

TEST_CASE("chart pareto: the reference and what was not measured take no part", "[chart]") {
  RayMeasurement reference = row("r", 5, 0, 0);
  CHECK(front_of({reference, row("a", 10, 1e-3, 0)}, Cost::Time) == "r");
  reference.reference = true;
  CHECK(front_of({reference, row("a", 10, 1e-3, 0)}, Cost::Time) == "a");
  CHECK(front_of({row("n", 1, kNaN, 0), row("m", kNaN, 1, 0), row("a", 10, 1e-3, 0)}, Cost::Time) == "a");
}

TEST_CASE("chart pareto: the staircase is of those that fail no more often than the default", "[chart]") {
  std::vector<RayMeasurement> rows = {row("x", 1, 1e-1, 500), row("a", 40, 1e-6, 0), row("b", 10, 1e-2, 2),
                                      row("c", 15, 2e-2, 0), row("d", 10, 3e-2, 0)};
  CHECK(names_of(reliable_front(rows, Cost::Time)) == "xba");
  rows.push_back(row(kDefaultMethod, 20, 1e-3, 2));
  CHECK(names_of(reliable_front(rows, Cost::Time)) == "btiereda");
  rows.back().gross_ppm = 0;
  CHECK(names_of(reliable_front(rows, Cost::Time)) == "dctiereda");
  rows.push_back(row("e", 60, 1e-6, 0));  // slower than a and no better
  CHECK(names_of(reliable_front(rows, Cost::Time)) == "dctiereda");
}

// This makes the chart readable: the eye can tell whether the default is on the front.
TEST_CASE("chart pareto: the default is on the front where it is on the staircase", "[chart]") {
  std::uint32_t state = 1;
  const auto random = [&](int below) {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>((state >> 16) % static_cast<std::uint32_t>(below));
  };
  int on = 0;
  for (int round = 0; round < 500; ++round) {
    std::vector<RayMeasurement> rows;
    for (int i = 0; i < 6; ++i) {
      const double ns = 1 + 16 * random(40) + i;  // no two times or errors are equal
      rows.push_back(row("a", ns, 1e-6 * (1 + 16 * random(40) + i), random(4)));
    }
    rows[3].method = kDefaultMethod;
    const auto stairs = reliable_front(rows, Cost::Time);
    const bool on_stairs = std::any_of(stairs.begin(), stairs.end(), is_default);
    const auto verdicts = judge_default(rows, "s", Cost::Time);
    REQUIRE(verdicts.size() == 1);
    CHECK(verdicts[0].on_front == on_stairs);
    CHECK(verdicts[0].on_front == verdicts[0].dominated_by.empty());
    on += verdicts[0].on_front;
  }
  CHECK(on > 100);
  CHECK(on < 400);
}

TEST_CASE("chart pareto: a verdict for each class that has the default", "[chart]") {
  auto rows = test::sample_rays();
  auto verdicts = judge_default(rows, "composite", Cost::Time);
  REQUIRE(verdicts.size() == 3);
  for (const FrontVerdict& verdict : verdicts) CHECK(verdict.on_front);
  CHECK(verdicts[1].ray_class == "bounce");
  RayMeasurement better = rows[5];
  REQUIRE(is_default(better));
  better.method = "better";
  better.ns_med *= 0.9;
  rows.push_back(better);
  verdicts = judge_default(rows, "composite", Cost::Time);
  CHECK_FALSE(verdicts[0].on_front);
  CHECK(names_of(verdicts[0].dominated_by) == "better");
  CHECK(judge_default(rows, "composite", Cost::Evaluations)[0].on_front);
  CHECK(judge_default(rows, "none", Cost::Time).empty());
}

TEST_CASE("chart fit: power laws are found exactly", "[chart]") {
  for (const double slope : {-1.0, -0.5, 0.0, 2.0}) {
    std::vector<double> x, y;
    for (const double at : {0.01, 0.3, 5.0, 700.0}) {
      x.push_back(at);
      y.push_back(3e-4 * std::pow(at, slope));
    }
    const PowerLaw law = fit_power_law(x, y);
    CHECK(law.slope == Approx(slope).margin(1e-12));
    CHECK(law.factor == Approx(3e-4).epsilon(1e-12));
  }
}

TEST_CASE("chart fit: the least squares of points off the line", "[chart]") {
  // In decades: (0, 0), (1, 1), (2, 0). The slope is 0 and the height 1/3.
  const PowerLaw law = fit_power_law(std::vector{1.0, 10.0, 100.0}, std::vector{1.0, 10.0, 1.0});
  CHECK(law.slope == Approx(0).margin(1e-12));
  CHECK(law.factor == Approx(std::pow(10.0, 1.0 / 3)));
}

TEST_CASE("chart fit: points without a logarithm take no part, one x is not enough", "[chart]") {
  const double infinity = std::numeric_limits<double>::infinity();
  const PowerLaw law = fit_power_law(std::vector{1.0, 0.0, 10.0, -1.0, kNaN, 5.0, infinity},
                                     std::vector{2.0, 7.0, 0.2, 7.0, 7.0, 0.0, 7.0});
  CHECK(law.slope == Approx(-1));
  CHECK(law.factor == Approx(2));
  CHECK(std::isnan(fit_power_law({}, {}).slope));
  CHECK(std::isnan(fit_power_law(std::vector{2.0}, std::vector{2.0}).slope));
  CHECK(std::isnan(fit_power_law(std::vector{2.0, 2.0}, std::vector{2.0, 3.0}).slope));
}

TEST_CASE("chart fit: a curve for each method and eps", "[chart]") {
  const auto curves = fit_curves(test::sample_images());
  REQUIRE(curves.size() == 4);
  CHECK(curves[0].method == "tiered");
  CHECK(curves[0].slope == Approx(-1).margin(0.005));  // the floor bends the curve a little
  CHECK(curves[1].eps == 1e-3);
  CHECK(curves[1].slope > -0.8);
}

}  // namespace
}  // namespace fathom::runtime::chart_pareto_test
