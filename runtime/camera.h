// The camera: a pixel and a place within it -> a ray.
//
// F = normalize(target - position), R = normalize(cross(F, up)), U = cross(R, F): x grows to the right and y
// downwards in the picture, up is up. Pixels are square. Tested by: tests/runtime/camera_test.cpp
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "compiler/compiled_scene.h"
#include "runtime/elementary.h"

namespace fathom::runtime {

struct CameraRay {
  glm::dvec3 origin;     // scene units
  glm::dvec3 direction;  // unit length
};

class Camera {
 public:
  // `width` and `height` in pixels. `up` parallel to the view is replaced by an axis that is not.
  Camera(const compiler::Camera& camera, int width, int height)
      : orthographic_(camera.projection == compiler::Camera::Projection::Orthographic),
        position_(camera.position),
        size_(width, height) {
    forward_ = glm::normalize(camera.target - camera.position);
    glm::dvec3 right = glm::cross(forward_, camera.up);
    if (!(glm::dot(right, right) > 1e-20 * glm::dot(camera.up, camera.up))) {
      right = glm::cross(forward_, std::abs(forward_.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0));
    }
    right_ = glm::normalize(right);
    up_ = glm::cross(right_, forward_);
    half_ = half_size(camera, static_cast<double>(height) / width);
  }

  // The ray through (x, y) in pixels, the top left corner of the picture at (0, 0).
  CameraRay ray(double x, double y) const {
    const double sx = (2 * x / size_.x - 1) * half_.x;
    const double sy = (1 - 2 * y / size_.y) * half_.y;
    const glm::dvec3 aside = right_ * sx + up_ * sy;
    if (orthographic_) return {position_ + aside, forward_};
    return {position_, glm::normalize(aside + forward_)};
  }

  // The camera's axes in the scene, unit length, and half the picture's width and height, at unit distance when in
  // perspective.
  glm::dvec3 position() const { return position_; }
  glm::dvec3 right() const { return right_; }
  glm::dvec3 up() const { return up_; }
  glm::dvec3 forward() const { return forward_; }
  glm::dvec2 half_size() const { return half_; }
  bool orthographic() const { return orthographic_; }

 private:
  // Half the picture's width and height, at unit distance when in perspective.
  static glm::dvec2 half_size(const compiler::Camera& camera, double aspect) {
    if (camera.projection == compiler::Camera::Projection::Orthographic) {
      return {camera.width / 2, camera.width / 2 * aspect};
    }
    if (camera.vertical_fov) {
      const double half = tangent(*camera.vertical_fov / 2);
      return {half / aspect, half};
    }
    const double half = tangent(camera.fov / 2);
    return {half, half * aspect};
  }

  bool orthographic_;
  glm::dvec3 position_, forward_, right_, up_;
  glm::dvec2 size_, half_;
};

}  // namespace fathom::runtime
