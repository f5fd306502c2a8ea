// The adversarial catalogue, rows N1 to N5: normals compared with exact gradients in long double. Differences and a
// cone's usual formula are measured for comparison. Random shapes and graphs: tests/compiler/shapes/normals_test.cpp.
// docs/explanation/accuracy.md lists all rows.
#include <cmath>
#include <string>
#include <vector>

#include "tests/catalogue/departures.h"
#include "tests/catalogue/naive.h"
#include "tests/catalogue/solids.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::catalogue::normals_test {
namespace {

using test::compiled_objects;

// Point and normal on a solid's surface, in the solid's coordinates.
struct Place {
  Vec3 position, normal;
};

struct Solid {
  const char* name;
  std::string node;  // JSON without the closing brace
  std::function<Place(Random&)> place;
};

constexpr long double kTau = 6.283185307179586476925286766559L;

Place on_sphere(Random& random) {
  const Vec3 n = glm::normalize(Vec3(random.direction()));
  return {n, n};
}

Place on_torus(Random& random) {
  const long double turn = kTau * random.uniform(0, 1), around = kTau * random.uniform(0, 1);
  const Vec3 out(std::cos(turn), 0, std::sin(turn));
  const Vec3 n = std::cos(around) * out + std::sin(around) * Vec3(0, 1, 0);
  return {out + 0.25L * n, n};
}

// Point on the side of the cone with radius 1 at y = -0.75 and `top` at 0.75, away from the rims.
Place on_cone(Random& random, long double top) {
  const long double turn = kTau * random.uniform(0, 1), share = random.uniform(0.01, 0.99);
  const Vec3 out(std::cos(turn), 0, std::sin(turn));
  const Vec3 n = glm::normalize(1.5L * out + (1 - top) * Vec3(0, 1, 0));
  return {(1 + (top - 1) * share) * out + Vec3(0, 1.5L * share - 0.75L, 0), n};
}

const std::vector<Solid>& solids() {
  static const std::vector<Solid> all = {
      {"sphere", R"({"type": "sphere", "radius": 1)", on_sphere},
      {"torus", R"({"type": "torus", "major_radius": 1, "minor_radius": 0.25)", on_torus},
      {"cone", R"({"type": "cone", "bottom_radius": 1, "top_radius": 0, "half_height": 0.75)",
       [](Random& random) { return on_cone(random, 0); }},
      {"frustum", R"({"type": "cone", "bottom_radius": 1, "top_radius": 0.5, "half_height": 0.75)",
       [](Random& random) { return on_cone(random, 0.5); }}};
  return all;
}

glm::dvec3 float_gradient(const vm::VerifiedProgram& program, glm::dvec3 p, vm::Workspace& workspace) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float d, gx, gy, gz;
  std::uint32_t surface;
  vm::evaluate_surface(program, {&x, &y, &z}, 1, {&d, &gx, &gy, &gz, &surface}, workspace);
  return {gx, gy, gz};
}

// Central differences in float, as in renderers without derivatives.
glm::dvec3 central_difference(const vm::VerifiedProgram& program, glm::dvec3 p, float h, vm::Workspace& workspace) {
  glm::dvec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](float step) {
      glm::vec3 q(p);
      q[axis] += step;
      float d;
      vm::evaluate_distance(program, {&q.x, &q.y, &q.z}, 1, &d, workspace);
      return d;
    };
    slope[axis] = static_cast<double>(at(h) - at(-h));
  }
  return slope;
}

// Sine of the angle between a vector and a unit vector; 2 for opposite, zero and NaN vectors.
double angle(glm::dvec3 a, const Vec3& unit) {
  const Vec3 n(a);
  const long double length = glm::length(n);
  if (!(length > 0) || glm::dot(n, unit) <= 0) return 2;
  return static_cast<double>(glm::length(glm::cross(n / length, unit)));
}

// Exact normal at the surface point nearest to `moved`, which is `place` after rounding to float far from the origin.
Vec3 normal_at(const Solid& solid, const Place& place, const Vec3& moved) {
  if (solid.name == std::string("sphere")) return glm::normalize(moved);
  if (solid.name == std::string("torus")) {
    const Vec3 out = glm::normalize(Vec3(moved.x, 0, moved.z));
    return glm::normalize(moved - out);
  }
  const Vec3 out = glm::normalize(Vec3(moved.x, 0, moved.z)),
             flat = glm::normalize(Vec3(place.normal.x, 0, place.normal.z));
  return glm::dot(place.normal, flat) * out + place.normal.y * Vec3(0, 1, 0);
}

// Max angle error of the machine's float gradients at `count` points, and the 99th percentile for differences with
// step h.
struct Angles {
  double worst = 0;
  std::vector<double> of_differences;  // sorted
  double p99() const { return of_differences[of_differences.size() * 99 / 100]; }
};

Angles angles(const Solid& solid, double offset, int count, float h) {
  // Two copies on opposite sides of zero, so that the compiler has no better origin for the scene.
  const auto moved_by = [](double x, double z) {
    return R"(, "translate": [)" + std::to_string(x) + ", 0, " + std::to_string(z) + "]}";
  };
  std::string nodes = solid.node + moved_by(offset, -offset);
  if (offset != 0) nodes += ", " + solid.node + moved_by(-offset, offset);
  const auto scene = compiled_objects(nodes);
  vm::Workspace workspace;
  Random random(1);
  Angles found;
  for (int i = 0; i < count; ++i) {
    const Place place = solid.place(random);
    const glm::dvec3 p = to_float(glm::dvec3(place.position) + glm::dvec3(offset, 0, -offset));
    const Vec3 truth = normal_at(solid, place, Vec3(p) - Vec3(offset, 0, -offset));
    found.worst = std::max(found.worst, angle(float_gradient(scene.surface, p, workspace), truth));
    found.of_differences.push_back(angle(central_difference(scene.distance, p, h, workspace), truth));
  }
  std::sort(found.of_differences.begin(), found.of_differences.end());
  return found;
}

}  // namespace

TEST_CASE("N1: normals of curved surfaces", "[catalogue]") {
  for (const Solid& solid : solids()) {
    INFO(solid.name);
    CHECK(angles(solid, 0, 20000, 1e-3f).worst <= 1e-6);
    CHECK(angles(solid, 0, 20000, 1e-3f).p99() > 1e-5);
    CHECK(angles(solid, 0, 20000, 1e-5f).p99() > 1e-3);
  }
}

TEST_CASE("N2: normals of curved surfaces far from the origin", "[catalogue]") {
  for (const Solid& solid : solids()) {
    for (const double offset : {100.0, 1000.0}) {
      INFO(solid.name << " at " << offset);
      CHECK(angles(solid, offset, 20000, 1e-4f).worst <= 1e-6);
    }
    CHECK(angles(solid, 100, 20000, 1e-4f).p99() > 1e-3);
  }
}

namespace {

// Gradient of a capped cone's usual formula (sign of the side times the square root of the smaller of two squared
// distances), as automatic differentiation in float gives it: half the gradient of the square, divided by the root.
glm::vec3 usual_cone_gradient(glm::vec3 p, float r1, float r2, float h) {
  const float rho = std::sqrt(p.x * p.x + p.z * p.z);
  const glm::vec2 q(rho, p.y), k1(r2, h), k2(r2 - r1, 2 * h);
  const glm::vec2 ca(q.x - std::min(q.x, q.y < 0 ? r1 : r2), std::abs(q.y) - h);
  const float share = std::clamp(glm::dot(k1 - q, k2) / glm::dot(k2, k2), 0.0f, 1.0f);
  const glm::vec2 cb = q - k1 + k2 * share;
  const float sign = cb.x < 0 && ca.y < 0 ? -1.0f : 1.0f;
  const bool cap = glm::dot(ca, ca) < glm::dot(cb, cb);
  const float root = std::sqrt(std::min(glm::dot(ca, ca), glm::dot(cb, cb)));
  glm::vec2 slope;
  if (cap) {
    slope = glm::vec2(q.x > (q.y < 0 ? r1 : r2) ? ca.x : 0, q.y < 0 ? -ca.y : ca.y);
  } else {
    const bool within = share > 0 && share < 1;
    slope = within ? cb - k2 * (glm::dot(cb, k2) / glm::dot(k2, k2)) : cb;
  }
  slope *= sign / root;
  return {slope.x * p.x / rho, slope.y, slope.x * p.z / rho};
}

// Number of reversed, zero or NaN normals at `count` points within two floats of a cone's side.
struct Lost {
  int of_the_machine = 0, of_the_usual_formula = 0;
  double worst = 0;  // radians, of the machine's normals
};

Lost lost_normals(int count) {
  const Solid& frustum = solids()[3];
  const auto scene = compiled_objects(frustum.node + "}");
  vm::Workspace workspace;
  Random random(2);
  Lost lost;
  for (int i = 0; i < count; ++i) {
    const Place place = frustum.place(random);
    const glm::dvec3 p =
        to_float(glm::dvec3(place.position) + random.uniform(-1, 1) * 0x1p-23 * glm::dvec3(place.normal));
    const Vec3 truth = normal_at(frustum, place, Vec3(p));
    const double off = angle(float_gradient(scene.surface, p, workspace), truth);
    lost.of_the_machine += off > 1;
    lost.worst = std::max(lost.worst, off);
    lost.of_the_usual_formula += angle(glm::dvec3(usual_cone_gradient(glm::vec3(p), 1, 0.5f, 0.75f)), truth) > 1;
  }
  return lost;
}

// Number of wrong normals at the hits of `count` rays per solid. The normals are those that the renderer computes
// from the gradient.
int lost_at_hits(int count) {
  int lost = 0;
  for (const Solid& solid : solids()) {
    const auto scene = compiled_objects(solid.node + "}");
    for (int begin = 0; begin < count; begin += 10000) {
      Random random(static_cast<unsigned>(3 + begin));
      std::vector<Ray> rays;
      for (int i = 0; i < 10000; ++i) rays.push_back(aimed(random, random.uniform(0, 1), 5));
      const Places met = places(scene, rays);
      for (std::size_t i = 0; i < met.points.size(); ++i) {
        const glm::vec3 n = met.points[i].normal;
        const bool unit = std::abs(glm::length(n) - 1) <= 1e-6f;
        lost += !unit || !(glm::dot(n, met.hits[i].wo) > 0);
      }
    }
  }
  return lost;
}

}  // namespace

TEST_CASE("N3: no normal of a cone is reversed, zero or no number", "[catalogue]") {
  const Lost lost = lost_normals(100000);
  CHECK(lost.of_the_machine == 0);
  CHECK(lost.worst <= 1e-6);
  CHECK(lost.of_the_usual_formula > 10);
  CHECK(lost_at_hits(20000) == 0);
}

TEST_CASE("N3: ten million normals, none reversed, zero or no number", "[nightly][.]") {
  CHECK(lost_normals(10000000).of_the_machine == 0);
  CHECK(lost_at_hits(2500000) == 0);
}

namespace {

// True if g is a convex combination of the unit vectors in `faces`, which lie along distinct axes.
bool in_normal_cone(glm::dvec3 g, const std::vector<glm::dvec3>& faces) {
  glm::dvec3 rest = g;
  double sum = 0;
  for (const glm::dvec3& face : faces) {
    const double share = glm::dot(g, face);
    if (share < -1e-9) return false;
    sum += share;
    rest -= share * face;
  }
  return glm::length(rest) < 1e-7 && sum > 0;
}

}  // namespace

TEST_CASE("N4: normals at edges and corners are unit vectors between those of the faces", "[catalogue]") {
  const auto box = compiled_objects(R"({"type": "box", "half_size": [0.75, 0.5, 1]})");
  const auto joined = compiled_objects(R"({"type": "union", "of": [{"type": "plane", "normal": [1, 0, 0]},
                                                                   {"type": "plane", "normal": [0, 1, 0]}]})");
  const auto met = compiled_objects(R"({"type": "intersection", "of": [{"type": "plane", "normal": [1, 0, 0]},
                                                                       {"type": "plane", "normal": [0, 1, 0]}]})");
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  struct Crease {
    const compiler::CompiledScene* scene;
    glm::dvec3 at;
    std::vector<glm::dvec3> faces;
  };
  const Crease creases[] = {{&box, {0.75, 0.5, 0.25}, {x, y}},       {&box, {-0.75, 0.25, 1}, {-x, z}},
                            {&box, {0, -0.5, -1}, {-y, -z}},         {&box, {0.75, 0.5, 1}, {x, y, z}},
                            {&box, {-0.75, -0.5, -1}, {-x, -y, -z}}, {&joined, {0, 0, 0.5}, {x, y}},
                            {&joined, {0.5, 0.5, 0}, {x, y}},        {&met, {0, 0, 0.5}, {x, y}},
                            {&met, {-0.5, -0.5, 0}, {x, y}}};
  vm::Workspace workspace;
  for (const Crease& crease : creases) {
    INFO(crease.at.x << ' ' << crease.at.y << ' ' << crease.at.z);
    const glm::dvec3 wide = vm::evaluate_surface(crease.scene->surface, crease.at, workspace).gradient;
    const glm::dvec3 narrow = float_gradient(crease.scene->surface, crease.at, workspace);
    CHECK(in_normal_cone(wide, crease.faces));
    CHECK(in_normal_cone(narrow, crease.faces));
    glm::dvec3 between(0);
    for (const glm::dvec3& face : crease.faces) between += face;
    const Hit hit{crease.at, glm::vec3(glm::normalize(between)), 1, 1e-7f};
    const Field field = make_field(*crease.scene);
    SurfacePoint points[3];
    const Hit hits[] = {hit, hit, hit};
    find_surfaces(*crease.scene, field, hits, points, workspace);
    CHECK(std::abs(glm::length(points[0].normal) - 1) <= 1e-6f);
    CHECK(in_normal_cone(glm::dvec3(points[0].normal), crease.faces));
    for (const SurfacePoint& point : points) CHECK(point.normal == points[0].normal);
  }
}

TEST_CASE("N5: the normal where the hit is said to be, against that where it is", "[catalogue]") {
  const auto scene = scene_of(kSphere);
  const std::vector<Ray> rays = rays_at_sphere(40000, 5);
  const Places met = places(scene, rays);
  REQUIRE(met.points.size() == rays.size());
  std::vector<double> ours, naive;
  vm::Workspace workspace;
  std::size_t place = 0;
  for (const Ray& ray : rays) {
    const Vec3 truth = glm::normalize(Vec3(ray.origin) + sphere_distance(ray) * Vec3(ray.direction));
    ours.push_back(angle(glm::dvec3(met.points[place++].normal), truth));
    const NaiveHit there = trace_naively(scene.distance, ray, {.eps = 1e-4}, workspace);
    if (there.status != NaiveHit::Status::Hit) continue;
    naive.push_back(angle(glm::normalize(ray.origin + there.t * ray.direction), truth));
  }
  std::sort(ours.begin(), ours.end());
  std::sort(naive.begin(), naive.end());
  CHECK(ours[ours.size() * 99 / 100] <= 1e-5);
  CHECK(naive[naive.size() * 99 / 100] > 1e-4);
}

}  // namespace fathom::catalogue::normals_test
