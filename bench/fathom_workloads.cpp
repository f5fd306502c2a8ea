#include "bench/fathom_workloads.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <utility>

#include "runtime/march/march.h"
#include "runtime/path/surface.h"
#include "runtime/render.h"
#include "runtime/sampling/camera.h"

namespace fathom::bench {
namespace {

using namespace fathom::runtime;

// Workload S with as many rays in flight as the marcher takes. Each ray has a slot, and the slot's number is the
// ray's id. A pixel's shadow ray takes over the slot of its camera ray.
class ShadowRenderer {
 public:
  ShadowRenderer(const compiler::CompiledScene& scene, const Frame& frame)
      : scene_(scene),
        frame_(frame),
        camera_(scene.camera, frame.width, frame.height),
        field_(make_field(scene, scene.settings.far)) {
    add_regions(field_, scene, {.threads = 1});
    constexpr double kEvaluations = 20;  // of a pixel's camera ray and shadow ray
    add_native_code(field_, kEvaluations * frame.width * frame.height);
    marcher_ = make_marcher(field_);
    picture_.pixels.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
    for (int slot = runtime::Marcher::best_load(field_); slot > 0; --slot)
      free_.push_back(static_cast<std::uint32_t>(slot - 1));
  }

  Picture run() {
    while (true) {
      while (!free_.empty() && next_ < picture_.pixels.size()) start_pixel();
      if (marcher_->empty()) break;
      marcher_->advance();
      if (marcher_->ray_hits().size() >= kShadeBatch || marcher_->empty()) settle();
    }
    picture_.rays = marcher_->counters().rays;
    return std::move(picture_);
  }

 private:
  static constexpr std::size_t kShadeBatch = 64;

  struct Slot {
    Ray ray;
    std::uint32_t pixel;
    bool shadow;
  };

  void start_pixel() {
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    const CameraRay ray = camera_.ray(x_ + 0.5, y_ + 0.5);
    Slot& begun = slots_[slot];
    begun.ray.origin = ray.origin;
    begun.ray.direction = ray.direction;
    begun.ray.side = 0;
    begun.ray.slope = -1;
    begun.ray.clear = 0;
    begun.pixel = static_cast<std::uint32_t>(next_++);
    begun.shadow = false;
    marcher_->add(slot, begun.ray);
    if (++x_ == frame_.width) x_ = 0, ++y_;
  }

  void settle() {
    marcher_->take_ray_hits(ray_hits_);
    std::size_t count = 0;
    for (const RayHit& ray_hit : ray_hits_) {
      const Slot& slot = slots_[ray_hit.id];
      if (ray_hit.status == RayHit::Status::Hit && !slot.shadow) {
        hits_[count] = {slot.ray.origin + ray_hit.t * slot.ray.direction, glm::vec3(-slot.ray.direction),
                        ray_hit.side, ray_hit.width};
        hit_slots_[count++] = ray_hit.id;
        if (count == kSurfaceBatch) shade(std::exchange(count, 0));
        continue;
      }
      float& pixel = picture_.pixels[slot.pixel];
      if (!slot.shadow) pixel = static_cast<float>(0.5 + 0.5 * slot.ray.direction.y);
      if (slot.shadow && ray_hit.status == RayHit::Status::Hit) pixel = static_cast<float>(kAlbedo * kAmbient);
      free_.push_back(ray_hit.id);
    }
    shade(count);
  }

  // Writes the unoccluded value of each hit's pixel and starts the shadow ray. A hit of the shadow ray overwrites
  // that value later.
  void shade(std::size_t count) {
    picture_.camera_hits += count;
    find_surfaces(scene_, field_, std::span(hits_).first(count), points_, marcher_->workspace());
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = slots_[hit_slots_[i]];
      const float cosine = glm::dot(points_[i].normal, glm::vec3(light_));
      picture_.pixels[slot.pixel] =
          static_cast<float>(kAlbedo * (kAmbient + (1 - kAmbient) * std::max(static_cast<double>(cosine), 0.0)));
      if (!(cosine > 0)) {
        free_.push_back(hit_slots_[i]);
        continue;
      }
      const Ray ray = spawn_ray(hits_[i], points_[i], light_, false);
      slot.ray.origin = ray.origin;
      slot.ray.direction = ray.direction;
      slot.shadow = true;
      marcher_->add(hit_slots_[i], ray);
    }
  }

  const compiler::CompiledScene& scene_;
  const Frame frame_;
  const Camera camera_;
  Field field_;
  const glm::dvec3 light_ = glm::normalize(kToLight);
  std::unique_ptr<Marcher> marcher_;
  std::size_t next_ = 0;  // next pixel to start
  int x_ = 0, y_ = 0;     // coordinates of that pixel
  std::array<Slot, Marcher::kMaxRays> slots_;
  std::vector<std::uint32_t> free_;
  std::vector<RayHit> ray_hits_;
  std::array<Hit, kSurfaceBatch> hits_;
  std::array<SurfacePoint, kSurfaceBatch> points_;
  std::array<std::uint32_t, kSurfaceBatch> hit_slots_;
  Picture picture_;
};

}  // namespace

Picture fathom_shadow(const compiler::CompiledScene& scene, const Frame& frame) {
  return ShadowRenderer(scene, frame).run();
}

Picture fathom_paths(const compiler::CompiledScene& scene, const Frame& frame) {
  RenderOptions options;
  options.threads = 1;
  options.width = frame.width;
  options.height = frame.height;
  options.spp = frame.spp;
  options.layers = {.first_hit = false};
  options.max_depth = kMaxBounces;
  const RenderResult result = render(scene, options);
  Picture picture{result.stats.march.rays, result.stats.primary_hits, {}};
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      picture.pixels.push_back(static_cast<float>(result.film.means(x, y).radiance.x));
    }
  }
  return picture;
}

}  // namespace fathom::bench
