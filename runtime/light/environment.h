// The environment beyond the scene: a background all around, with discs before it, those of the sun and of
// directional lights with an angle. Gives the radiance of rays that leave the scene, and samples directions by it.
//
// The background is sampled by what its luminance exceeds the mean by: a sky by a table of the means of its cells, an
// image by its pixels as filtering spreads them, a gradient not at all. The even rest is so even that BSDF sampling
// finds its light with less noise (Karlik et al., "MIS Compensation: Optimizing Sampling Techniques in Multiple
// Importance Sampling", ACM Transactions on Graphics 38, 2019). A disc is sampled uniformly. sample() chooses the
// background or a disc by estimates of their irradiance, and pdf() covers all of them together.
// Tested by: tests/runtime/light/environment_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/environment_map.h"
#include "runtime/light/light_sample_context.h"
#include "runtime/light/sky.h"

namespace fathom::runtime {

// Samples of the environment for shading points, [sample]. The densities in `rows` are of the background alone.
struct EnvironmentSamples {
  static constexpr std::size_t kCapacity = DirectionRows::kCapacity;
  const LightSampleContext* context[kCapacity];
  alignas(64) float choice[kCapacity], u[kCapacity] = {}, v[kCapacity] = {};
  DirectionRows rows;
};

class Environment {
 public:
  // `map` is of the image that the scene's background names, if it names one.
  Environment(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentMap> map);

  // Sets the radiance of the first `count` rows to that of rays that leave the scene in their directions, and their
  // density to that of samples of the background alone.
  void look_up(std::size_t count, DirectionRows& rows) const;
  bool emits() const { return mean() > 0 || !discs_.empty(); }  // true if there is light to sample
  // Returns an estimate of the irradiance by the sampled light, as luminance. 0 only if none of that light arrives.
  float importance(const LightSampleContext& context) const;
  // True if importance() is the same everywhere.
  bool is_uniform() const { return discs_.empty(); }
  // Returns the same estimate for the light of the background that is too even to be sampled.
  float even_importance() const { return light_ ? strength_ * light_->even : 0; }
  // Samples directions by three numbers in [0,1) each, with their radiance. Requires importance() > 0.
  void sample(std::size_t count, EnvironmentSamples& samples) const;
  // Returns the density per solid angle with which sample() samples a direction, given its density as of look_up().
  float pdf(const LightSampleContext& context, glm::vec3 direction, float density) const;

 private:
  struct Disc {
    glm::dvec3 direction;  // towards its centre
    double height;         // 1 - cos of its angle
    // Chord from its centre to its rim, plus the change of sampled directions by rounding.
    double rim;
    glm::vec3 radiance;
    float irradiance;  // luminance, on a surface that faces the disc

    bool contains(glm::vec3 w) const;
    glm::vec3 sample(glm::vec2 u) const;  // uniformly
  };
  using Type = compiler::Background::Type;

  void add_disc(glm::dvec3 direction, double degrees, glm::vec3 irradiance);
  void complete(std::size_t count, DirectionRows& rows) const;
  void aim_at_discs(std::size_t count, EnvironmentSamples& samples) const;
  void set_gradient(std::size_t count, DirectionRows& rows) const;
  void set_sky(std::size_t count, DirectionRows& rows) const;
  void add_discs(std::size_t count, DirectionRows& rows) const;
  // Returns the disc that the number chooses, or null for the background.
  const Disc* choose_disc(const LightSampleContext& context, float choice) const;
  float mean() const;  // luminance of the background's light that is sampled
  float importance(const Disc& disc, const LightSampleContext& context) const;

  Type type_;
  glm::dvec3 bottom_, top_;        // gradient
  std::optional<Sky> sky_;         // sky
  float strength_ = 1, turn_ = 0;  // of the image; the turn as in PiecewiseConstantSphere
  std::shared_ptr<const UnevenLight> light_;  // of a sky or an image; null for a gradient
  std::vector<Disc> discs_;
};

}  // namespace fathom::runtime
