// B10, B12, B13: normals at hits, and rays that leave hits.
#include <cmath>
#include <numeric>

#include "bench/bars/bars.h"
#include "bench/closed_forms.h"
#include "bench/measured_hits.h"
#include "runtime/path/surface.h"

namespace fathom::bench {
namespace {

using glm::dvec3;
using Vec = glm::vec<3, Real>;

// Returns the angle between two vectors of any length, in radians. Accurate for small angles.
Real angle(const Vec& a, const Vec& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

// A primitive that is smooth where |y| < `smooth`, with the exact direction of its gradient there.
struct Smooth {
  const char* name;
  const char* node;  // JSON, a format string for the translation
  double smooth;
  Vec (*gradient)(const Vec& p);
};

constexpr Real kBottom = 0.8L, kTop = 0.3L, kHalf = 0.7L;  // cone: bottom radius, top radius, half height

constexpr Smooth kSmooth[] = {
    {"sphere", R"({{"type": "sphere", "radius": 1, "translate": [{}, {}, {}]}})", 2, [](const Vec& p) { return p; }},
    {"torus", R"({{"type": "torus", "major_radius": 0.75, "minor_radius": 0.25, "translate": [{}, {}, {}]}})", 2,
     [](const Vec& p) {
       const Real share = 1 - 0.75L / std::hypot(p.x, p.z);
       return Vec(p.x * share, p.y, p.z * share);
     }},
    {"capsule", R"({{"type": "capsule", "radius": 0.5, "half_height": 0.5, "translate": [{}, {}, {}]}})", 2,
     [](const Vec& p) { return Vec(p.x, p.y - std::clamp(p.y, -0.5L, 0.5L), p.z); }},
    {"cylinder's side", R"({{"type": "cylinder", "radius": 0.75, "half_height": 1, "translate": [{}, {}, {}]}})", 0.7,
     [](const Vec& p) { return Vec(p.x, 0, p.z); }},
    {"cone's side",
     R"({{"type": "cone", "bottom_radius": 0.8, "top_radius": 0.3, "half_height": 0.7, "translate": [{}, {}, {}]}})",
     0.4,
     [](const Vec& p) {
       const Real rho = std::hypot(p.x, p.z);
       return Vec(p.x * 2 * kHalf / rho, kBottom - kTop, p.z * 2 * kHalf / rho);
     }},
};

// A second solid at zero, so that the compiler does not move the origin to the primitive.
constexpr const char* kAtZero = R"({"type": "sphere", "radius": 0.25}, )";

struct SurfaceHits {
  std::vector<runtime::Ray> rays;
  std::vector<runtime::Hit> hits;
};

// Hits of rays that pass within 1 of `centre`. Rays and `centre` are in the program's coordinates.
SurfaceHits hits_about(const runtime::Field& field, Engine& random, dvec3 centre, std::size_t count) {
  std::vector<runtime::Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    runtime::Ray ray = ray_past(random, std::sqrt(uniform(random, 0, 1)), 4);
    ray.origin = to_float(ray.origin + centre);
    rays.push_back(ray);
  }
  const runtime::MarchResult result = runtime::march(field, rays);
  SurfaceHits found;
  for (std::size_t i = 0; i < count; ++i) {
    const runtime::RayHit& ray_hit = result.ray_hits[i];
    if (ray_hit.status != runtime::RayHit::Status::Hit) continue;
    found.rays.push_back(rays[i]);
    found.hits.push_back(
        {rays[i].origin + ray_hit.t * rays[i].direction, glm::vec3(-rays[i].direction), ray_hit.side, ray_hit.width});
  }
  return found;
}

std::vector<runtime::SurfacePoint> surfaces_of(const compiler::CompiledScene& scene, const runtime::Field& field,
                                               std::span<const runtime::Hit> hits) {
  std::vector<runtime::SurfacePoint> points(hits.size());
  vm::Workspace workspace;
  for (std::size_t first = 0; first < hits.size(); first += runtime::kSurfaceBatch) {
    const std::size_t n = std::min(runtime::kSurfaceBatch, hits.size() - first);
    runtime::find_surfaces(scene, field, hits.subspan(first, n), std::span(points).subspan(first, n), workspace);
  }
  return points;
}

// Returns the largest angle between normals and exact gradients, both at the same position rounded to float.
double largest_angle(const Smooth& shape, double offset, bool alone, std::size_t count, std::size_t& compared) {
  const dvec3 at(offset, offset / 2, -offset);
  const std::string node = fmt::format(fmt::runtime(shape.node), at.x, at.y, at.z);
  const compiler::CompiledScene scene = compile_objects(alone ? node : kAtZero + node);
  const runtime::Field field = runtime::make_field(scene);
  Engine random(13);
  std::vector<runtime::Hit> hits;
  std::vector<Vec> exact;
  for (runtime::Hit& hit : hits_about(field, random, at - scene.origin, count).hits) {
    hit.position = to_float(hit.position);
    const Vec p = Vec(hit.position) + Vec(scene.origin) - Vec(at);
    if (std::abs(p.y) > static_cast<Real>(shape.smooth)) continue;
    exact.push_back(shape.gradient(p));
    // Parallel to the normal, so that no normal is turned towards the viewer.
    hit.wo = glm::vec3(glm::normalize(exact.back()));
    hits.push_back(hit);
  }
  const std::vector<runtime::SurfacePoint> points = surfaces_of(scene, field, hits);
  Real most = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) most = std::max(most, angle(Vec(points[i].normal), exact[i]));
  compared += hits.size();
  return static_cast<double>(most);
}

void smooth_normals(BarTable& table, std::size_t count) {
  constexpr double kOffsets[] = {0, 1, 10, 100, 1000};
  for (const bool alone : {true, false}) {
    for (const Smooth& shape : kSmooth) {
      double most = 0;
      std::size_t compared = 0;
      for (const double offset : kOffsets) {
        if (!alone && offset < 10) continue;  // the two solids would overlap
        most = std::max(most, largest_angle(shape, offset, alone, count / 25, compared));
      }
      table.at_most("B10",
                    fmt::format("{}: normals 0 to 1000 from zero{}, {} hits: largest error", shape.name,
                                alone ? "" : ", and a ball there", compared),
                    1e-6, most, " rad");
    }
  }
}

void normals_at_hits(BarTable& table, std::size_t count) {
  const compiler::CompiledScene scene = compile_objects(R"({"type": "sphere", "radius": 1})");
  const runtime::Field field = runtime::make_field(scene);
  Engine random(17);
  const SurfaceHits found = hits_about(field, random, dvec3(0), count);
  const std::vector<runtime::SurfacePoint> points = surfaces_of(scene, field, found.hits);
  std::vector<double> errors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto t = meet_sphere(found.rays[i]);
    if (!t) continue;
    const Vec place = Vec(found.rays[i].origin) + *t * Vec(found.rays[i].direction);
    errors.push_back(static_cast<double>(angle(Vec(points[i].normal), place)));
  }
  std::sort(errors.begin(), errors.end());
  table.at_most("B12",
                fmt::format("sphere of radius 1: normal at the hit against the true hit's, p99 of {}", errors.size()),
                1e-5, permille(errors, 990), " rad");
}

constexpr const char* kConvex[][2] = {
    {"sphere", R"({"type": "sphere", "radius": 1})"},
    {"box", R"({"type": "box", "half_size": [0.75, 0.5, 0.8]})"},
    {"cylinder", R"({"type": "cylinder", "radius": 0.7, "half_height": 0.6})"},
    {"cone", R"({"type": "cone", "bottom_radius": 0.8, "top_radius": 0.3, "half_height": 0.7})"},
    {"capsule", R"({"type": "capsule", "radius": 0.5, "half_height": 0.5})"},
    {"ellipsoid", R"({"type": "ellipsoid", "radii": [0.9, 0.5, 0.7]})"},
    {"icosahedron", R"({"type": "icosahedron", "radius": 1})"},
};

// Returns how many rays hit the same body again after leaving a hit, out of rays over the hemisphere that start as
// the renderer's do.
std::size_t self_hits(const char* node, std::size_t count, std::size_t& tried) {
  const compiler::CompiledScene scene = compile_objects(node);
  const runtime::Field field = runtime::make_field(scene);
  Engine random(19);
  std::size_t again = 0;
  while (count > 0) {
    const SurfaceHits found = hits_about(field, random, dvec3(0), std::min<std::size_t>(count, 100000));
    const std::vector<runtime::SurfacePoint> points = surfaces_of(scene, field, found.hits);
    std::vector<runtime::Ray> rays;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const dvec3 direction = random_hemisphere(random, dvec3(points[i].normal));
      runtime::Ray ray{runtime::spawn_origin(found.hits[i], points[i], false), direction};
      ray.side = found.hits[i].side;
      ray.slope = static_cast<float>(glm::dot(dvec3(points[i].normal), direction));
      rays.push_back(ray);
    }
    again += runtime::march(field, rays).counters.hits;
    tried += rays.size();
    count -= std::min(count, rays.size());
  }
  return again;
}

void leaving_rays(BarTable& table, std::size_t count) {
  for (const auto& [name, node] : kConvex) {
    std::size_t tried = 0;
    const std::size_t again = self_hits(node, count / std::size(kConvex), tried);
    table.none("B13", fmt::format("{}: rays leaving it that meet it again", name), again, tried);
  }
}

}  // namespace

void normal_bars(BarTable& table, const Counts& counts) {
  smooth_normals(table, counts.normals);
  normals_at_hits(table, counts.sphere_rays);
  leaving_rays(table, counts.secondary_rays);
}

}  // namespace fathom::bench
