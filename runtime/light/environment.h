// What lies beyond the scene: a background all around and discs before it, the sun's and those of directional lights
// with an angle. Its radiance for rays that leave, and directions chosen by it.
//
// The background is sampled by its luminance: a sky as a table of its cells' means; a picture by its pixels, with
// what filtering spreads of each; a gradient not at all. A disc is sampled uniformly. Of these one is chosen by an
// estimate of its irradiance, and densities are those of all together. Tested by:
// tests/runtime/light/environment_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/environment_file.h"
#include "runtime/light/light_query.h"
#include "runtime/light/sky.h"
#include "runtime/sampling/sphere_table.h"

namespace fathom::runtime {

class Environment {
 public:
  // `image` is the picture that the scene's background names, when it names one.
  Environment(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentImage> image);

  glm::vec3 radiance(glm::vec3 direction) const;                // of rays that leave the scene
  bool emits() const { return mean() > 0 || !discs_.empty(); }  // light to look for
  // About the irradiance at the place of what is sampled, as luminance; 0 only where none of it arrives.
  float estimate(const LightQuery& query) const;
  // A direction, by three numbers in [0,1); only where estimate() > 0. pdf() is its density, per solid angle.
  glm::vec3 sample(const LightQuery& query, float choice, glm::vec2 u) const;
  float pdf(const LightQuery& query, glm::vec3 direction) const;

 private:
  struct Disc {
    glm::dvec3 direction;  // towards its middle
    double height;         // 1 - cos of its angle
    double rim;            // chord from its middle to its rim, and as much more as rounding may move what was drawn
    glm::vec3 radiance;
    float irradiance;  // luminance, of what faces it

    bool holds(glm::vec3 w) const;
  };
  using Type = compiler::Background::Type;

  void add_disc(glm::dvec3 direction, double degrees, glm::vec3 irradiance);
  glm::vec3 backdrop(glm::vec3 direction) const;  // without discs
  glm::vec3 pixel(glm::vec3 direction) const;
  float mean() const;  // luminance of the backdrop, if it is sampled; otherwise 0
  float estimate(const Disc& disc, const LightQuery& query) const;

  Type type_;
  glm::dvec3 bottom_, top_;  // gradient
  std::optional<Sky> sky_;   // sky
  std::shared_ptr<const EnvironmentImage> image_;
  double turn_sine_ = 0, turn_cosine_ = 1;  // of the picture's rotation
  float strength_ = 1;                      // of the picture
  SphereTable table_;                       // sky, image; in the picture's own directions
  std::vector<Disc> discs_;
};

}  // namespace fathom::runtime
