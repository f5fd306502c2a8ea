#include "runtime/measure/measure_rays.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "runtime/march/march.h"
#include "runtime/measure/stopwatch.h"
#include "runtime/path/surface.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

using Status = RayHit::Status;

// Share of the extent: an error larger than this is another surface's hit.
constexpr double kGross = 0.004;
// Methods in double take one point at a time. This many rays of a set are enough to time them.
constexpr std::size_t kTimedInDouble = 2000;

bool in_double(const Marching& marching) {
  return marching.precision == Precision::Double || marching.method == Method::Certified;
}

double share(const std::vector<double>& sorted, double quantile) {
  if (sorted.empty()) return std::nan("");
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(quantile * static_cast<double>(sorted.size())))];
}

// Returns normals at hits, as the renderer finds them (`exact`: in double). [ray]; zero for rays without a hit.
std::vector<glm::dvec3> normals_at(const compiler::CompiledScene& scene, const Field& field,
                                   std::span<const Ray> rays, std::span<const RayHit> ray_hits, bool exact) {
  std::vector<glm::dvec3> normals(rays.size(), glm::dvec3(0));
  vm::Workspace workspace;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (ray_hits[i].status != Status::Hit) continue;
    const glm::dvec3 direction = glm::normalize(rays[i].direction), at = rays[i].origin + ray_hits[i].t * direction;
    if (exact) {
      const glm::dvec3 gradient = vm::evaluate_surface(scene.surface, at, workspace).gradient;
      const double length = glm::length(gradient);
      if (length > 0) normals[i] = static_cast<double>(ray_hits[i].side) / length * gradient;
    } else {
      const Hit hit{at, glm::vec3(-direction), ray_hits[i].side, ray_hits[i].width, ray_hits[i].piece};
      SurfacePoint point{};
      find_surfaces(scene, field, std::span(&hit, 1), std::span(&point, 1), workspace);
      normals[i] = glm::dvec3(point.normal);
    }
  }
  return normals;
}

double angle(glm::dvec3 a, glm::dvec3 b) { return vm::real::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

class Comparison {
 public:
  Comparison(const compiler::CompiledScene& scene, const Field& field, const RaySet& set)
      : scene_(scene), field_(field), set_(set) {
    reference_ = march(field, set.rays, {.method = Method::Certified}).ray_hits;
    normals_ = normals_at(scene, field, set.rays, reference_, true);
  }

  RayMeasurement row(const Marching& marching) const {
    const std::vector<RayHit> ray_hits = march(field_, set_.rays, marching).ray_hits;
    RayMeasurement row = describe(marching);
    count_failures(ray_hits, marching, row);
    measure_errors(ray_hits, row);
    return row;
  }

 private:
  RayMeasurement describe(const Marching& marching) const {
    const MethodInfo& method = info(marching.method);
    RayMeasurement row;
    row.method = method.name;
    row.precision = in_double(marching) ? "f64" : "f32";
    row.eps = method.uses_epsilon ? marching.epsilon : 0;
    row.steps_max = method.uses_epsilon ? marching.steps : 0;
    row.relax = marching.method == Method::Relaxed ? marching.relaxation : marching.method == Method::Sphere ? 1 : 0;
    row.ray_class = set_.ray_class;
    row.rays = set_.rays.size();
    row.reference = marching.method == Method::Certified;
    return row;
  }

  // True if the reference is right about the ray.
  bool is_known(std::size_t i) const {
    return reference_[i].status == Status::Hit || reference_[i].status == Status::Miss;
  }
  double error(std::span<const RayHit> ray_hits, std::size_t i) const {
    return std::abs(ray_hits[i].t - reference_[i].t);
  }
  bool both_hit(std::span<const RayHit> ray_hits, std::size_t i) const {
    return ray_hits[i].status == Status::Hit && reference_[i].status == Status::Hit;
  }

  void count_failures(std::span<const RayHit> ray_hits, const Marching& marching, RayMeasurement& row) const {
    const double ppm = 1e6 / static_cast<double>(std::max<std::size_t>(1, ray_hits.size()));
    const bool limited = info(marching.method).uses_epsilon;
    for (std::size_t i = 0; i < ray_hits.size(); ++i) {
      const bool hit = ray_hits[i].status == Status::Hit, expected = reference_[i].status == Status::Hit;
      const bool given_up = limited && !hit && ray_hits[i].evaluations >= static_cast<std::uint32_t>(marching.steps);
      if (ray_hits[i].status == Status::NearMiss) row.near_miss_ppm += ppm;
      if (!is_known(i)) continue;
      if (given_up) {
        row.exhausted_ppm += ppm;
        continue;
      }
      if (hit && !expected) row.false_hit_ppm += ppm;
      if (!hit && expected) row.false_miss_ppm += ppm;
      if (hit && expected && error(ray_hits, i) > kGross * extent_of(field_)) row.gross_ppm += ppm;
    }
  }

  void measure_errors(std::span<const RayHit> ray_hits, RayMeasurement& row) const {
    const std::vector<glm::dvec3> normals = normals_at(scene_, field_, set_.rays, ray_hits, row.reference);
    std::vector<double> distances, angles, evaluations;
    for (std::size_t i = 0; i < ray_hits.size(); ++i) {
      evaluations.push_back(ray_hits[i].evaluations);
      row.evals_mean += ray_hits[i].evaluations / static_cast<double>(ray_hits.size());
      if (!both_hit(ray_hits, i)) continue;
      distances.push_back(error(ray_hits, i));
      if (normals_[i] != glm::dvec3(0)) angles.push_back(angle(normals[i], normals_[i]));
    }
    for (std::vector<double>* values : {&distances, &angles, &evaluations}) std::sort(values->begin(), values->end());
    row.evals_p99 = share(evaluations, 0.99);
    row.terr_p50 = share(distances, 0.5), row.terr_p99 = share(distances, 0.99), row.terr_max = share(distances, 1);
    row.nerr_p50 = share(angles, 0.5), row.nerr_p99 = share(angles, 0.99), row.nerr_max = share(angles, 1);
  }

  const compiler::CompiledScene& scene_;
  const Field& field_;
  const RaySet& set_;
  std::vector<RayHit> reference_;
  std::vector<glm::dvec3> normals_;  // at the reference's hits
};

void time_rows(const Field& field, const RaySet& set, std::span<const Marching> methods, int rounds,
               std::span<RayMeasurement> rows) {
  std::vector<std::function<void()>> variants;
  std::vector<double> counts;
  for (const Marching& marching : methods) {
    std::span<const Ray> rays = set.rays;
    if (in_double(marching)) rays = rays.first(std::min(rays.size(), kTimedInDouble));
    counts.push_back(static_cast<double>(std::max<std::size_t>(1, rays.size())));
    variants.push_back([&field, &marching, rays] { march_each(field, rays, marching, [](const RayHit&) {}); });
  }
  const std::vector<std::vector<double>> seconds = time_interleaved(variants, rounds);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Spread time = spread(seconds[i]);
    const double to_ns = 1e9 / counts[i];
    rows[i].ns_med = to_ns * time.median, rows[i].ns_min = to_ns * time.least, rows[i].ns_max = to_ns * time.most;
  }
}

}  // namespace

std::vector<Marching> charted_methods() {
  std::vector<Marching> methods = {{.method = Method::Tiered},
                                   {.method = Method::Tiered, .precision = Precision::Double}};
  const auto sweep = [&](Marching marching) {
    for (const double epsilon : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      marching.epsilon = epsilon;
      methods.push_back(marching);
    }
  };
  sweep({.method = Method::Sphere});
  sweep({.method = Method::Sphere, .precision = Precision::Double});
  sweep({.method = Method::Relaxed, .relaxation = 1.2});
  sweep({.method = Method::Relaxed, .relaxation = 1.6});
  sweep({.method = Method::Automatic});
  sweep({.method = Method::Automatic, .precision = Precision::Double});
  methods.push_back({.method = Method::Certified});
  return methods;
}

std::vector<RayMeasurement> measure_rays(const compiler::CompiledScene& scene, const Field& field,
                                         std::span<const RaySet> sets, std::span<const Marching> methods, int rounds,
                                         const std::string& scene_name) {
  const PinnedThread pinned;
  std::vector<RayMeasurement> all;
  for (const RaySet& set : sets) {
    if (set.rays.empty()) continue;
    const Comparison comparison(scene, field, set);
    std::vector<RayMeasurement> rows;
    for (const Marching& marching : methods) rows.push_back(comparison.row(marching));
    time_rows(field, set, methods, rounds, rows);
    for (RayMeasurement& row : rows) row.scene = scene_name;
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

}  // namespace fathom::runtime
