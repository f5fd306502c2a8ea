#include "runtime/march/march.h"

#include <algorithm>
#include <fathom/fathom.hpp>
#include <glm/geometric.hpp>

#include "bindings/cpp/guard.h"
#include "bindings/cpp/scene_data.h"
#include "runtime/path/surface.h"

namespace fathom {
namespace {

// Rays followed at once: enough to fill the marcher's registers, few enough for the cache.
constexpr std::size_t kRays = 4096;

bool is_finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool is_valid(const Ray& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) &&
         (ray.direction.x != 0 || ray.direction.y != 0 || ray.direction.z != 0) && ray.t_max.value_or(0) >= 0;
}

// A ray in the programs' coordinates. The marcher normalises directions, and so does this, with equal results.
runtime::Ray to_runtime(const Ray& ray, glm::dvec3 origin) {
  runtime::Ray out{library::to_glm(ray.origin) - origin, glm::normalize(library::to_glm(ray.direction))};
  if (ray.t_max) out.t_max = *ray.t_max;
  return out;
}

// Computes normals and objects of the rays that hit.
void add_surfaces(const Scene::Data& data, std::span<const runtime::Ray> rays,
                  std::span<const runtime::RayHit> results, std::span<Hit> out, vm::Workspace& workspace) {
  std::vector<runtime::Hit> hits;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const runtime::RayHit& result = results[i];
    if (result.status != runtime::RayHit::Status::Hit) continue;
    const runtime::Ray& ray = rays[i];
    hits.push_back({ray.origin + result.t * ray.direction, glm::vec3(-ray.direction), result.side, result.width});
    which.push_back(i);
  }
  std::vector<runtime::SurfacePoint> points(hits.size());
  for (std::size_t begin = 0; begin < hits.size(); begin += runtime::kSurfaceBatch) {
    const std::size_t count = std::min<std::size_t>(runtime::kSurfaceBatch, hits.size() - begin);
    runtime::find_surfaces(data.scene, data.field(), std::span(hits).subspan(begin, count),
                           std::span(points).subspan(begin, count), workspace);
  }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    Hit& hit = out[which[i]];
    hit.hit = true;
    hit.inside = hits[i].side < 0;
    hit.t = results[which[i]].t;
    hit.position = library::to_vec3(hits[i].position + data.scene.origin);
    hit.normal = library::to_vec3(glm::normalize(glm::dvec3(points[i].normal)));
    hit.object = points[i].surface;
  }
}

void march_block(const Scene::Data& data, std::span<const Ray> rays, std::span<Hit> out, vm::Workspace& workspace) {
  std::vector<runtime::Ray> local;
  local.reserve(rays.size());
  for (const Ray& ray : rays) local.push_back(to_runtime(ray, data.scene.origin));
  const runtime::MarchResult result = runtime::march(data.field(), local);
  std::ranges::fill(out, Hit{});
  add_surfaces(data, local, result.ray_hits, out, workspace);
}

}  // namespace

Error Scene::march(std::span<const Ray> rays, std::span<Hit> out) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(library::kNoScene);
    if (out.size() != rays.size()) return library::bad_argument("the span of results is not as long as the rays");
    if (Error error = library::announced("rays", rays)) return error;
    if (Error error = library::announced("out", out)) return error;
    if (!std::ranges::all_of(rays, is_valid)) {
      return library::bad_argument("a ray's numbers are not finite, its direction is zero or its t_max is not from 0");
    }
    vm::Workspace workspace;
    for (std::size_t begin = 0; begin < rays.size(); begin += kRays) {
      const std::size_t count = std::min(kRays, rays.size() - begin);
      march_block(*data_, rays.subspan(begin, count), out.subspan(begin, count), workspace);
    }
    return {};
  });
}

}  // namespace fathom
