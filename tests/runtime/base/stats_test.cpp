#include "runtime/base/stats.h"
#include "tests/support/catch.h"

#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>
#include <vector>

namespace fathom::runtime::stats_test {
namespace {

TEST_CASE("stats: counts add up and come out as JSON", "[base]") {
  Stats a, b;
  a.primary_rays = 3;
  a.march.rays = 4;
  a.march.evaluations = 40;
  b.primary_rays = 2;
  b.march.rays = 1;
  b.march.evaluations = 10;
  b.dropped_samples = 1;
  a.shadow_rays = 7;
  b.shadow_rays = 2;
  b.bounce_rays = 5;
  a.merge(b);
  a.seconds = 2;
  const auto json = nlohmann::json::parse(to_json(a));
  CHECK(json["primary_rays"] == 5);
  CHECK(json["rays"] == 5);
  CHECK(json["shadow_rays"] == 9);
  CHECK(json["bounce_rays"] == 5);
  CHECK(json["evaluations_per_ray"] == 10);
  CHECK(json["rays_per_second"] == 2.5);
  CHECK(json["dropped_samples"] == 1);
  CHECK(json["cancelled"] == false);
  CHECK(json.count("stage_seconds") == 0);
  CHECK(to_table(a).find("camera rays") != std::string::npos);
  CHECK(to_table(a).find("seconds of") == std::string::npos);
}

TEST_CASE("stats: instructions an evaluation, and the share of lanes that held a ray", "[base]") {
  Stats stats;
  CHECK(stats.instructions_per_evaluation() == 0);
  CHECK(stats.utilisation() == 1);
  stats.march.evaluations = 100;
  stats.march.certified_evaluations = 10;
  stats.march.instructions = 700;
  stats.march.lanes = 120;
  const auto json = nlohmann::json::parse(to_json(stats));
  CHECK(json["instructions_per_evaluation"] == 7);
  CHECK(json["utilisation"] == 0.75);
  CHECK(to_table(stats).find("75.000") != std::string::npos);
}

TEST_CASE("stats: stages of threads add up, and what is left of their time is waiting", "[base]") {
  Stats a, b;
  a.stages = StageSeconds{3, 0.5, 0.25, 0.125, 0};
  b.stages = StageSeconds{2, 0, 0.25, 0.125, 0.75};
  Stats sum;
  sum.merge(a);
  sum.merge(b);
  sum.merge(Stats());
  CHECK(sum.stages == StageSeconds{5, 0.5, 0.5, 0.25, 0.75});
  sum.seconds = 4;
  sum.threads = 2;
  const auto json = nlohmann::json::parse(to_json(sum));
  CHECK(json["stage_seconds"].size() == std::size(kStages));
  CHECK(json["stage_seconds"]["march"] == 5);
  CHECK(json["stage_seconds"]["film"] == 0.75);
  const std::string table = to_table(sum);
  CHECK(table.find("seconds of march                   5.000   62.5 %\n") != std::string::npos);
  CHECK(table.find("seconds of waiting                 1.000   12.5 %\n") != std::string::npos);
}

TEST_CASE("stats: a clock charges each stage what passes in it, and no time twice", "[base]") {
  using Clock = std::chrono::steady_clock;
  StageClock clock;
  clock.enter(Stage::Film);
  clock.stop();
  CHECK(clock.seconds() == StageSeconds{});  // the clock was not started

  const auto pass = [] { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  const Clock::time_point start = Clock::now();
  clock.start(Stage::March);
  pass();
  CHECK(clock.enter(Stage::Certify) == Stage::March);
  pass();
  CHECK(clock.enter(Stage::March) == Stage::Certify);
  CHECK(clock.enter(Stage::March) == Stage::March);
  pass();
  clock.enter(Stage::Film);
  clock.stop();
  pass();
  clock.enter(Stage::Shading);  // after stop(): not measured
  const double all = std::chrono::duration<double>(Clock::now() - start).count();
  const StageSeconds seconds = clock.seconds();
  CHECK(seconds[static_cast<std::size_t>(Stage::March)] >= 0.004);
  CHECK(seconds[static_cast<std::size_t>(Stage::Certify)] >= 0.002);
  CHECK(seconds[static_cast<std::size_t>(Stage::Normals)] == 0);
  CHECK(seconds[static_cast<std::size_t>(Stage::Shading)] == 0);
  CHECK(std::accumulate(seconds.begin(), seconds.end(), 0.0) <= all - 0.002);
}

TEST_CASE("stats: the peak of memory grows with what is held", "[base]") {
  const std::uint64_t before = peak_memory();
  REQUIRE(before > 1u << 20);
  REQUIRE(before < std::uint64_t{1} << 40);
  // More than the process ever held, whatever it has freed since.
  const std::vector<char> held(before + (16u << 20), 1);
  CHECK(peak_memory() >= held.size());
  CHECK(std::accumulate(held.begin(), held.begin() + 10, 0) == 10);
}

}  // namespace
}  // namespace fathom::runtime::stats_test
