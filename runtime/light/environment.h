// The environment beyond the scene: a background all around, with discs before it, those of the sun and of
// directional lights with an angle. Gives the radiance of rays that leave the scene, and samples directions by it.
//
// The background is sampled by its luminance: a sky by a table of the means of its cells, an image by its pixels as
// filtering spreads them, a gradient not at all. A disc is sampled uniformly. sample() chooses the background or a
// disc by estimates of their irradiance, and pdf() covers all of them together.
// Tested by: tests/runtime/light/environment_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/environment_file.h"
#include "runtime/light/light_sample_context.h"
#include "runtime/light/sky.h"
#include "runtime/sampling/piecewise_constant_sphere.h"

namespace fathom::runtime {

// Rays that leave the scene, [ray]: their directions, weights and the radiance that they find.
struct BackgroundRows {
  static constexpr std::size_t kCapacity = 64;
  float direction[3][kCapacity], weight[kCapacity], radiance[3][kCapacity];
};

class Environment {
 public:
  // `image` is the image that the scene's background names, if it names one.
  Environment(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentImage> image);

  glm::vec3 radiance(glm::vec3 direction) const;  // of rays that leave the scene
  // Sets the radiance of the first `count` rows to that of their directions.
  void set_radiance(std::size_t count, BackgroundRows& rows) const;
  bool emits() const { return mean() > 0 || !discs_.empty(); }  // true if there is light to sample
  // Returns an estimate of the irradiance by the sampled light, as luminance. 0 only if none of that light arrives.
  float importance(const LightSampleContext& context) const;
  // Samples a direction by three numbers in [0,1). Requires importance() > 0. pdf() returns its density per solid
  // angle.
  glm::vec3 sample(const LightSampleContext& context, float choice, glm::vec2 u) const;
  float pdf(const LightSampleContext& context, glm::vec3 direction) const;

 private:
  struct Disc {
    glm::dvec3 direction;  // towards its centre
    double height;         // 1 - cos of its angle
    // Chord from its centre to its rim, plus the change of sampled directions by rounding.
    double rim;
    glm::vec3 radiance;
    float irradiance;  // luminance, on a surface that faces the disc

    bool contains(glm::vec3 w) const;
  };
  using Type = compiler::Background::Type;

  void add_disc(glm::dvec3 direction, double degrees, glm::vec3 irradiance);
  glm::vec3 backdrop(glm::vec3 direction) const;  // without discs
  void set_gradient(std::size_t count, BackgroundRows& rows) const;
  glm::vec3 pixel(glm::vec3 direction) const;
  float mean() const;  // luminance of the backdrop if it is sampled, otherwise 0
  float importance(const Disc& disc, const LightSampleContext& context) const;

  Type type_;
  glm::dvec3 bottom_, top_;  // gradient
  std::optional<Sky> sky_;   // sky
  std::shared_ptr<const EnvironmentImage> image_;
  double rotation_sine_ = 0, rotation_cosine_ = 1;  // of the image's rotation
  float strength_ = 1;                      // of the image
  PiecewiseConstantSphere table_;           // of a sky or an image, in the image's own directions
  std::vector<Disc> discs_;
};

}  // namespace fathom::runtime
