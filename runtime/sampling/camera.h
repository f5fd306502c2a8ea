// The camera: maps a pixel, a point in the pixel and a point on the lens to a ray.
//
// F = normalize(target - position), R = normalize(cross(F, up)), U = cross(R, F): x grows to the right and y
// downwards in the image, and `up` points up. Pixels are square.
//
// The lens is thin and ideal: all rays through one point of the image meet in one point of the plane at the focus
// distance. Source: Potmesil and Chakravarty, "A Lens and Aperture Camera Model for Synthetic Image Generation",
// 1981. The field of view is that of a pinhole in the centre of the lens, whatever the focus.
//
// The poles of a panorama are along `up`, and its centre looks level towards the target.
// Tested by: tests/runtime/sampling/camera_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

struct CameraRay {
  glm::dvec3 origin;     // scene units
  glm::dvec3 direction;  // unit length
};

class Camera {
 public:
  // `width` and `height` in pixels. An `up` parallel to the view is replaced by an axis that is not parallel.
  Camera(const compiler::Camera& camera, int width, int height);

  // Returns the ray through (x, y) and the centre of the lens. x and y in pixels, with the image's top left corner at
  // (0, 0).
  CameraRay ray(double x, double y) const;

  // Returns the ray through (x, y) and a uniform point of the lens, for uniform `u` in the unit square.
  CameraRay ray(double x, double y, glm::vec2 u) const;

  // True if the point on the lens makes a difference to a ray.
  bool has_lens() const { return lens_radius_ > 0; }
  double lens_radius() const { return lens_radius_; }        // of the circle around the aperture, scene units
  double focus_distance() const { return focus_distance_; }  // along F, scene units

  // Returns an upper bound on the distance between position() and the origin of any ray within `margin` pixels of the
  // image, scene units.
  double spread(double margin) const;

  // Returns a point of the lens, along R and U, scene units.
  glm::dvec2 lens_point(glm::vec2 u) const;

  // The camera's axes in the scene, unit length. half_extent() is half the image's width and height, at unit distance
  // for a perspective camera.
  glm::dvec3 position() const { return position_; }
  glm::dvec3 right() const { return right_; }
  glm::dvec3 up() const { return up_; }
  glm::dvec3 forward() const { return forward_; }
  glm::dvec2 half_extent() const { return half_; }
  glm::dvec2 size() const { return size_; }  // of the image, pixels
  compiler::Camera::Projection projection() const { return projection_; }

 private:
  void set_axes(const compiler::Camera& camera);
  void set_lens(const compiler::Camera& camera);
  CameraRay panorama_ray(double x, double y) const;
  // Returns the offset of a point of the image from the image's centre, on the plane at unit distance.
  glm::dvec3 image_plane_offset(double x, double y) const;

  compiler::Camera::Projection projection_;
  glm::dvec3 position_, forward_, right_, up_;
  glm::dvec2 size_, half_;  // image size in pixels, and half the image at unit distance if in perspective
  double lens_radius_ = 0, focus_distance_ = 0;
  // Corners of the aperture in the unit circle, the first repeated at the end; empty for a round aperture.
  std::vector<glm::dvec2> corners_;
};

}  // namespace fathom::runtime
