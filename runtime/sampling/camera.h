// The camera: a pixel, a place within it and a place on the lens -> a ray.
//
// F = normalize(target - position), R = normalize(cross(F, up)), U = cross(R, F): x grows to the right and y
// downwards in the picture, up is up. Pixels are square.
//
// The lens is thin and without flaws: rays from all of it through one place of the picture meet in one point of the
// plane at the focus distance. Source: Potmesil and Chakravarty, "A Lens and Aperture Camera Model for Synthetic
// Image Generation", 1981. The field of view is that of the pinhole in its middle, whatever the focus.
//
// A panorama's poles are along `up`, its middle looks level towards the target.
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
  // `width` and `height` in pixels. `up` parallel to the view is replaced by an axis that is not.
  Camera(const compiler::Camera& camera, int width, int height);

  // The ray through (x, y) in pixels, the top left corner of the picture at (0, 0), and the middle of the lens.
  CameraRay ray(double x, double y) const;

  // The ray through a place of the lens that is as likely as every other, `u` in the unit square.
  CameraRay ray(double x, double y, glm::vec2 u) const;

  // Whether it matters where on the lens a ray begins.
  bool has_lens() const { return lens_radius_ > 0; }
  double lens_radius() const { return lens_radius_; }        // of the circle round the aperture, scene units
  double focus_distance() const { return focus_distance_; }  // along F, scene units

  // No ray within `margin` pixels of the picture begins farther than this from position(), scene units.
  double spread(double margin) const;

  // The place of the lens: along R and U, scene units.
  glm::dvec2 lens_point(glm::vec2 u) const;

  // The camera's axes in the scene, unit length, and half the picture's width and height, at unit distance when in
  // perspective.
  glm::dvec3 position() const { return position_; }
  glm::dvec3 right() const { return right_; }
  glm::dvec3 up() const { return up_; }
  glm::dvec3 forward() const { return forward_; }
  glm::dvec2 half_extent() const { return half_; }
  compiler::Camera::Projection projection() const { return projection_; }

 private:
  void set_axes(const compiler::Camera& camera);
  void set_lens(const compiler::Camera& camera);
  CameraRay panorama_ray(double x, double y) const;
  // A place of the picture, from the picture's middle on the plane at unit distance.
  glm::dvec3 aside(double x, double y) const;

  compiler::Camera::Projection projection_;
  glm::dvec3 position_, forward_, right_, up_;
  glm::dvec2 size_, half_;  // of the picture: pixels; half of it, at unit distance when in perspective
  double lens_radius_ = 0, focus_distance_ = 0;
  std::vector<glm::dvec2> corners_;  // of the aperture in the unit circle, the first once more at the end; or none
};

}  // namespace fathom::runtime
