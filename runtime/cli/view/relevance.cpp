#include "runtime/cli/view/relevance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "runtime/field/field.h"
#include "runtime/march/march.h"
#include "runtime/sampling/camera.h"
#include "vm/prune/specialise.h"

namespace fathom::cli {
namespace {

using Sources = std::vector<std::uint32_t>;

// Max number of offsets that all pixels together may keep: 16 MB.
constexpr double kMaxOffsets = 4e6;
constexpr int kWidest = 192;  // pixels

// Finds the instructions that matter at points, sixteen at a time.
class PointSpecialiser {
 public:
  explicit PointSpecialiser(const vm::VerifiedProgram& program) : whole_(vm::whole(program)) {}

  // Writes the instructions that matter at each point. All of them matter if the program cannot be pruned.
  void run(std::span<const glm::dvec3> points, std::span<Sources* const> out) {
    constexpr std::size_t kBoxes = vm::kEnclosedBoxes;
    alignas(64) float lo[3][kBoxes], hi[3][kBoxes];
    for (std::size_t i = 0; i < kBoxes; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto place = static_cast<float>(points[std::min(i, points.size() - 1)][axis]);
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        lo[axis][i] = std::nextafter(place, -kInfinity);
        hi[axis][i] = std::nextafter(place, kInfinity);
      }
    }
    constexpr float kAny = std::numeric_limits<float>::infinity();
    const vm::Boxes boxes{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    const bool is_pruned = specialiser_.enclose_choices(whole_, boxes, workspace_);
    if (is_pruned) specialiser_.resolve(-kAny, kAny);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (is_pruned) specialiser_.prune(i, part_);
      *out[i] = is_pruned ? part_.sources : whole_.sources;
      std::ranges::sort(*out[i]);
    }
  }

 private:
  vm::PrunedProgram whole_, part_;
  vm::Specialiser specialiser_;
  vm::Workspace workspace_;
};

}  // namespace

Relevance::Relevance(const compiler::CompiledScene& scene, const compiler::Camera& camera, int width, int height) {
  const double most = std::max(64.0, kMaxOffsets / static_cast<double>(scene.surface.instructions()));
  const double shrink = std::max({1.0, static_cast<double>(width) / kWidest, std::sqrt(width * height / most)});
  width_ = std::max(1, static_cast<int>(width / shrink));
  height_ = std::max(1, static_cast<int>(height / shrink));
  sources_.resize(static_cast<std::size_t>(width_ * height_));

  const runtime::Camera view(camera, width_, height_);
  const runtime::Field field = runtime::make_field(scene, scene.settings.far);
  std::vector<runtime::Ray> rays;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const runtime::CameraRay ray = view.ray(x + 0.5, y + 0.5);
      rays.push_back({ray.origin, ray.direction});
    }
  }
  PointSpecialiser specialiser(scene.surface);
  std::vector<glm::dvec3> points;
  std::vector<Sources*> out;
  const auto flush = [&] {
    if (!points.empty()) specialiser.run(points, out);
    points.clear(), out.clear();
  };
  for (const runtime::RayHit& hit : runtime::march(field, rays).ray_hits) {
    if (hit.status != runtime::RayHit::Status::Hit) continue;
    points.push_back(rays[hit.id].origin + hit.t * rays[hit.id].direction);
    out.push_back(&sources_[hit.id]);
    if (points.size() == vm::kEnclosedBoxes) flush();
  }
  flush();
}

std::vector<bool> Relevance::pixels(std::uint32_t offset) const {
  std::vector<bool> matters(sources_.size());
  for (std::size_t i = 0; i < sources_.size(); ++i) matters[i] = std::ranges::binary_search(sources_[i], offset);
  return matters;
}

}  // namespace fathom::cli
