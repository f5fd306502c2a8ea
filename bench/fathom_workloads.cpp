#include "bench/fathom_workloads.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "runtime/camera.h"
#include "runtime/march.h"
#include "runtime/render.h"
#include "runtime/surface.h"

namespace fathom::bench {
namespace {

using namespace fathom::runtime;

// Workload S. A ray's id is its pixel, and for a shadow ray the top bit.
class ShadowRenderer {
 public:
  ShadowRenderer(const compiler::CompiledScene& scene, const Frame& frame)
      : scene_(scene),
        frame_(frame),
        camera_(scene.camera, frame.width, frame.height),
        field_(make_field(scene, scene.settings.far)) {
    add_regions(field_, scene, {.threads = 1});
    marcher_ = make_marcher(field_);
    const auto pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    picture_.pixels.resize(pixels);
    shadow_rays_.reserve(2 * Marcher::kCapacity);
  }

  Picture run() {
    const auto pixels = static_cast<std::uint32_t>(picture_.pixels.size());
    for (std::uint32_t next = 0; next < pixels || !shadow_rays_.empty() || !marcher_->empty();) {
      while (marcher_->room() > 0 && !shadow_rays_.empty()) {
        marcher_->add(shadow_rays_.back().pixel | kShadow, shadow_rays_.back().ray);
        shadow_rays_.pop_back();
      }
      for (; marcher_->room() > 0 && next < pixels; ++next) marcher_->add(next, camera_ray(next));
      marcher_->advance();
      if (marcher_->arrivals().size() >= kShadeBatch || marcher_->empty()) settle();
    }
    picture_.rays = marcher_->counters().rays;
    return std::move(picture_);
  }

 private:
  static constexpr std::uint32_t kShadow = 1u << 31;
  static constexpr std::size_t kShadeBatch = 64;

  struct ShadowRay {
    std::uint32_t pixel;
    Ray ray;
  };

  Ray camera_ray(std::uint32_t pixel) const {
    const auto width = static_cast<std::uint32_t>(frame_.width);
    const CameraRay ray = camera_.ray(pixel % width + 0.5, pixel / width + 0.5);
    return {ray.origin, ray.direction};
  }

  void settle() {
    marcher_->take_arrivals(arrivals_);
    std::size_t count = 0;
    for (const Arrival& arrival : arrivals_) {
      const bool hit = arrival.status == Arrival::Status::Hit;
      if (arrival.id & kShadow) {
        if (hit) picture_.pixels[arrival.id & ~kShadow] = static_cast<float>(kAlbedo * kAmbient);
        continue;
      }
      const Ray ray = camera_ray(arrival.id);
      picture_.pixels[arrival.id] = static_cast<float>(0.5 + 0.5 * ray.direction.y);
      if (!hit) continue;
      hits_[count] = {ray.origin + arrival.t * ray.direction, glm::vec3(-ray.direction), arrival.side, arrival.width};
      pixels_[count] = arrival.id;
      if (++count == kSurfaceBatch) {
        shade(count);
        count = 0;
      }
    }
    shade(count);
  }

  // What the pixel shows unless its shadow ray hits.
  void shade(std::size_t count) {
    picture_.camera_hits += count;
    find_surfaces(scene_, field_, std::span(hits_).first(count), points_, marcher_->workspace());
    for (std::size_t i = 0; i < count; ++i) {
      const float cosine = glm::dot(points_[i].normal, glm::vec3(light_));
      picture_.pixels[pixels_[i]] =
          static_cast<float>(kAlbedo * (kAmbient + (1 - kAmbient) * std::max(static_cast<double>(cosine), 0.0)));
      if (!(cosine > 0)) continue;
      Ray ray{spawn(hits_[i], points_[i], false), light_};
      ray.side = hits_[i].side;
      ray.slope = cosine;
      shadow_rays_.push_back({pixels_[i], ray});
    }
  }

  const compiler::CompiledScene& scene_;
  const Frame frame_;
  const Camera camera_;
  Field field_;
  const glm::dvec3 light_ = glm::normalize(kToLight);
  std::unique_ptr<Marcher> marcher_;
  std::vector<ShadowRay> shadow_rays_;
  std::vector<Arrival> arrivals_;
  std::array<Hit, kSurfaceBatch> hits_;
  std::array<SurfacePoint, kSurfaceBatch> points_;
  std::array<std::uint32_t, kSurfaceBatch> pixels_;
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
  options.layers = {false, false};
  options.cut_after = kMostBounces;
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
