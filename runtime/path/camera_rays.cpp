#include "runtime/path/camera_rays.h"

#include <array>

#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

using Samplers = std::array<Sampler, kCameraBatch>;

void make_samplers(const SamplePlan& plan, std::span<const PathKey> keys, Samplers& samplers) {
  PixelKey pixel;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const PathKey& key = keys[i];
    const bool same = i > 0 && key.x == keys[i - 1].x && key.y == keys[i - 1].y;
    if (!same) pixel = PixelKey(plan, static_cast<std::uint32_t>(key.x), static_cast<std::uint32_t>(key.y));
    samplers[i] = Sampler(pixel, key.sample);
  }
}

}  // namespace

void begin_paths(const RenderContext& context, std::span<const PathKey> keys, std::span<const std::uint32_t> ids,
                 std::span<PathState> paths, RealScratch& scratch) {
  CHECK(keys.size() <= kCameraBatch && ids.size() == keys.size(), "a batch of camera rays is too large");
  Samplers samplers;
  std::array<CameraRay, kCameraBatch> rays;
  std::array<float, kCameraBatch> weights;
  const Settings& settings = context.settings;
  make_samplers({settings.sampler, settings.seed, settings.spp}, keys, samplers);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    // A single sample shows the pixel's centre.
    const FilterSample place = settings.spp == 1 ? FilterSample{} : context.filter.sample(samplers[i].next2());
    const double x = keys[i].x + 0.5 + static_cast<double>(place.offset.x);
    const double y = keys[i].y + 0.5 + static_cast<double>(place.offset.y);
    rays[i] = context.camera.has_lens() ? context.camera.ray(x, y, samplers[i].next2()) : context.camera.ray(x, y);
    weights[i] = place.weight;
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    PathState& path = paths[ids[i]];
    path.key = keys[i];
    path.sampler = samplers[i];
    path.throughput = glm::vec3(1);
    path.weight = weights[i];
    path.eta_scale = 1;
    path.bounces = 0;
    path.null_interactions = 0;
    path.bsdf_pdf = 0;
    path.has_shadow_ray = false;
    path.ends = false;
    path.result = {};
    path.result.number = keys[i].sample;
    path.next_medium = context.camera_medium ? *context.camera_medium
                                             : medium_at(rays[i].origin, context.media, context.materials, scratch);
    path.next = Ray{rays[i].origin, rays[i].direction};
    path.next.side = path.next_medium.side;
  }
}

}  // namespace fathom::runtime
