#include "runtime/mesh/lattice/mesh_field.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

// Number of points that one call of an evaluator gets, at most what regions take at once.
constexpr std::size_t kPointBatch = 256;
static_assert(kPointBatch <= kMaxPoints && kPointBatch <= Regions::kMaxHits);

std::size_t batches_of(std::size_t count) { return (count + kPointBatch - 1) / kPointBatch; }

}  // namespace

void PointArrays::reserve(std::size_t count) {
  for (auto& axis : axes_) axis.reserve(count + kRegister);
}

void PointArrays::resize(std::size_t count) {
  count_ = count;
  for (auto& axis : axes_) axis.resize(count + kRegister);
}

void PointArrays::push_back(float x, float y, float z) {
  const std::size_t i = count_++;
  if (axes_[0].size() < count_ + kRegister) {
    for (auto& axis : axes_) axis.resize(2 * count_ + kRegister);
  }
  set(i, x, y, z);
}

MeshField::ClipDistance MeshField::clip_distance(glm::dvec3 p) const {
  ClipDistance most{-std::numeric_limits<double>::infinity(), glm::dvec3(0)};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const double distance = sign < 0 ? clip_.lo[axis] - p[axis] : p[axis] - clip_.hi[axis];
      if (distance <= most.distance) continue;
      most = {distance, glm::dvec3(0)};
      most.normal[axis] = sign;
    }
  }
  return most;
}

void MeshField::evaluate(vm::Points points, std::size_t count, Values kind, float* out, Scratch& scratch) const {
  for (std::size_t first = 0; first < count; first += kPointBatch) {
    const std::size_t some = std::min(kPointBatch, count - first);
    const vm::Points batch{points.x + first, points.y + first, points.z + first};
    scratch.values.resize(kPointBatch + 16);
    float* values = scratch.values.data();
    field_->evaluate(batch, some, values, scratch.regions, scratch.workspace);
    if (kind == Values::Radius) {
      field_->to_steps(batch, some, values);
      const float inverse = field_->cells ? 1.0f : field_->inv_lipschitz;
      for (std::size_t i = 0; i < some; ++i) values[i] *= inverse;
    }
    if (is_clipped()) {
      for (std::size_t i = 0; i < some; ++i) {
        const double clip = clip_distance({batch.x[i], batch.y[i], batch.z[i]}).distance;
        values[i] = std::max(values[i], static_cast<float>(clip));  // keeps NaN
      }
    }
    std::copy_n(values, some, out + first);
  }
}

void MeshField::evaluate(const PointArrays& points, Values kind, std::vector<float>& out, int threads) const {
  out.resize(points.size());
  parallel_for(
      threads, batches_of(points.size()), [] { return std::make_unique<Scratch>(); },
      [&](std::unique_ptr<Scratch>& scratch, std::size_t batch) {
        const std::size_t first = batch * kPointBatch, count = std::min(kPointBatch, points.size() - first);
        evaluate(points.from(first), count, kind, out.data() + first, *scratch);
      });
}

bool MeshField::is_inside(glm::dvec3 p, RealScratch& scratch) const {
  std::uint64_t instructions = 0;
  double value = field_->evaluate(p, scratch, instructions);
  if (is_clipped()) value = std::max(value, clip_distance(p).distance);
  return value < -field_->rounding(p);
}

void MeshField::find_surfaces(const PointArrays& points, std::vector<SurfacePoint>& out, int threads) const {
  struct Results {
    std::vector<float> distance = std::vector<float>(kPointBatch + 16), x = distance, y = distance, z = distance;
    std::vector<std::uint32_t> surface = std::vector<std::uint32_t>(kPointBatch + 16);
    vm::Workspace workspace;
  };
  out.resize(points.size());
  parallel_for(
      threads, batches_of(points.size()), [] { return std::make_unique<Results>(); },
      [&](std::unique_ptr<Results>& found, std::size_t batch) {
        const std::size_t first = batch * kPointBatch, count = std::min(kPointBatch, points.size() - first);
        field_->evaluate_surface(
            points.from(first), count,
            {found->distance.data(), found->x.data(), found->y.data(), found->z.data(), found->surface.data()},
            found->workspace);
        for (std::size_t i = 0; i < count; ++i) {
          const glm::dvec3 gradient(found->x[i], found->y[i], found->z[i]);
          const double length = glm::length(gradient);
          constexpr double kFlat = 1e-6;  // gradients below are rounding
          SurfacePoint& point = out[first + i];
          point = {length > kFlat && std::isfinite(length) ? gradient / length : glm::dvec3(0), found->surface[i]};
          if (!is_clipped()) continue;
          const ClipDistance clip = clip_distance(points[first + i]);
          if (clip.distance > static_cast<double>(found->distance[i])) point.normal = clip.normal;
        }
      });
}

}  // namespace fathom::runtime
