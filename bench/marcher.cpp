// Measures the cost of interpretation per ray. The whole marcher (clipping, steps, brackets, search in double) is
// compared with the same marcher around the distance function compiled ahead of time (`fathom emit cpp`), on camera
// rays and on the diffuse rays that leave their hits, and so is the marcher around native code. Compiled code does
// not return the convexity radius (vm/number/convexity-inl.h), so neither side uses one. Scenes for which the marcher
// uses convexity radii have a second row, with the unmodified marcher.
//
//     build/release/bench_marcher
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "bench/clouds.h"
#include "bench/comparison.h"
#include "bench/compiled_scenes/compiled_scenes.h"
#include "runtime/march/march.h"
#include "runtime/path/surface.h"
#include "runtime/sampling/camera.h"
#include "runtime/sampling/sampler.h"
#include "runtime/sampling/warp.h"

namespace {

using namespace fathom;
using namespace fathom::bench;

constexpr int kRounds = 21;

// A scene and its rays, alive while the benches run.
class Scene {
 public:
  explicit Scene(const CompiledAhead& ahead)
      : scene_(compile_file(ahead.path)),
        field_(runtime::make_field(scene_, scene_.settings.far)),
        plain_(field_),
        native_(field_),
        ahead_(field_) {
    plain_.convex = native_.convex = false;
    runtime::add_native_code(native_, std::numeric_limits<double>::infinity());
    ahead_.evaluator = ahead.distance;
    aim();
    bounce();
  }

  const std::vector<runtime::Ray>& camera_rays() const { return camera_; }
  const std::vector<runtime::Ray>& diffuse_rays() const { return diffuse_; }
  const runtime::Field& as_it_is() const { return field_; }
  const runtime::Field& interpreted() const { return plain_; }
  const runtime::Field& native() const { return native_; }
  const runtime::Field& compiled() const { return ahead_; }

 private:
  void aim() {
    constexpr int kWidth = 320, kHeight = 180;
    const runtime::Camera camera(scene_.camera, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const runtime::CameraRay ray = camera.ray(x + 0.5, y + 0.5);
        camera_.push_back({ray.origin, ray.direction});
      }
    }
  }

  // Makes diffuse rays as the integrator does: cosine-distributed, with the known side, slope and clear distance.
  void bounce() {
    vm::Workspace workspace;
    for (const runtime::RayHit& ray_hit : runtime::march(field_, camera_).ray_hits) {
      if (ray_hit.status != runtime::RayHit::Status::Hit) continue;
      const runtime::Ray& seen = camera_[ray_hit.id];
      const runtime::Hit hit{seen.origin + ray_hit.t * seen.direction, glm::vec3(-seen.direction), ray_hit.side,
                             ray_hit.width};
      runtime::SurfacePoint point{};
      runtime::find_surfaces(scene_, field_, {&hit, 1}, {&point, 1}, workspace);
      runtime::Sampler sampler(1, ray_hit.id, 0, 0);
      diffuse_.push_back(runtime::spawn_ray(
          hit, point, runtime::to_frame(point.normal, runtime::square_to_cosine_hemisphere(sampler.next2())), false));
    }
  }

  compiler::CompiledScene scene_;
  runtime::Field field_, plain_, native_, ahead_;
  std::vector<runtime::Ray> camera_, diffuse_;
};

void compare(const char* name, const char* kind, const Scene& scene, const std::vector<runtime::Ray>& rays) {
  const double per_ray = 1e9 / static_cast<double>(rays.size());
  const auto unled = std::make_shared<std::vector<runtime::Ray>>(rays);
  for (runtime::Ray& ray : *unled) ray.clear = 0;
  const auto compiled = [&scene, unled] { runtime::march(scene.compiled(), *unled); };
  add({fmt::format("{}: marcher / around emitted C++, {}", name, kind), "ns a ray", per_ray, 1.1, 0, kRounds,
       [&scene, unled] { runtime::march(scene.interpreted(), *unled); }, compiled});
  if (scene.native().native.distance) {
    add({fmt::format("{}: with native code / around emitted C++, {}", name, kind), "ns a ray", per_ray, 1.1, 0,
         kRounds, [&scene, unled] { runtime::march(scene.native(), *unled); }, compiled});
  }
  if (!scene.as_it_is().convex) return;
  const auto evaluations = [](const runtime::Field& field, const std::vector<runtime::Ray>& all) {
    return static_cast<double>(runtime::march(field, all).counters.evaluations) / static_cast<double>(all.size());
  };
  add({fmt::format("{}: as it is / around emitted C++, {}", name, kind), "ns a ray", per_ray,
       std::numeric_limits<double>::infinity(), 0, kRounds,
       [&scene, &rays] { runtime::march(scene.as_it_is(), rays); }, compiled,
       [&scene, &rays, unled, evaluations] {
         return fmt::format("{:.1f} evaluations a ray, {:.1f} when not led by what is convex",
                            evaluations(scene.as_it_is(), rays), evaluations(scene.interpreted(), *unled));
       }});
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::unique_ptr<Scene>> scenes;
  for (const char* name : {"A", "B", "C", "E", "F", "D1000"}) {
    const Scene& scene = *scenes.emplace_back(std::make_unique<Scene>(find(compiled_scenes(), name)));
    compare(name, "camera", scene, scene.camera_rays());
    compare(name, "diffuse", scene, scene.diffuse_rays());
  }
  return run_benches(argc, argv, "Marcher, 320 x 180 camera rays and one diffuse ray from each hit");
}
