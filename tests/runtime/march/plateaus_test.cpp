// Fields that are 0 over a volume: nothing is solid there (docs/explanation/accuracy.md). Rays pass such a plateau
// from outside, and leave a solid where a plateau begins, both in float and in the search in double. The field along
// each ray is the truth for both.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "runtime/march/certified_search.h"
#include "runtime/march/march.h"
#include "runtime/measure/ray_sets.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::plateaus_test {
namespace {

using Status = RayHit::Status;

std::string number(double v) { return fmt::format("{:.4f}", v); }
std::string place(test::Random& random, double half) {
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", random.uniform(-half, half), random.uniform(-half, half),
                     random.uniform(-half, half));
}

// A body whose surface passes through the origin.
std::string body_at_origin(test::Random& random) {
  const double r = random.uniform(0.2, 0.7);
  const std::string radius = number(r), normal = place(random, 1);
  switch (random.below(8)) {
    case 0:
      return R"({"type": "intersection", "of": [{"type": "sphere", "radius": )" + radius +
             R"(}, {"type": "plane", "normal": [0, 0, 1]}]})";
    case 1:
      return R"({"type": "intersection", "of": [{"type": "sphere", "radius": )" + radius +
             R"(}, {"type": "plane", "normal": )" + normal + "}]}";
    case 2:
      return R"({"type": "extrude", "half_depth": 0.3, "of": {"type": "pie", "angle": )" +
             number(random.uniform(10, 170)) + R"(, "radius": )" + radius + "}}";
    case 3:
      return R"({"type": "box", "half_size": [0.4, 0.5, )" + radius + R"(], "translate": [0, 0.1, )" + radius + "]}";
    case 4:
      return R"({"type": "cut_sphere", "height": 0, "radius": )" + radius + R"(, "rotate": [)" +
             std::to_string(random.below(360)) + ", 0, 30]}";
    case 5:
      return R"({"type": "subtraction", "of": [{"type": "box", "half_size": [0.5, 0.5, 0.5]}, {"type": "box",
          "half_size": [0.6, 0.6, 0.3], "translate": [0, 0, 0.3]}]})";
    case 6:
      return R"({"type": "complement", "of": {"type": "sphere", "radius": )" + radius + R"(, "translate": [0, )" +
             radius + ", 0]}}";
    default:
      return R"({"type": "smooth_intersection", "k": 0.1, "of": [{"type": "sphere", "radius": )" + radius +
             R"(}, {"type": "plane", "normal": [0, 1, 0], "offset": 0.025}]})";
  }
}

// A field that is 0, or nearly 0, over a volume.
std::string plateau(test::Random& random) {
  const auto formula = [](const std::string& text) {
    return R"J({"type": "expression", "half_size": [1, 1, 1], "formula": ")J" + text + "\"}";
  };
  const std::string at = number(random.uniform(-0.5, 0.5)), half = number(random.uniform(0.01, 0.3)),
                    r = number(random.uniform(0.1, 0.5)), slope = number(random.uniform(0.1, 1));
  switch (random.below(8)) {
    case 0:
      return formula("min(max(abs(z - " + at + ") - " + half + ", 0), length(x, y, z) - " + r + ")");
    case 1:
      return formula("max(length(x, y, z) - " + r + ", 0)");
    case 2:
      return formula("max(length(x, y, z) - 0.8, max(" + slope + "*x + 0.3*y, 0))");
    case 3:
      return formula("max(length(x, y, z) - 0.7, min(abs(x + 0.2*z) - " + half + ", 0))");
    case 4:
      return formula("min(max(" + slope + "*x - 0.2*z, 0), max(length(x, y, z) - " + r + ", 0 - 0.1)) + 0*y");
    case 5: {
      const std::string body = body_at_origin(random);
      return R"({"type": "subtraction", "of": [{"type": "sphere", "radius": 0.8}, {"type": "elongate", "half_size":
          [0.2, 0.1, 0.3], "of": )" +
             body + "}]}";
    }
    default: {
      const auto pull = [&] { return number(random.chance(0.4) ? 0.0 : random.uniform(0.01, 0.4)); };
      const std::string by = fmt::format("[{}, {}, 0.2]", pull(), pull());
      return R"({"type": "elongate", "half_size": )" + by + R"(, "of": )" + body_at_origin(random) + "}";
    }
  }
}

// Returns the node, altered or combined with a ball.
std::string altered(test::Random& random, const std::string& of) {
  static const char* kWays[] = {R"({{"type": "onion", "thickness": 0.05, "of": {0}}})",
                                R"({{"type": "round", "radius": 0.04, "of": {0}}})",
                                R"({{"type": "complement", "of": {{"type": "complement", "of": {0}}}}})",
                                R"({{"type": "intersection", "of": [{0}, {1}]}})",
                                R"({{"type": "subtraction", "of": [{1}, {0}]}})",
                                R"({{"type": "smooth_union", "k": 0.1, "of": [{0}, {1}]}})",
                                R"({{"type": "mirror", "normal": [1, 0, 0.2], "of": {0}}})",
                                R"({{"type": "union", "scale": 0.7, "of": [{0}, {1}]}})"};
  if (random.chance(0.5)) return of;
  const std::string ball = R"({"type": "sphere", "radius": 0.5, "translate": )" + place(random, 0.6) + "}";
  return fmt::format(fmt::runtime(kWays[random.below(8)]), of, ball);
}

std::string random_plateaus(std::uint64_t seed) {
  test::Random random(seed);
  std::string objects;
  for (int i = random.below(2); i >= 0; --i) {
    objects += R"({"type": "union", "translate": )" + place(random, 1) + R"(, "rotate": )" +
               (random.chance(0.5) ? "[0, 0, 0]" : place(random, 180)) + R"(, "of": [)" +
               altered(random, plateau(random)) + "]}, ";
  }
  for (int i = 0; i < 3; ++i) {
    objects += R"({"type": "sphere", "radius": 0.3, "translate": )" + place(random, 1.8) + "}, ";
  }
  return R"("camera": {"position": [2, 1.5, 4], "target": [0, 0, 0]}, "film": {"width": 64, "height": 64}, "objects": [)" +
         objects + R"({"type": "box", "half_size": [2, 0.1, 2], "translate": [0, -2, 0]}])";
}

// The field in double along a ray.
class Truth {
 public:
  Truth(const Field& field, const Ray& ray)
      : field_(field),
        origin_(ray.origin),
        direction_(glm::normalize(ray.direction)),
        end_(std::min(ray.t_max, 20.0)) {
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (field.bound.lo[axis] - origin_[axis]) / direction_[axis],
                   b = (field.bound.hi[axis] - origin_[axis]) / direction_[axis];
      if (std::isnan(a) || std::isnan(b)) continue;  // parallel to a side of the box, and in its plane
      begin_ = std::max(begin_, std::min(a, b));
      end_ = std::min(end_, std::max(a, b));
    }
  }

  // True if the ray passed through a solid, or through the end of a solid, that float distinguishes from a touch.
  bool loses(const RayHit& ray_hit, RealScratch& scratch) const {
    constexpr int kPlaces = 200;
    const double end = ray_hit.status == Status::Hit ? ray_hit.t - 1e-3 : end_;
    const double tall = 4 * kDistanceErrorInDouble * (4 + static_cast<double>(field_.cancellation));
    int level = 0;
    for (int i = 1; i < kPlaces; ++i) {
      const double t = begin_ + (end - begin_) * i / kPlaces, g = ray_hit.side * at(t, scratch);
      if (g < -tall) return true;
      level = std::abs(g) <= field_.rounding(origin_ + t * direction_) ? level + 1 : 0;
      if (ray_hit.side < 0 && level == 3 && end - begin_ > 0.01) return true;
    }
    return false;
  }

  // True if a hit has no solid behind it.
  bool is_false_hit(const RayHit& ray_hit, RealScratch& scratch) const {
    if (ray_hit.status != Status::Hit || ray_hit.side < 0) return false;
    for (double beyond = 1e-12; beyond < 0.02; beyond *= 2) {
      for (const double t : {ray_hit.t + beyond, ray_hit.t - std::min(beyond, 1e-5)}) {
        if (at(t, scratch) < -0.5 * field_.rounding(origin_ + t * direction_)) return false;
      }
    }
    return true;
  }

 private:
  static constexpr double kDistanceErrorInDouble = vm::kFloatError;
  double at(double t, RealScratch& scratch) const {
    std::uint64_t instructions = 0;
    return field_.evaluate(origin_ + t * direction_, scratch, instructions);
  }

  const Field& field_;
  glm::dvec3 origin_, direction_;
  double begin_ = 0, end_;
};

struct Tally {
  // differ: hits of only one of float and double, or hits more than 1e-3 apart.
  int rays = 0, hits = 0, near_misses = 0, lost = 0, lost_in_double = 0, false_hits = 0, false_in_double = 0,
      differ = 0;
  std::uint64_t evaluations = 0, searched = 0, most = 0;  // most: of a single ray
  std::string first, report;                              // the first wrong ray of a scene; those of all scenes

  int wrong() const { return lost + lost_in_double + false_hits + false_in_double; }
};

std::string describe(const char* wrong, const Ray& ray, const RayHit& found, const RayHit& exact) {
  return fmt::format(
      "{}: ray {:.17g} {:.17g} {:.17g} to {:.17g} {:.17g} {:.17g}, side {}: {} at {:.9g}, in double {} at {:.9g}",
      wrong, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, found.side,
      static_cast<int>(found.status), found.t, static_cast<int>(exact.status), exact.t);
}

void judge(const Field& field, const std::vector<Ray>& rays, Tally& tally) {
  const std::vector<RayHit> found = march(field, rays).ray_hits,
                            exact = march(field, rays, {.method = Method::Certified}).ray_hits;
  RealScratch scratch;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Truth truth(field, rays[i]);
    const RayHit &a = found[i], &b = exact[i];
    const bool hit = a.status == Status::Hit, met = b.status == Status::Hit;
    ++tally.rays;
    tally.hits += met;
    tally.near_misses += b.status == Status::NearMiss;
    tally.evaluations += a.evaluations;
    tally.searched += b.evaluations;
    tally.most = std::max({tally.most, std::uint64_t{a.evaluations}, std::uint64_t{b.evaluations}});
    tally.differ += hit != met || (hit && std::abs(a.t - b.t) > 1e-3);
    const int before = tally.wrong();
    const char* what = "";
    const auto note = [&](bool wrong, int& count, const char* name) {
      if (wrong) ++count, what = name;
    };
    note(truth.loses(a, scratch), tally.lost, "lost");
    note(truth.loses(b, scratch), tally.lost_in_double, "lost in double");
    note(truth.is_false_hit(a, scratch), tally.false_hits, "false hit");
    note(truth.is_false_hit(b, scratch), tally.false_in_double, "false hit in double");
    if (tally.wrong() > before && tally.first.empty()) tally.first = describe(what, rays[i], a, b);
  }
}

std::vector<Ray> rays_within(const Field& field, std::size_t count, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 from = random.in_box(1.5), to = glm::dvec3(glm::vec3(random.direction()));
    rays.push_back({from, to});
  }
  RealScratch scratch;
  std::uint64_t instructions = 0;
  // Removes rays that begin on a plateau or at a surface: rounding decides which side they begin on.
  std::erase_if(rays,
                [&](const Ray& ray) { return std::abs(field.evaluate(ray.origin, scratch, instructions)) < 1e-5; });
  return rays;
}

void try_scenes(std::uint64_t first, int scenes, std::size_t rays, Tally& tally) {
  std::uint64_t reported = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(scenes); ++seed) {
    const compiler::CompiledScene scene = scene_of(random_plateaus(seed));
    if (!(scene.lipschitz > 0)) continue;
    const Field field = make_field(scene);
    tally.first.clear();
    for (const RaySet& set : make_ray_sets(scene, field, rays, seed)) judge(field, set.rays, tally);
    judge(field, rays_within(field, rays, seed), tally);
    if (!tally.first.empty() && reported++ < 20) tally.report += fmt::format("scene {}, {}\n", seed, tally.first);
  }
}

}  // namespace

// Small scenes with a ball behind a plateau. `from`: z at which the ray (0, 0, -1) through x = y = 0.1 starts. `hit`:
// t of the ray's hit. Regression: rays were lost in the plateau, in float at its edge, in double after spending their
// evaluations.
TEST_CASE("plateaus: the smallest scenes whose rays were lost", "[march]") {
  const double ball = 0.3 - std::sqrt(0.3 * 0.3 - 0.02);
  const struct {
    const char* objects;
    double from, hit;
  } kScenes[] = {// A half ball elongated by 0.4: the field is 0 over these 0.4, and nothing is above.
                 {R"({"type": "elongate", "half_size": [0, 0, 0.2], "of": {"type": "intersection", "of": [
          {"type": "sphere", "radius": 0.6}, {"type": "plane", "normal": [0, 0, 1]}]}})",
                  2, 2.2},
                 {R"J({"type": "expression", "half_size": [1, 1, 1],
          "formula": "min(max(abs(z - 0.5) - 0.1, 0), length(x, y, z) - 0.3)"})J",
                  2, 1.7 + ball},
                 {R"J({"type": "expression", "half_size": [1, 1, 1], "formula": "max(abs(z - 0.5) - 0.1, 0)"},
          {"type": "sphere", "radius": 0.3, "translate": [0, 0, -1.5]})J",
                  2, 3.2 + ball}};
  for (const auto& [objects, from, hit] : kScenes) {
    INFO(objects);
    const auto scene = scene_of(std::string(R"("objects": [)") + objects + "]");
    const Field field = make_field(scene);
    const std::vector<Ray> rays = {{{0.1, 0.1, from}, {0, 0, -1}}};
    for (const Method method : {Method::Tiered, Method::Certified}) {
      const RayHit ray_hit = march(field, rays, {.method = method}).ray_hits[0];
      CHECK(ray_hit.status == Status::Hit);
      CHECK(ray_hit.t == Approx(hit).epsilon(1e-6));
      CHECK(ray_hit.evaluations < 2000);
    }
  }
}

// A ray inside a solid leaves it where the field becomes 0 for good, but not where two bodies touch.
TEST_CASE("plateaus: a solid ends where the field stays 0, not where two solids touch", "[march]") {
  const auto ending = scene_of(R"J("objects": [{"type": "expression", "half_size": [2, 2, 2],
      "formula": "max(min(abs(z) - 0.5, 0), abs(z) - 1)"}])J");
  const auto touching = scene_of(R"("objects": [
      {"type": "box", "half_size": [1, 1, 0.5], "translate": [0, 0, 0.5]},
      {"type": "box", "half_size": [1, 1, 0.5], "translate": [0, 0, -0.5]}])");
  for (const Method method : {Method::Tiered, Method::Certified}) {
    const std::vector<Ray> rays = {{{0.1, 0.2, 0.1}, {0, 0, 1}}, {{0.1, 0.2, -0.75}, {0, 0, 1}}};
    const RayHit out = march(make_field(ending), std::span(rays).first(1), {.method = method}).ray_hits[0];
    CHECK(out.side == -1);
    CHECK(out.status == Status::Hit);
    CHECK(out.t == Approx(0.4).epsilon(1e-5));
    const RayHit through = march(make_field(touching), std::span(rays).last(1), {.method = method}).ray_hits[0];
    CHECK(through.side == -1);
    CHECK(through.t == Approx(1.75).epsilon(1e-6));
  }
}

TEST_CASE("plateaus: rays pass what is 0 over a volume, and leave solids there", "[march]") {
  Tally tally;
  try_scenes(1, test::scaled_cases(12), 30, tally);
  CAPTURE(tally.rays, tally.hits, tally.near_misses, tally.lost, tally.lost_in_double, tally.false_hits,
          tally.false_in_double, tally.differ, tally.evaluations, tally.searched);
  INFO(tally.report);
  CHECK(tally.wrong() == 0);
  CHECK(tally.differ == 0);
}

// Scenes that lost rays, with these causes. The derivative over a plateau was that of its surroundings, so the search
// spent its budget and skipped what follows. The interval value of `elongate` was as wide as the interval of t. A ray
// in the plane of a face spent its budget, and the rest of the ray was one step. A solid's end lay between two
// intervals without a root. A solid's end showed only in values, each level with 0. One ray took 33 million
// evaluations, in steps that intervals could decide, however small.
TEST_CASE("plateaus: scenes whose rays were lost", "[march]") {
  for (const std::uint64_t seed : {7000049u, 7000154u, 1002530u, 1006021u, 1000284u, 2010441u}) {
    Tally tally;
    try_scenes(seed, 1, 100, tally);
    INFO(tally.report);
    CHECK(tally.rays > 300);
    CHECK(tally.wrong() == 0);
    CHECK(tally.most <= 4 * kSearchBudget);
  }
}

// FATHOM_PLATEAU_SCENES=38000 build/release/tests/fathom_tests "plateaus: as many*"
TEST_CASE("plateaus: as many scenes as are asked for", "[nightly][.]") {
  const char* scenes = std::getenv("FATHOM_PLATEAU_SCENES");
  const char* seed = std::getenv("FATHOM_PLATEAU_SEED");
  Tally tally;
  try_scenes(seed ? std::strtoull(seed, nullptr, 10) : 1'000'000, scenes ? std::atoi(scenes) : 1000, 100, tally);
  WARN(fmt::format(
      "{} rays, {} hits, {} near misses, {} lost, {} lost in double, {} false hits, {} false in double, {} "
      "differ, {} evaluations, {} searching, at most {} a ray",
      tally.rays, tally.hits, tally.near_misses, tally.lost, tally.lost_in_double, tally.false_hits,
      tally.false_in_double, tally.differ, tally.evaluations, tally.searched, tally.most));
  INFO(tally.report);
  CHECK(tally.wrong() == 0);
  CHECK(tally.differ <= 1 + tally.rays / 100'000);
  CHECK(tally.most <= 4 * kSearchBudget);
}

}  // namespace fathom::runtime::plateaus_test
