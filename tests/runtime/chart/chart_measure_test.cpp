// Measurements of `fathom chart`, except times: the traced rays, their errors, images and maps.
#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <string>

#include "runtime/march/march.h"
#include "runtime/measure/maps.h"
#include "runtime/measure/measure_images.h"
#include "runtime/measure/measure_rays.h"
#include "runtime/measure/ray_sets.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "vm/encoding/digest.h"

namespace fathom::runtime::chart_measure_test {
namespace {

// A unit ball in the middle of the image, with light from all directions.
const char* const kBallScene = R"("camera": {"position": [0, 0, 4], "target": [0, 0, 0], "fov_y": 50},
    "film": {"width": 32, "height": 16}, "background": {"bottom": [0.2, 0.2, 0.2], "top": [1, 1, 1]},
    "objects": [{"type": "sphere", "radius": 1}])";
// A ball on the ground.
const char* const kGroundScene = R"("camera": {"position": [0, 0.5, 4], "target": [0, -0.5, 0]},
    "film": {"width": 32, "height": 16}, "background": {"bottom": [0.2, 0.2, 0.2], "top": [1, 1, 1]},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1}, {"type": "sphere", "radius": 1}])";
// A floor under a small lamp.
const char* const kAreaLightScene = R"("camera": {"position": [0, 0.5, 4], "target": [0, -0.5, 0]},
    "film": {"width": 32, "height": 16}, "render": {"rr_depth": 2},
    "materials": {"lamp": {"type": "emissive", "emission": [50, 50, 50]}},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
                {"type": "sphere", "radius": 0.2, "translate": [0, 1, 0], "material": "lamp"}])";
// The ball with the camera turned away.
const char* const kNothingSeen = R"("camera": {"position": [0, 0, 4], "target": [0, 0, 8]},
    "objects": [{"type": "sphere", "radius": 1}])";

bool same(const Ray& a, const Ray& b) {
  return a.origin == b.origin && a.direction == b.direction && a.slope == b.slope && a.t_max == b.t_max;
}

bool same(const std::vector<RaySet>& a, const std::vector<RaySet>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const RaySet& x, const RaySet& y) {
    return std::equal(x.rays.begin(), x.rays.end(), y.rays.begin(), y.rays.end(),
                      [](const Ray& r, const Ray& s) { return same(r, s); });
  });
}

TEST_CASE("chart: rays of three classes, exact in float, the same for the same seed", "[chart]") {
  const auto scene = scene_of(kBallScene);
  const Field field = make_field(scene);
  const std::vector<RaySet> sets = make_ray_sets(scene, field, 300, 5);
  REQUIRE(sets.size() == 3);
  CHECK(sets[0].ray_class == "camera");
  CHECK(sets[1].ray_class == "bounce");
  CHECK(sets[2].ray_class == "grazing");
  for (const RaySet& set : sets) {
    INFO(set.ray_class);
    CHECK(set.rays.size() == 300);
    for (const Ray& ray : set.rays) {
      const bool exact = ray.origin == to_float(ray.origin) && ray.direction == to_float(ray.direction);
      if (!exact || std::abs(glm::length(ray.direction) - 1) > 1e-6) FAIL_CHECK("a ray that float does not hold");
    }
  }
  CHECK(same(sets, make_ray_sets(scene, field, 300, 5)));
  CHECK_FALSE(same(sets, make_ray_sets(scene, field, 300, 6)));
}

// Coordinates were drawn as arguments of one call, so clang's rays had x and z or y exchanged. The gap of a grazing
// ray was libm's power of ten.
TEST_CASE("chart: rays of a seed are the same with every compiler and on every processor", "[chart]") {
  const auto scene = scene_of(kBallScene);
  std::string bytes;
  for (const RaySet& set : make_ray_sets(scene, make_field(scene), 20, 5)) {
    for (const Ray& ray : set.rays) {
      bytes += fmt::format("{} {} {} ", ray.origin.x, ray.origin.y, ray.origin.z);
      bytes += fmt::format("{} {} {}\n", ray.direction.x, ray.direction.y, ray.direction.z);
    }
  }
  CHECK(vm::digest(bytes).text() == "41a1760bc2d9029e42992dbaca54f791");
}

TEST_CASE("chart: bounces start above surfaces, and grazing rays pass them closely on either side", "[chart]") {
  const auto scene = scene_of(kBallScene);
  const Field field = make_field(scene);
  const double extent = extent_of(field);
  CHECK(extent == Approx(std::sqrt(3)).epsilon(1e-5));  // half the diagonal of the ball's bounding box
  const std::vector<RaySet> sets = make_ray_sets(scene, field, 2000, 5);
  for (const Ray& ray : sets[0].rays) {
    if (ray.origin != glm::dvec3(0, 0, 4)) FAIL_CHECK("a camera ray from elsewhere");
  }
  double slopes = 0;
  for (const Ray& ray : sets[1].rays) {
    CHECK(std::abs(glm::length(ray.origin) - (1 + 4e-4 * extent)) <= 1e-6);
    CHECK(std::abs(static_cast<double>(ray.slope) - glm::dot(ray.direction, glm::normalize(ray.origin))) <= 1e-6);
    CHECK((ray.slope >= 0 && ray.slope <= 1));
    slopes += static_cast<double>(ray.slope) / 2000;
  }
  CHECK(slopes == Approx(0.5).margin(0.02));  // uniform over the hemisphere
  int within = 0, near = 0;
  for (const Ray& ray : sets[2].rays) {
    const double gap = glm::length(glm::cross(ray.origin, ray.direction)) - 1;
    CHECK(std::abs(gap) <= 1.001e-2 * extent);
    CHECK(std::abs(gap) >= 0.5e-6 * extent);
    CHECK(glm::length(ray.origin) > 1);
    within += gap < 0;
    near += std::abs(gap) < 1e-4 * extent;
  }
  CHECK(within == Approx(1000).margin(100));
  CHECK(near == Approx(1000).margin(100));
}

TEST_CASE("chart: where the camera sees nothing there is nothing to bounce off", "[chart]") {
  const auto scene = scene_of(kNothingSeen);
  const Field field = make_field(scene);
  const std::vector<RaySet> sets = make_ray_sets(scene, field, 100, 1);
  REQUIRE(sets.size() == 3);
  CHECK(sets[0].rays.size() == 100);
  CHECK(sets[1].rays.empty());
  CHECK(sets[2].rays.empty());
  // An empty set of rays gives no rows. Rays that all miss give no errors.
  const std::vector<Marching> methods = {{.method = Method::Tiered}, {.method = Method::Certified}};
  const auto rows = measure_rays(scene, field, sets, methods, 1, "nothing");
  REQUIRE(rows.size() == 2);
  for (const RayMeasurement& row : rows) {
    CHECK(row.ray_class == "camera");
    CHECK(std::isnan(row.terr_p50));
    CHECK(std::isnan(row.nerr_max));
    CHECK(row.false_hit_ppm + row.false_miss_ppm + row.exhausted_ppm + row.gross_ppm == 0);
  }
}

TEST_CASE("chart: what is charted ends with the reference, and starts with what pictures are made with", "[chart]") {
  const std::vector<Marching> charted = charted_methods();
  CHECK(charted.size() == 33);
  CHECK(charted.back().method == Method::Certified);
  const std::vector<ImageVariant> painted = image_variants(scene_of(kBallScene));
  CHECK(painted.size() == 4);
  for (const Marching& first : {charted.front(), painted.front().marching}) {
    CHECK(first.method == Marching{}.method);
    CHECK(first.precision == Marching{}.precision);
  }
  CHECK(info(Marching{}.method).name == kDefaultMethod);
  const Settings settings = resolve(scene_of(kBallScene), {});
  CHECK((painted.front().sampler == settings.sampler && painted.front().light_sampling == settings.light_sampling));
  CHECK(compiler::kSamplerNames[static_cast<std::size_t>(settings.sampler)] == kDefaultSampler);
  CHECK(kLightSamplingNames[static_cast<std::size_t>(settings.light_sampling)] == kDefaultLights);
  CHECK(image_variants(scene_of(kAreaLightScene)).size() == 9);
  // Regression: the sky was not counted as a light to sample.
  const std::string under_sky = R"("background": {"type": "sky"}, "objects": [{"type": "sphere", "radius": 1}])";
  CHECK(image_variants(scene_of(under_sky)).size() == 9);
}

// One row per way, in the order of kWays, for each class of rays.
enum Way { kTiered, kCoarse, kFine, kHasty, kRelaxed, kReference, kWays };
std::vector<Marching> variants() {
  return {{.method = Method::Tiered},
          {.method = Method::Sphere, .epsilon = 1e-2},
          {.method = Method::Sphere, .precision = Precision::Double, .epsilon = 1e-4},
          {.method = Method::Sphere, .epsilon = 1e-4, .steps = 3},
          {.method = Method::Relaxed, .epsilon = 1e-4, .relaxation = 1.3},
          {.method = Method::Certified}};
}

void expect_described(std::span<const RayMeasurement> rows, const std::string& ray_class) {
  for (const RayMeasurement& row : rows) {
    CHECK(row.scene == "ground");
    CHECK(row.ray_class == ray_class);
    CHECK(row.rays == 400);
    CHECK((0 < row.ns_min && row.ns_min <= row.ns_med && row.ns_med <= row.ns_max));
    CHECK((row.evals_mean > 0 && row.evals_p99 >= 1));
    CHECK(row.reference == (&row == &rows[kReference]));
  }
  CHECK((rows[kTiered].method == "tiered" && rows[kTiered].precision == "f32"));
  CHECK((rows[kTiered].eps == 0 && rows[kTiered].relax == 0 && rows[kTiered].steps_max == 0));
  CHECK((rows[kCoarse].method == "sphere" && rows[kCoarse].eps == 1e-2 && rows[kCoarse].relax == 1));
  CHECK((rows[kFine].precision == "f64" && rows[kFine].steps_max == Marching{}.steps));
  CHECK((rows[kHasty].steps_max == 3 && rows[kRelaxed].relax == 1.3));
  CHECK((rows[kReference].method == "certified" && rows[kReference].precision == "f64"));
}

void expect_judged(std::span<const RayMeasurement> rows) {
  const RayMeasurement& reference = rows[kReference];
  CHECK((reference.terr_max == 0 && reference.nerr_max == 0));
  CHECK(reference.false_hit_ppm + reference.false_miss_ppm + reference.exhausted_ppm + reference.gross_ppm == 0);
  CHECK(rows[kTiered].terr_max <= 1e-4);
  CHECK(rows[kTiered].false_hit_ppm + rows[kTiered].false_miss_ppm + rows[kTiered].exhausted_ppm == 0);
  CHECK(rows[kCoarse].terr_p50 > 10 * rows[kFine].terr_p50);
  CHECK(rows[kCoarse].terr_p99 > rows[kFine].terr_p99);
  CHECK(rows[kCoarse].terr_p50 <= rows[kCoarse].terr_p99);
  CHECK(rows[kCoarse].terr_p99 <= rows[kCoarse].terr_max);
  CHECK(rows[kCoarse].terr_p99 > 1e-2);
  CHECK(rows[kHasty].exhausted_ppm > 1e5);
  CHECK(rows[kHasty].exhausted_ppm <= 1e6);
  CHECK(rows[kHasty].evals_p99 <= 3);
  CHECK(rows[kRelaxed].evals_mean < rows[kFine].evals_mean);
}

TEST_CASE("chart: errors are those to the reference, and thresholds show", "[chart]") {
  const auto scene = scene_of(kGroundScene);
  const Field field = make_field(scene);
  const std::vector<RaySet> sets = make_ray_sets(scene, field, 400, 2);
  const std::vector<RayMeasurement> rows = measure_rays(scene, field, sets, variants(), 2, "ground");
  REQUIRE(rows.size() == 3 * kWays);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    INFO(sets[i].ray_class);
    const auto of_set = std::span(rows).subspan(i * kWays, kWays);
    expect_described(of_set, sets[i].ray_class);
    expect_judged(of_set);
  }
  // A coarse threshold takes rays that pass the ball for hits.
  CHECK(rows[2 * kWays + kCoarse].false_hit_ppm + rows[2 * kWays + kCoarse].gross_ppm > 1e5);
}

TEST_CASE("chart: a ray without a true answer is nobody's failure", "[chart]") {
  const auto scene = scene_of(R"("objects": [{"type": "box", "half_size": [1, 1, 1]}])");
  const Field field = make_field(scene);
  // Passes an edge of the box at a distance below double precision.
  const glm::dvec3 along = glm::normalize(glm::dvec3(1, -1, 0)), edge(1 + 0x1p-43, 1 + 0x1p-43, 0.25);
  const std::vector<RaySet> sets = {{"touching", {{edge - 3.0 * along, along}}}};
  REQUIRE(march(field, sets[0].rays, {.method = Method::Certified}).counters.near_misses == 1);
  const auto rows = measure_rays(scene, field, sets, variants(), 1, "box");
  REQUIRE(rows.size() == kWays);
  CHECK(rows[kReference].near_miss_ppm == 1e6);
  for (const RayMeasurement& row : rows) {
    INFO(row.method << " " << row.eps);
    CHECK(row.false_hit_ppm + row.false_miss_ppm + row.exhausted_ppm + row.gross_ppm == 0);
  }
}

TEST_CASE("chart: small pictures against their reference", "[chart]") {
  const auto scene = scene_of(kGroundScene);
  const ImagePlan plan{.width = 8, .height = 8, .spp = 16, .seeds = 2, .reference_spp = 512};
  const std::vector<ImageVariant> variants = {{}, {.marching = {.method = Method::Sphere, .epsilon = 0.3}}};
  cpu_set_t before, after;
  REQUIRE(sched_getaffinity(0, sizeof before, &before) == 0);
  const std::vector<ImageMeasurement> rows = measure_images(scene, variants, plan, "ground");
  REQUIRE(sched_getaffinity(0, sizeof after, &after) == 0);
  CHECK(CPU_EQUAL(&before, &after));
  REQUIRE(rows.size() == 4);  // two ways, 16 and 4 samples each
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ImageMeasurement& row = rows[i];
    CHECK(row.scene == "ground");
    CHECK(row.method == info(variants[i / 2].marching.method).name);
    CHECK(row.eps == (i < 2 ? 0 : 0.3));
    CHECK(row.spp == (i % 2 == 0 ? 16 : 4));
    CHECK(row.seeds == 2);
    CHECK((0 < row.seconds_min && row.seconds_min <= row.seconds_med && row.seconds_med <= row.seconds_max));
    CHECK((0 < row.relmse_p05 && row.relmse_p05 <= row.relmse_med && row.relmse_med <= row.relmse_p95));
    CHECK(row.relmse_trimmed_med <= row.relmse_p95);
    CHECK((0 < row.floor && row.floor < row.relmse_p95));  // the mean of the images is better than the worst image
  }
  CHECK(rows[0].relmse_p95 < rows[1].relmse_p05);  // four times the samples
  CHECK(rows[2].floor > 4 * rows[0].floor);        // the large epsilon thickens the ball and changes the image
  const std::vector<ImageMeasurement> again = measure_images(scene, variants, plan, "ground");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(again[i].relmse_med == rows[i].relmse_med);
    CHECK(again[i].floor == rows[i].floor);
  }
}

TEST_CASE("chart: samplers and ways to find light are told apart, and looking for lamps pays", "[chart]") {
  const auto scene = scene_of(kAreaLightScene);
  const ImagePlan plan{.width = 8, .height = 8, .spp = 16, .seeds = 3, .reference_spp = 1024};
  const std::vector<ImageVariant> variants = {
      {}, {.sampler = compiler::SamplerKind::Independent, .light_sampling = LightSampling::Bsdf}};
  const std::vector<ImageMeasurement> rows = measure_images(scene, variants, plan, "lamp");
  REQUIRE(rows.size() == 4);
  CHECK((rows[0].sampler == "blue" && rows[0].lights == "mis"));
  CHECK((rows[2].sampler == "independent" && rows[2].lights == "bsdf"));
  CHECK(rows[0].relmse_p95 < 0.1 * rows[2].relmse_p05);
}

TEST_CASE("chart: maps have a number for each pixel, and none where nothing is to see", "[chart]") {
  const auto scene = scene_of(kBallScene);
  const PixelMaps maps = measure_maps(scene, make_field(scene), 32, 16);
  CHECK((maps.width == 32 && maps.height == 16));
  for (const std::vector<float>* map : {&maps.evaluations, &maps.in_double, &maps.depth_error}) {
    REQUIRE(map->size() == 32 * 16);
  }
  int missing = 0;
  for (std::size_t i = 0; i < maps.depth_error.size(); ++i) {
    const double x = (static_cast<double>(i % 32) - 15.5) / 8, y = (static_cast<double>(i / 32) - 7.5) / 8;
    // Tangents of the angles from the view axis, of the pixel and of the ball's outline. Half the height is 8 pixels.
    const double radius = std::hypot(x, y) * std::tan(25 * M_PI / 180), outline = 1 / std::sqrt(15);
    INFO("pixel " << i % 32 << ", " << i / 32);
    if (std::abs(radius - outline) > 1e-3) CHECK(std::isnan(maps.depth_error[i]) == (radius > outline));
    missing += std::isnan(maps.depth_error[i]);
    if (!std::isnan(maps.depth_error[i])) {
      CHECK(maps.depth_error[i] <= 64);
      CHECK(maps.evaluations[i] > 0);
    }
    CHECK(maps.in_double[i] <= maps.evaluations[i]);
  }
  CHECK((missing > 0 && missing < 32 * 16));
}

}  // namespace
}  // namespace fathom::runtime::chart_measure_test
