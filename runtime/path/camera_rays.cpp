#include "runtime/path/camera_rays.h"

#include "runtime/sampling/camera_lanes.h"
#include "runtime/sampling/sampler_lanes.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

static_assert(kCameraBatch <= SamplerRows::kCapacity && kCameraBatch <= PinholeRows::kCapacity);

void set_samplers(const RenderContext& context, std::span<const PathKey> keys, std::span<const std::uint32_t> ids,
                  std::span<PathState> paths, SamplerRows& samplers) {
  const Settings& settings = context.settings;
  const SamplePlan plan{settings.sampler, settings.seed, settings.spp};
  PixelKey pixel;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const PathKey& key = keys[i];
    const bool same = i > 0 && key.x == keys[i - 1].x && key.y == keys[i - 1].y;
    if (!same) pixel = PixelKey(plan, static_cast<std::uint32_t>(key.x), static_cast<std::uint32_t>(key.y));
    PathState& path = paths[ids[i]];
    path.sampler = Sampler(pixel, key.sample);
    samplers.set(i, path.sampler);
  }
}

// Sets the points of the image and the weights of the paths there.
void set_places(const RenderContext& context, std::span<const PathKey> keys, std::span<const std::uint32_t> ids,
                std::span<PathState> paths, SamplerRows& samplers, PinholeRows& rows) {
  alignas(64) float u[kCameraBatch], v[kCameraBatch];
  const bool single = context.settings.spp == 1;  // a single sample shows the pixel's centre
  if (!single) {
    samplers.draw_pairs(keys.size(), u, v);
    samplers.take_pairs(keys.size());
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const FilterSample place = single ? FilterSample{} : context.filter.sample({u[i], v[i]});
    rows.x[i] = keys[i].x + 0.5 + static_cast<double>(place.offset.x);
    rows.y[i] = keys[i].y + 0.5 + static_cast<double>(place.offset.y);
    paths[ids[i]].weight = place.weight;
  }
}

void set_rays(const RenderContext& context, std::span<const std::uint32_t> ids, std::span<PathState> paths,
              const SamplerRows& samplers, PinholeRows& rows) {
  const Camera& camera = context.camera;
  if (is_pinhole(camera)) {
    set_pinhole_directions(camera, ids.size(), rows);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      Ray& ray = paths[ids[i]].ray;
      ray.origin = camera.position();
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = rows.direction[axis][i];
    }
    return;
  }
  alignas(64) float u[kCameraBatch] = {}, v[kCameraBatch] = {};
  if (camera.has_lens()) samplers.draw_pairs(ids.size(), u, v);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const CameraRay found = camera.ray(rows.x[i], rows.y[i], {u[i], v[i]});
    paths[ids[i]].ray.origin = found.origin;
    paths[ids[i]].ray.direction = found.direction;
  }
}

// Sets the state of a path with its camera ray to that before the first hit.
void begin_path(const RenderContext& context, const PathKey& key, PathState& path, RealScratch& scratch) {
  path.key = key;
  path.medium = context.camera_medium ? *context.camera_medium
                                      : medium_at(path.ray.origin, context.media, context.materials, scratch);
  path.ray.t_max = std::numeric_limits<double>::infinity();
  path.ray.side = path.medium.side;
  path.ray.slope = -1;
  path.ray.clear = 0;
  path.ray.leaves = kNoPiece;
  path.throughput = glm::vec3(1);
  path.eta_scale = 1;
  path.bounces = path.null_interactions = 0;
  path.bsdf_pdf = 0;
  path.has_shadow_ray = path.ends = false;
  path.result.radiance = glm::vec3(0);
  path.result.number = key.sample;
  path.result.hit = false;
  path.result.evaluations = path.result.instructions = 0;
}

}  // namespace

void begin_paths(const RenderContext& context, std::span<const PathKey> keys, std::span<const std::uint32_t> ids,
                 std::span<PathState> paths, RealScratch& scratch) {
  CHECK(keys.size() <= kCameraBatch && ids.size() == keys.size(), "a batch of camera rays is too large");
  SamplerRows samplers;
  PinholeRows rows;
  set_samplers(context, keys, ids, paths, samplers);
  set_places(context, keys, ids, paths, samplers, rows);
  set_rays(context, ids, paths, samplers, rows);
  for (std::size_t i = 0; i < keys.size(); ++i) begin_path(context, keys[i], paths[ids[i]], scratch);
}

}  // namespace fathom::runtime
