#include "runtime/sampling/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

using Projection = compiler::Camera::Projection;

constexpr double kMillimetre = 1e-3;  // scene units, which are metres where f-stops are given

// Returns half the image's width and height, at unit distance for a perspective camera.
glm::dvec2 half_size(const compiler::Camera& camera, double aspect) {
  if (camera.projection == Projection::Orthographic) return {camera.width / 2, camera.width / 2 * aspect};
  if (camera.vertical_fov) {
    const double half = vm::real::tan(*camera.vertical_fov / 2);
    return {half / aspect, half};
  }
  const double half =
      camera.focal_length ? camera.sensor_width / (2 * *camera.focal_length) : vm::real::tan(camera.fov / 2);
  return {half, half * aspect};
}

std::vector<glm::dvec2> polygon(int sides, double rotation) {
  std::vector<glm::dvec2> corners;
  for (int i = 0; i <= sides; ++i) {
    const vm::real::SinCos angle =
        vm::real::sin_cos_turns(0.25 + rotation / (2 * std::numbers::pi) + static_cast<double>(i % sides) / sides);
    corners.push_back({angle.cos, angle.sin});
  }
  return corners;
}

// Maps u to a uniform point of the unit disk. Near u give near points: Shirley and Chiu, "A Low Distortion Map
// Between Disk and Square", 1997.
glm::dvec2 square_to_disk(glm::dvec2 u) {
  const glm::dvec2 v = 2.0 * u - 1.0;
  if (v == glm::dvec2(0)) return v;
  const bool wide = std::abs(v.x) > std::abs(v.y);
  const double radius = wide ? v.x : v.y;
  const vm::real::SinCos angle = vm::real::sin_cos_turns(wide ? v.y / v.x / 8 : 0.25 - v.x / v.y / 8);
  return {radius * angle.cos, radius * angle.sin};
}

// Maps u to a uniform point of a polygon around 0. u.x gives the sector and the direction in the sector. u.y is the
// square of the distance from 0, relative to the side.
glm::dvec2 square_to_polygon(glm::dvec2 u, const std::vector<glm::dvec2>& corners) {
  const double along = u.x * static_cast<double>(corners.size() - 1);
  const std::size_t side = std::min(static_cast<std::size_t>(along), corners.size() - 2);
  const double share = along - static_cast<double>(side);
  return std::sqrt(u.y) * (corners[side] * (1 - share) + corners[side + 1] * share);
}

}  // namespace

Camera::Camera(const compiler::Camera& camera, int width, int height)
    : projection_(camera.projection), position_(camera.position), size_(width, height) {
  set_axes(camera);
  half_ = half_size(camera, static_cast<double>(height) / width);
  if (projection_ == Projection::Perspective) set_lens(camera);
}

double Camera::spread(double margin) const {
  if (projection_ != Projection::Orthographic) return lens_radius_;
  return glm::length(half_ * (1.0 + 2 * margin / size_));
}

void Camera::set_axes(const compiler::Camera& camera) {
  forward_ = glm::normalize(camera.target - camera.position);
  glm::dvec3 right = glm::cross(forward_, camera.up), pole = camera.up;
  if (!(glm::dot(right, right) > 1e-20 * glm::dot(camera.up, camera.up))) {
    pole = std::abs(forward_.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    right = glm::cross(forward_, pole);
  }
  right_ = glm::normalize(right);
  up_ = glm::cross(right_, forward_);
  if (projection_ == Projection::Panorama) {
    up_ = glm::normalize(pole);
    forward_ = glm::cross(up_, right_);
  }
}

void Camera::set_lens(const compiler::Camera& camera) {
  focus_distance_ = camera.focus_distance.value_or(glm::length(camera.target - camera.position));
  if (camera.f_stop) {
    // Focal length of the lens with this field of view, whichever way the scene gives it.
    const double focal_length = camera.sensor_width / (2 * half_.x) * kMillimetre;
    lens_radius_ = focal_length / (2 * *camera.f_stop);
  } else {
    lens_radius_ = camera.lens_radius.value_or(0);
  }
  if (camera.blades >= 3) corners_ = polygon(camera.blades, camera.blade_rotation);
}

glm::dvec3 Camera::image_plane_offset(double x, double y) const {
  const double sx = (2 * x / size_.x - 1) * half_.x;
  const double sy = (1 - 2 * y / size_.y) * half_.y;
  return right_ * sx + up_ * sy;
}

CameraRay Camera::ray(double x, double y) const {
  if (projection_ == Projection::Panorama) return panorama_ray(x, y);
  if (projection_ == Projection::Orthographic) return {position_ + image_plane_offset(x, y), forward_};
  return {position_, glm::normalize(image_plane_offset(x, y) + forward_)};
}

CameraRay Camera::ray(double x, double y, glm::vec2 u) const {
  if (!has_lens()) return ray(x, y);
  const glm::dvec2 place = lens_point(u);
  const glm::dvec3 offset = right_ * place.x + up_ * place.y;
  return {position_ + offset, glm::normalize((image_plane_offset(x, y) + forward_) * focus_distance_ - offset)};
}

glm::dvec2 Camera::lens_point(glm::vec2 u) const {
  return lens_radius_ *
         (corners_.empty() ? square_to_disk(glm::dvec2(u)) : square_to_polygon(glm::dvec2(u), corners_));
}

// Longitude grows from the left, half a turn before the centre. Colatitude grows from the top.
CameraRay Camera::panorama_ray(double x, double y) const {
  const auto longitude = vm::real::sin_cos_turns(x / size_.x - 0.5),
             colatitude = vm::real::sin_cos_turns(y / size_.y / 2);
  const glm::dvec3 level = forward_ * longitude.cos + right_ * longitude.sin;
  return {position_, glm::normalize(level * colatitude.sin + up_ * colatitude.cos)};
}

}  // namespace fathom::runtime
