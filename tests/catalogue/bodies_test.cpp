// The adversarial catalogue, rows I9 to I16: rays that leave bodies or start inside them, invalid rays, and solids
// cut out of each other. docs/explanation/accuracy.md lists all rows.
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "tests/catalogue/closed_forms.h"
#include "tests/catalogue/departures.h"
#include "tests/catalogue/naive.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::catalogue::bodies_test {
namespace {

void expect_right(const Judgement& found) {
  CHECK(found.wrong() == 0);
  CHECK(found.exhausted == 0);
}

// Rays in random directions that start `away` in front of a random point in a box.
std::vector<Ray> rays_at_box(Random& random, glm::dvec3 half, double away, int count) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 through(random.uniform(-half.x, half.x), random.uniform(-half.y, half.y),
                             random.uniform(-half.z, half.z));
    const glm::dvec3 d = random.direction();
    rays.push_back({to_float(through - away * d), to_float(d)});
  }
  return rays;
}

const glm::dvec3 kLeft(-0.5, 0, 0), kRight(0.5, 0, 0);

// Distance at which a ray leaves the union of two overlapping balls of radius 1, left and right.
Real union_exit(const Ray& ray) {
  const Span left = sphere_span(ray, kLeft, 1), right = sphere_span(ray, kRight, 1);
  Real exit = 0;
  for (int i = 0; i < 2; ++i) {
    for (const Span& span : {left, right}) {
      if (!span.empty() && span.begin <= exit && span.end > exit) exit = span.end;
    }
  }
  return exit;
}

// Number of rays that leave a convex body and meet it again, out of `count` rays or slightly more.
std::uint64_t met_again(std::size_t count) {
  const char* bodies[] = {R"({"type": "sphere", "radius": 1})",
                          R"({"type": "box", "half_size": [0.75, 0.5, 1]})",
                          R"({"type": "plane", "normal": [0.6, 0.8, 0]})",
                          R"({"type": "cylinder", "radius": 0.75, "half_height": 0.5})",
                          R"({"type": "cone", "bottom_radius": 1, "top_radius": 0, "half_height": 0.75})",
                          R"({"type": "round_box", "half_size": [0.75, 0.5, 1], "radius": 0.25})",
                          R"({"type": "capsule", "radius": 0.5, "half_height": 0.5})",
                          R"({"type": "ellipsoid", "radii": [1, 0.5, 0.75]})",
                          R"({"type": "icosahedron", "radius": 1})",
                          R"({"type": "sphere", "radius": 0.5, "scale": [2, 1, 1.5]})"};
  constexpr int kBatch = 10000;
  std::uint64_t again = 0;
  Random random(7);
  for (const char* body : bodies) {
    const auto scene = scene_of(std::string("\"objects\": [") + body + "]");
    for (std::size_t left = 0; left * std::size(bodies) < count;) {
      const std::vector<Ray> rays =
          departures(places(scene, rays_at_box(random, glm::dvec3(0.5), 5, kBatch)), random);
      REQUIRE(rays.size() > kBatch / 4);
      left += rays.size();
      again += march(make_field(scene), rays).counters.hits;
    }
  }
  return again;
}

const std::string kTwoBalls = R"("of": [{"type": "sphere", "radius": 1, "translate": [-0.5, 0, 0]},
                                        {"type": "sphere", "radius": 1, "translate": [0.5, 0, 0]}]})";

}  // namespace

// Rays that start inside a body, as after refraction. The number of evaluations is compared with that of rays that
// meet the same body from outside, without the bound that would bring them near the body.
TEST_CASE("I9: a ray inside a body finds the way out", "[catalogue]") {
  struct Body {
    const char* name;
    std::string scene;
    glm::dvec3 half;  // half size of a box that contains the body
    Truth truth;
  };
  const std::string both = R"("objects": [{"type": "union", )" + kTwoBalls + "]";
  const Body bodies[] = {{"sphere", kSphere, {1, 1, 1}, sphere_distance},
                         {"box", kBox, {0.75, 0.5, 1}, box_distance},
                         {"torus", kTorus, {1.25, 0.25, 1.25}, [](const Ray& ray) { return torus_distance(ray); }},
                         {"union", both, {1.5, 1, 1}, union_exit}};
  for (const Body& body : bodies) {
    const auto scene = scene_of(body.scene);
    const Field field = make_field(scene);
    vm::Workspace workspace;
    Random random(3);
    std::vector<Ray> within, outside;
    while (within.size() < 10000) {
      const Ray ray = rays_at_box(random, body.half, 0, 1)[0];
      if (vm::evaluate_distance(scene.distance, ray.origin, workspace) > -1e-3) continue;
      within.push_back(ray);
      outside.push_back({to_float(ray.origin - 6.0 * ray.direction), ray.direction});
    }
    Field unbounded = field;
    unbounded.bound = field.bound.grown(10);
    unbounded.convex = false;  // convexity leads rays to a solid, not out of it
    const MarchResult exits = march(field, within), entries = march(unbounded, outside);
    const Judgement found = judge(exits, within, body.truth);
    INFO(body.name);
    expect_right(found);
    CHECK(found.hits == found.rays);
    CHECK(found.p99() <= 5e-6);
    CHECK(found.worst() <= 1e-4);
    CHECK(exits.ray_hits[0].side == -1);
    CHECK(exits.counters.evaluations <= 2 * entries.counters.evaluations);
  }
}

TEST_CASE("I10: rays that leave a convex body never meet it again", "[catalogue][released]") {
  CHECK(met_again(100000) == 0);
  // Naive sphere tracing from exactly the hit's position finds a small distance at once.
  const auto scene = scene_of(kSphere);
  const Places found = places(scene, rays_at_sphere(1000, 5));
  Random random(1);
  std::vector<Ray> rays = departures(found, random);
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].origin = found.hits[i].position;
  const Truth miss = [](const Ray&) { return Real(-1); };
  const Judgement naive = judge_naive(scene, rays, miss, {.eps = 1e-6});
  CHECK(share(naive.false_hits, naive) > 0.9);
}

TEST_CASE("I10: ten million rays that leave convex bodies never meet them again", "[nightly][.]") {
  CHECK(met_again(10000000) == 0);
}

TEST_CASE("I11: what straddles the end of the ray", "[catalogue]") {
  const auto ends = [](const char* scene_text, const Ray& ray, double t_max) {
    const auto scene = scene_of(scene_text);
    Ray limited = ray;
    limited.t_max = t_max;
    return march(make_field(scene), std::span(&limited, 1)).ray_hits[0].status == RayHit::Status::Hit;
  };
  // Distances and positions that float holds exactly: the neighbouring float decides.
  const Ray straight{{0, 0, 5}, {0, 0, -1}}, down{{0.25, 4, 0}, {0, -1, 0}};
  for (const auto& [text, ray] : {std::pair{kSphere, straight}, {kBox, straight}, {kPlane, down}}) {
    INFO(text);
    CHECK_FALSE(ends(text, ray, static_cast<double>(std::nextafter(4.0f, 0.0f))));
    CHECK(ends(text, ray, static_cast<double>(std::nextafter(4.0f, 5.0f))));
    for (const double t_max : {3.0, 3.9, 3.999}) CHECK_FALSE(ends(text, ray, t_max));
    for (const double t_max : {4.001, 4.5, 6.5}) CHECK(ends(text, ray, t_max));
  }
  // For other distances the hit's own bracket decides.
  const auto scene = scene_of(kTorus);
  Random random(8);
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    Ray ray = aimed(random, random.uniform(0, 1.2), 5);
    const Real truth = torus_distance(ray);
    if (truth < 0) continue;
    ray.t_max = static_cast<double>(truth) + (i % 2 ? 2e-5 : -2e-5);
    rays.push_back(ray);
  }
  REQUIRE(rays.size() > 500);
  const Truth before_the_end = [](const Ray& ray) {
    const Real truth = torus_distance(ray);
    return truth <= ray.t_max ? truth : -1;
  };
  expect_right(judge(march(make_field(scene), rays), rays, before_the_end));
}

TEST_CASE("I12: rays without a direction or a place are invalid, and harm no neighbour", "[catalogue]") {
  const auto scene = scene_of(kSphere);
  const Field field = make_field(scene);
  const double nan = std::nan(""), inf = INFINITY;
  std::vector<Ray> rays(11, Ray{{0.25, 0, 5}, {0, 0, -1}});
  rays[1].direction = {0, 0, 0};
  rays[2].direction = {nan, 0, -1};
  rays[3].direction = {0, 0, -inf};
  rays[4].direction = {0, 0, -1e-320};
  rays[5].origin = {nan, 0, 5};
  rays[6].origin = {0, 0, inf};
  rays[7].t_max = nan;
  rays[9].direction = {0, 0, -7};
  const MarchResult result = march(field, rays);
  const double alone = march(field, std::span(rays).first(1)).ray_hits[0].t;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    INFO(i);
    if (i >= 1 && i <= 7) {
      CHECK(result.ray_hits[i].status == RayHit::Status::Invalid);
    } else {
      REQUIRE(result.ray_hits[i].status == RayHit::Status::Hit);
      CHECK(result.ray_hits[i].t == alone);
    }
  }
  CHECK(result.counters.invalid == 7);
  // A NaN fails every comparison: naive tracing reports neither a hit nor a miss and runs out of steps.
  vm::Workspace workspace;
  CHECK(trace_naively(scene.distance, rays[5], {}, workspace).status != NaiveHit::Status::Hit);
}

TEST_CASE("I13: coplanar cuts leave no skin", "[catalogue]") {
  const auto cut_by = [](const std::string& half) {
    return scene_of(R"("objects": [{"type": "subtraction", "rotate": {"axis": [1, 2, 3], "angle": 30}, "of": [
        {"type": "box", "half_size": [1, 1, 1]}, {"type": "box", "half_size": )" +
                    half + "}]}]");
  };
  Random random(13);
  const std::vector<Ray> rays = rays_at_box(random, {0.7, 0.7, 0.7}, 5, test::scaled_cases(20000));
  const Truth nothing = [](const Ray&) { return Real(-1); };
  for (const char* half : {"[1, 1, 1]", "[1, 1.125, 1.125]", "[1, 1, 1.125]"}) {
    const auto scene = cut_by(half);
    INFO(half);
    expect_right(judge(march(make_field(scene), rays), rays, nothing));
    const Judgement naive = judge_naive(scene, rays, nothing, {.eps = 1e-3});
    CHECK(share(naive.false_hits, naive) > 0.2);
  }
  // A hole right through the box, whose ends lie in the faces.
  const auto scene = scene_of(R"("objects": [{"type": "subtraction", "of": [
      {"type": "box", "half_size": [1, 1, 1]}, {"type": "box", "half_size": [0.5, 1, 0.5]}]}])");
  const Truth walls = [](const Ray& ray) {
    return entry_beside(box_span(ray, {0, 0, 0}, {1, 1, 1}), box_span(ray, {0, 0, 0}, {0.5, 1, 0.5}));
  };
  const std::vector<Ray> through = rays_at_box(random, {0.5, 1, 0.5}, 5, test::scaled_cases(20000));
  const Judgement found = judge(march(make_field(scene), through), through, walls);
  expect_right(found);
  CHECK(found.p99() <= 5e-6);
}

TEST_CASE("I13: where two boxes share a face, the first in the file shows", "[catalogue]") {
  const std::string materials = R"("materials": {"a": {"type": "diffuse"}, "b": {"type": "diffuse"}}, "objects": [)";
  const std::string wide = R"({"type": "box", "half_size": [1, 1, 1], "material": "a"})",
                    flat = R"({"type": "box", "half_size": [1, 0.5, 1], "material": "b"})",
                    same = R"({"type": "box", "half_size": [1, 1, 1], "material": "b"})";
  const auto rays_down_x = [] {
    Random random(14);
    std::vector<Ray> rays;
    for (int i = 0; i < 5000; ++i) {
      const glm::dvec3 at(1, random.uniform(-0.49, 0.49), random.uniform(-0.99, 0.99));
      const glm::dvec3 d = glm::normalize(glm::dvec3(-1, random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)));
      rays.push_back({to_float(at - 3.0 * d), to_float(d)});
    }
    return rays;
  };
  for (const auto& [first, second] : {std::pair{wide, flat}, {flat, wide}, {wide, same}, {same, wide}}) {
    const auto scene = scene_of(materials + first + "," + second + "]");
    const Places found = places(scene, rays_down_x());
    INFO(first << second);
    REQUIRE(found.points.size() == 5000);
    int others = 0;
    for (const SurfacePoint& point : found.points) {
      others += first.find("\"" + scene.materials[point.material].name + "\"") == std::string::npos;
    }
    CHECK(others == 0);
  }
}

// Rays past the edge of the lens, within 1e-6 to 1e-2 of the edge on either side.
TEST_CASE("I14: the edge of a lens", "[catalogue]") {
  const auto scene = scene_of(R"("objects": [{"type": "intersection", )" + kTwoBalls + "]");
  Random random(15);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const double aside = std::pow(10.0, random.uniform(-6, -2)) * (i % 2 ? 1 : -1);
    const double radius = std::sqrt(0.75) + aside, turn = random.uniform(0, 2 * M_PI);
    const glm::dvec3 d = random.direction(), through(0, radius * std::cos(turn), radius * std::sin(turn));
    rays.push_back({to_float(through - 4.0 * d), to_float(d)});
  }
  const Truth lens = [](const Ray& ray) {
    return entry(intersection(sphere_span(ray, kLeft, 1), sphere_span(ray, kRight, 1)));
  };
  const Judgement found = judge(march(make_field(scene), rays), rays, lens);
  expect_right(found);
  REQUIRE(found.errors.size() > 5000);
  CHECK(found.p99() <= 2e-4);
  const Judgement naive = judge_naive(scene, rays, lens, {.eps = 1e-3});
  CHECK(share(naive.false_hits, naive) > 0.1);
}

namespace {

// Width of the range of radii at which vertical rays hit. The rays point down at radii spread evenly from 1 - window
// to 1 + window.
template <class Hit>
double measured_width(double window, const Hit& hit) {
  Random random(16);
  int hits = 0;
  constexpr int kRays = 40000;
  for (int i = 0; i < kRays; ++i) {
    const double radius = 1 + window * (2 * (i + random.uniform(0, 1)) / kRays - 1),
                 turn = random.uniform(0, 2 * M_PI);
    hits += hit(Ray{to_float({radius * std::cos(turn), 2, radius * std::sin(turn)}), {0, -1, 0}});
  }
  return 2 * window * hits / kRays;
}

}  // namespace

TEST_CASE("I15: a wire of a ten thousandth, left by a difference", "[catalogue][heavy]") {
  const char* wires[] = {
      R"({"type": "torus", "major_radius": 1, "minor_radius": 0.00005})",
      R"({"type": "subtraction", "of": [{"type": "cylinder", "radius": 1.00005, "half_height": 0.00005},
                                        {"type": "cylinder", "radius": 0.99995, "half_height": 1}]})"};
  for (const char* wire : wires) {
    const auto scene = scene_of(std::string("\"objects\": [") + wire + "]");
    const Field field = make_field(scene);
    vm::Workspace workspace;
    INFO(wire);
    const double width = measured_width(2e-4, [&](const Ray& ray) {
      return march(field, std::span(&ray, 1)).ray_hits[0].status == RayHit::Status::Hit;
    });
    CHECK(std::abs(width - 1e-4) <= 2e-6);
    const double fat = measured_width(2e-3, [&](const Ray& ray) {
      return trace_naively(scene.distance, ray, {.eps = 1e-3}, workspace).status == NaiveHit::Status::Hit;
    });
    CHECK(fat > 1e-3);
  }
}

}  // namespace fathom::catalogue::bodies_test
