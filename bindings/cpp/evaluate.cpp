// Distances and gradients of many points, in blocks that stay in the cache.
#include "vm/interpret/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fathom/fathom.hpp>

#include "bindings/cpp/guard.h"
#include "bindings/cpp/scene_data.h"
#include "compiler/geometry/outward.h"

namespace fathom {
namespace {

constexpr std::size_t kBlock = 1024;

// Coordinates of a block of points in the programs' coordinates.
template <class T>
struct Block {
  alignas(64) std::array<T, kBlock> x, y, z;
};

template <class T>
vm::PointsOf<T> gather(const Points<T>& points, std::size_t begin, std::size_t count, glm::dvec3 origin,
                       Block<T>& block) {
  const std::ptrdiff_t stride = points.stride, first = static_cast<std::ptrdiff_t>(begin) * stride;
  if (stride == 1 && origin == glm::dvec3(0)) return {points.x + begin, points.y + begin, points.z + begin};
  const auto copy = [&](const T* from, double shift, std::array<T, kBlock>& to) {
    from += first;
    if (shift == 0) {
      for (std::size_t i = 0; i < count; ++i, from += stride) to[i] = *from;
    } else {
      for (std::size_t i = 0; i < count; ++i, from += stride)
        to[i] = static_cast<T>(static_cast<double>(*from) - shift);
    }
  };
  copy(points.x, origin.x, block.x);
  copy(points.y, origin.y, block.y);
  copy(points.z, origin.z, block.z);
  return {block.x.data(), block.y.data(), block.z.data()};
}

template <class T>
Error check(const std::shared_ptr<const Scene::Data>& data, const Points<T>& points, const Values<T>& out) {
  if (!data) return library::bad_argument(library::kNoScene);
  if (points.count > 0 && (points.x == nullptr || points.y == nullptr || points.z == nullptr)) {
    return library::bad_argument("points is null");
  }
  if (Error error = library::announced("distance", out.distance)) return error;
  if (Error error = library::announced("gradient", out.gradient)) return error;
  if (Error error = library::announced("object", out.object)) return error;
  for (const std::size_t size : {out.distance.size(), out.gradient.size(), out.object.size()}) {
    if (size != 0 && size != points.count) {
      return library::bad_argument("a span of results is neither empty nor as long as the points");
    }
  }
  return {};
}

void evaluate_distances(const Scene::Data& data, const Points<float>& points, std::span<float> out) {
  const vm::NativeProgram* native = data.native(points.count);
  Block<float> block;
  vm::Workspace workspace;
  for (std::size_t begin = 0; begin < points.count; begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.count - begin);
    const vm::Points local = gather(points, begin, count, data.scene.origin, block);
    if (native) {
      native->evaluate(local, count, out.data() + begin);
    } else {
      vm::evaluate_distance(data.scene.distance, local, count, out.data() + begin, workspace);
    }
  }
}

void evaluate_distances(const Scene::Data& data, const Points<double>& points, std::span<double> out) {
  Block<double> block;
  vm::Workspace workspace;
  for (std::size_t begin = 0; begin < points.count; begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.count - begin);
    const vm::RealPoints local = gather(points, begin, count, data.scene.origin, block);
    vm::evaluate_distance(data.scene.distance, local, count, out.data() + begin, workspace);
  }
}

void evaluate_surfaces(const Scene::Data& data, const Points<float>& points, const Values<float>& out) {
  Block<float> block;
  alignas(64) std::array<float, kBlock> distance, x, y, z;
  alignas(64) std::array<std::uint32_t, kBlock> object;
  vm::Workspace workspace;
  for (std::size_t begin = 0; begin < points.count; begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.count - begin);
    const vm::Points local = gather(points, begin, count, data.scene.origin, block);
    vm::evaluate_surface(data.scene.surface, local, count,
                         {distance.data(), x.data(), y.data(), z.data(), object.data()}, workspace);
    for (std::size_t i = 0; i < count; ++i) {
      if (!out.distance.empty()) out.distance[begin + i] = distance[i];
      if (!out.gradient.empty()) out.gradient[begin + i] = {x[i], y[i], z[i]};
      if (!out.object.empty()) out.object[begin + i] = object[i];
    }
  }
}

void evaluate_surfaces(const Scene::Data& data, const Points<double>& points, const Values<double>& out) {
  vm::Workspace workspace;
  for (std::size_t i = 0; i < points.count; ++i) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * points.stride;
    const glm::dvec3 point(points.x[at], points.y[at], points.z[at]);
    const vm::SurfaceValue value = vm::evaluate_surface(data.scene.surface, point - data.scene.origin, workspace);
    if (!out.distance.empty()) out.distance[i] = value.distance;
    if (!out.gradient.empty()) out.gradient[i] = library::to_vec3(value.gradient);
    if (!out.object.empty()) out.object[i] = value.surface;
  }
}

template <class T>
Error evaluate_values(const std::shared_ptr<const Scene::Data>& data, const Points<T>& points, const Values<T>& out) {
  if (Error error = check(data, points, out)) return error;
  if (points.count == 0) return {};
  if (!out.gradient.empty() || !out.object.empty()) {
    evaluate_surfaces(*data, points, out);
  } else if (!out.distance.empty()) {
    evaluate_distances(*data, points, out.distance);
  }
  return {};
}

// Computes one result, which must be as long as the points.
template <class T, class Result>
Error evaluate_one(const std::shared_ptr<const Scene::Data>& data, const Points<T>& points, std::span<Result> out,
                   std::span<Result> Values<T>::*result) {
  if (out.size() != points.count) return library::bad_argument("the span of results is not as long as the points");
  Values<T> values;
  values.*result = out;
  return evaluate_values(data, points, values);
}

}  // namespace

Error Scene::distance(Points<float> points, std::span<float> out) const noexcept {
  return library::guard([&] { return evaluate_one(data_, points, out, &Values<float>::distance); });
}
Error Scene::distance(Points<double> points, std::span<double> out) const noexcept {
  return library::guard([&] { return evaluate_one(data_, points, out, &Values<double>::distance); });
}
Error Scene::gradient(Points<float> points, std::span<Vec3f> out) const noexcept {
  return library::guard([&] { return evaluate_one(data_, points, out, &Values<float>::gradient); });
}
Error Scene::gradient(Points<double> points, std::span<Vec3d> out) const noexcept {
  return library::guard([&] { return evaluate_one(data_, points, out, &Values<double>::gradient); });
}
Error Scene::evaluate(Points<float> points, const Values<float>& out) const noexcept {
  return library::guard([&] { return evaluate_values(data_, points, out); });
}
Error Scene::evaluate(Points<double> points, const Values<double>& out) const noexcept {
  return library::guard([&] { return evaluate_values(data_, points, out); });
}

Error Scene::range(std::span<const Box> boxes, std::span<Interval> out) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(library::kNoScene);
    if (out.size() != boxes.size()) return library::bad_argument("the span of results is not as long as the boxes");
    if (Error error = library::announced("boxes", boxes)) return error;
    if (Error error = library::announced("out", out)) return error;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (Error error = library::check_box(fmt::format("box {}", i), boxes[i])) return error;
    }
    vm::Workspace workspace;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const compiler::Box box =
          compiler::moved_outward({library::to_glm(boxes[i].lo), library::to_glm(boxes[i].hi)}, -data_->scene.origin);
      const vm::Range range = vm::evaluate_range(data_->scene.distance, box.lo, box.hi, workspace);
      out[i] = {range.lo, range.hi};
    }
    return {};
  });
}

}  // namespace fathom
