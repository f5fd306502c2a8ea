#include "compiler/scene/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

using glm::dvec3;

// Minimum size of the framed box as a share of its distance from zero, for a box of next to no size.
constexpr double kMinSize = 1e-6;
// Minimum distance of the box from the camera as a share of the box's size, so that the camera stays outside the box.
constexpr double kClearance = 0.01;

struct Axes {
  dvec3 right, up, forward;  // unit vectors of the camera
};

Axes axes_of(const Camera& camera) {
  const dvec3 forward = glm::normalize(camera.target - camera.position);
  const dvec3 right = glm::normalize(glm::cross(forward, camera.up));
  return {right, glm::cross(right, forward), forward};
}

// Returns half the image's width and height without the margins, at unit distance.
glm::dvec2 slopes(const Camera& camera, double aspect) {
  glm::dvec2 half;
  if (camera.vertical_fov) {
    half.y = vm::real::tan(*camera.vertical_fov / 2);
    half.x = half.y * aspect;
  } else {
    half.x = camera.focal_length ? camera.sensor_width / (2 * *camera.focal_length) : vm::real::tan(camera.fov / 2);
    half.y = half.x / aspect;
  }
  return half * (1 - 2 * kFrameMargin);
}

std::array<dvec3, 8> corners_of(const Box& box) {
  std::array<dvec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i)] = {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                                            i & 4 ? box.hi.z : box.lo.z};
  }
  return corners;
}

// The eye's position along one axis of the image, and the maximum depth from which the eye sees all corners.
struct Fit {
  double side, depth;
};

// A corner c is in view along an axis when |dot(c - eye, axis)| <= slope * dot(c - eye, forward). Each corner gives
// two half planes. The outermost half planes of either kind hold, and they meet where the eye is as near as possible.
Fit fit(const std::array<dvec3, 8>& corners, dvec3 axis, dvec3 forward, double slope) {
  double above = -kInfinity, below = -kInfinity;
  for (const dvec3 corner : corners) {
    const double side = glm::dot(corner, axis), reach = slope * glm::dot(corner, forward);
    above = std::max(above, side - reach);
    below = std::max(below, -side - reach);
  }
  return {(above - below) / 2, -(above + below) / (2 * slope)};
}

struct Sides {
  double lo = kInfinity, hi = -kInfinity;
  double length() const { return hi - lo; }
  double middle() const { return (lo + hi) / 2; }
};

Sides sides_along(const std::array<dvec3, 8>& corners, dvec3 axis) {
  Sides sides;
  for (const dvec3 corner : corners) {
    sides.lo = std::min(sides.lo, glm::dot(corner, axis));
    sides.hi = std::max(sides.hi, glm::dot(corner, axis));
  }
  return sides;
}

// Returns the eye in the camera's axes, relative to the middle of the corners, which is zero.
dvec3 eye_for(const Camera& camera, const std::array<dvec3, 8>& corners, const Axes& axes, double size,
              double aspect) {
  const double front = sides_along(corners, axes.forward).lo;
  if (camera.projection == Camera::Projection::Panorama) return {0, 0, front - size};
  if (camera.projection == Camera::Projection::Orthographic) {
    return {sides_along(corners, axes.right).middle(), sides_along(corners, axes.up).middle(), front - size};
  }
  const glm::dvec2 slope = slopes(camera, aspect);
  const Fit x = fit(corners, axes.right, axes.forward, slope.x), y = fit(corners, axes.up, axes.forward, slope.y);
  return {x.side, y.side, std::min({x.depth, y.depth, front - kClearance * size})};
}

bool finite(dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

std::optional<Camera> framed(const Camera& camera, const Box& box, double aspect) {
  if (box.empty() || !box.finite()) return std::nullopt;
  const dvec3 middle = box.lo / 2.0 + box.hi / 2.0;
  const double size = std::max(glm::length(box.hi - box.lo), kMinSize * largest_part(middle));
  if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  dvec3 half = (box.hi - box.lo) / 2.0;
  if (glm::length(half) < size / 4) half = dvec3(size / 4);
  const std::array<dvec3, 8> corners = corners_of(Box::centred(half));
  const Axes axes = axes_of(camera);
  const dvec3 eye = eye_for(camera, corners, axes, size, aspect);

  Camera result = camera;
  result.position = middle + axes.right * eye.x + axes.up * eye.y + axes.forward * eye.z;
  result.target = middle + axes.right * eye.x + axes.up * eye.y;
  if (camera.projection == Camera::Projection::Orthographic) {
    const double across = sides_along(corners, axes.right).length(), along = sides_along(corners, axes.up).length();
    result.width = std::max(across, along * aspect) / (1 - 2 * kFrameMargin);
  }
  result.focus_distance.reset();
  if (!finite(result.position) || !finite(result.target) || !(glm::length(result.target - result.position) > 0)) {
    return std::nullopt;
  }
  return result;
}

Camera placed(const Camera& camera, const Box& extent, double aspect) {
  if (!camera.automatic) return camera;
  Camera above = camera;
  above.position = kThreeQuarters;
  above.target = dvec3(0);
  return framed(above, extent, aspect).value_or(camera);
}

}  // namespace fathom::compiler
