// B4: hits of unit-scale solids. B5: rays that graze a sphere, and rays that barely miss the sphere.
#include <cstdlib>

#include "bench/bars/bars.h"
#include "bench/closed_forms.h"
#include "bench/measured_hits.h"

namespace fathom::bench {
namespace {

constexpr double kFar = 10;  // scene units; a flat ray's hit of the plane beyond this is no longer unit scale
constexpr double kAway = 5;  // distance from the rays' origins to the scene's origin
constexpr const char* kUnitSphere = R"({"type": "sphere", "radius": 1})";

Judgement judge_rays(const compiler::CompiledScene& scene, const std::vector<runtime::Ray>& rays, Truth truth) {
  const runtime::Field field = runtime::make_field(scene, kFar);
  return judge(runtime::march(field, rays), [&](std::size_t i) {
    const std::optional<Real> t = truth(rays[i]);
    return t && *t <= static_cast<Real>(kFar) ? *t : Real(-1);
  });
}

struct Solid {
  const char* name;
  const char* node;
  Truth truth;
  double reach;       // rays are spread over a disc of this radius, perpendicular to the ray
  std::size_t share;  // one in `share` rays is traced; the torus' truth is expensive
};

constexpr Solid kSolids[] = {
    {"sphere", kUnitSphere, meet_sphere, 1.05, 1},
    {"plane", R"({"type": "plane", "normal": [0, 1, 0]})", meet_plane, 4.9, 1},
    {"box", R"({"type": "box", "half_size": [0.75, 0.5, 1]})", meet_box, 1.2, 1},
    {"torus", R"({"type": "torus", "major_radius": 0.75, "minor_radius": 0.25})", meet_torus, 1.05, 10},
};

void distances(BarTable& table, const Solid& solid, std::size_t count) {
  Engine random(7);
  std::vector<runtime::Ray> rays;
  for (std::size_t i = 0; i < count / solid.share; ++i) {
    runtime::Ray ray = ray_past(random, solid.reach * std::sqrt(uniform(random, 0, 1)), kAway);
    if (solid.truth == meet_plane && ray.origin.y < 0) ray.origin.y *= -1, ray.direction.y *= -1;
    rays.push_back(ray);
  }
  const Judgement judged = judge_rays(compile_objects(solid.node), rays, solid.truth);
  const double p50 = permille(judged.errors, 500), p99 = permille(judged.errors, 990),
               most = permille(judged.errors, 1000);
  table.row("B4", fmt::format("{}: |t - true t| of {} hits, p50, p99, largest", solid.name, judged.errors.size()),
            "1e-6, 5e-6, 1e-4", fmt::format("{:.1e}, {:.1e}, {:.1e}", p50, p99, most),
            p50 <= 1e-6 && p99 <= 5e-6 && most <= 1e-4);
  table.none("B4", fmt::format("{}: false hits and misses", solid.name), judged.wrong(), judged.rays);
}

// Rays past a unit sphere, at distance 1 + side * gap from its centre. The gaps are log-uniform from 1e-6 to 1e-2.
std::vector<runtime::Ray> rays_beside(double side, std::size_t count) {
  Engine random(11);
  std::vector<runtime::Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const double gap = std::pow(10, uniform(random, -6, -2));
    rays.push_back(ray_past(random, 1 + side * gap, kAway));
  }
  return rays;
}

// Returns the distance from the unit sphere to the ray's line.
Real gap(const runtime::Ray& ray) {
  Real a = 0, b = 0, c = 0;
  for (int i = 0; i < 3; ++i) {
    const Real o = ray.origin[i], d = ray.direction[i];
    a += d * d, b += o * d, c += o * o;
  }
  return std::sqrt(c - b * b / a) - 1;
}

void grazing(BarTable& table, std::size_t count) {
  const compiler::CompiledScene scene = compile_objects(kUnitSphere);
  const Judgement hits = judge_rays(scene, rays_beside(-1, count), meet_sphere);
  table.none("B5", "grazing hits 1e-6 to 1e-2 deep (I2): false hits and misses", hits.wrong(), hits.rays);
  table.at_most("B5", "grazing hits: p99 of |t - true t|", 2e-4, permille(hits.errors, 990));
  table.at_most("B5", "grazing hits: evaluations a ray", 100, hits.evaluations());

  constexpr Real kClose = 4e-7L;  // float cannot resolve a smaller gap
  const std::vector<runtime::Ray> rays = rays_beside(1, count);
  const runtime::MarchResult misses = runtime::march(runtime::make_field(scene, kFar), rays);
  std::size_t false_hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    false_hits += misses.ray_hits[i].status == runtime::RayHit::Status::Hit && gap(rays[i]) > kClose;
  }
  table.none("B5", "near misses by 1e-6 to 1e-2 (I3): false hits where the gap is above 4e-7", false_hits,
             rays.size());
}

}  // namespace

compiler::CompiledScene compile_objects(std::string_view objects) {
  compiler::Diagnostics diagnostics;
  const compiler::Source source("bars", fmt::format(R"({{"version": 1, "objects": [{}]}})", objects));
  auto scene = compiler::compile(source, diagnostics);
  if (!scene) {
    fmt::print(stderr, "{}", diagnostics.print(source, compiler::ErrorFormat::Text));
    std::exit(2);
  }
  return *std::move(scene);
}

void hit_bars(BarTable& table, const Counts& counts) {
  for (const Solid& solid : kSolids) distances(table, solid, counts.sphere_rays);
  grazing(table, counts.sphere_rays);
}

}  // namespace fathom::bench
