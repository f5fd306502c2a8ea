#include "runtime/stats.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace fathom::runtime {
namespace {

TEST_CASE("stats: counts add up and come out as JSON", "[runtime]") {
  Stats a, b;
  a.primary_rays = 3;
  a.march.rays = 4;
  a.march.evaluations = 40;
  b.primary_rays = 2;
  b.march.rays = 1;
  b.march.evaluations = 10;
  b.dropped_samples = 1;
  a.merge(b);
  a.seconds = 2;
  const auto json = nlohmann::json::parse(to_json(a));
  CHECK(json["primary_rays"] == 5);
  CHECK(json["rays"] == 5);
  CHECK(json["evaluations_per_ray"] == 10);
  CHECK(json["rays_per_second"] == 2.5);
  CHECK(json["dropped_samples"] == 1);
  CHECK(json["cancelled"] == false);
  CHECK(to_table(a).find("camera rays") != std::string::npos);
}

}  // namespace
}  // namespace fathom::runtime
