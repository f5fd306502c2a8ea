// The lights of a scene, and their sampling. Next-event estimation calls sample(). For a ray that hits a light by
// itself, pdf_of_hit() and pdf_of_background() return the density with which sample() would have found the light.
//
// The lights are the graph's area lights (compiler::AreaLight, compiler/analysis/area_lights.h), the scene's point,
// spot and directional lights, and the environment beyond the scene (runtime/light/environment.h). Near lights and
// lights beyond the scene are sampled in proportion to estimates of their irradiance, but each side at least one time
// in four when there are both. A tree chooses among near lights (runtime/light/light_tree.h).
//
//     const LightSampleContext context{position, normal};
//     const LightSample light = lights.sample(context, u0, {u1, u2});
//     if (light.pdf > 0) ... BSDF, shadow ray ... radiance += throughput * f * light.radiance / light.pdf * weight;
//
// Sources: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapter 9 (use of the
// densities).
// Tested by: tests/runtime/light/light_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/environment.h"
#include "runtime/light/light_sample_context.h"
#include "runtime/light/light_shapes.h"
#include "runtime/light/light_tree.h"

namespace fathom::runtime {

inline constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

struct LightSample {
  glm::vec3 wi{0};                                            // unit, from the shading point towards the light
  double distance = std::numeric_limits<double>::infinity();  // to the sampled point; infinite beyond the scene
  // Arriving radiance if nothing is in the way. Delta light: irradiance of a surface that faces the light.
  glm::vec3 radiance{0};
  float pdf = 0;           // per solid angle; delta: the probability of this light; 0: no sample
  bool delta = false;      // no ray hits this light
  float light_cosine = 1;  // area lights: cosine between their normal and -wi
  std::uint32_t material = kNoMaterial, surface = kNoMaterial;  // area lights: indices into the scene's tables
};

// Shading points, and three numbers in [0,1) for each, [point].
struct LightQueries {
  static constexpr std::size_t kCapacity = EnvironmentSamples::kCapacity;
  std::span<const LightSampleContext> contexts;
  std::span<const float> choice, u, v;
  std::span<const bool> active;  // false: the point's sample stays as it is
};

class Lights {
 public:
  // `map` is of the image that the scene's background names, if it names one.
  explicit Lights(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentMap> map = nullptr);

  // True if there is nothing to sample.
  bool empty() const;
  // True if sample() uses `choice`.
  bool has_choice() const;
  // True if there are lights that no ray hits.
  bool has_delta_lights() const { return !near_delta_lights_.empty() || !directional_.empty(); }

  // Samples a light for each of up to LightQueries::kCapacity shading points. `distance` ends on the surface of the
  // area light, which is part of the field, too. A shadow ray must stop short of that surface, by more at grazing
  // angles (light_cosine).
  void sample(const LightQueries& queries, std::span<LightSample> samples) const;

  // Returns the density with which sample() samples the direction to `hit`, a point on surface number `surface` that
  // a ray from `context` found. 0 if the point is on no area light, or on a part that is not sampled.
  float pdf_of_hit(const LightSampleContext& context, std::uint32_t surface, glm::dvec3 hit) const;

  // As Environment::look_up().
  void look_up_background(std::size_t count, DirectionRows& rows) const { environment_.look_up(count, rows); }
  // Returns the density with which sample() samples a direction beyond the scene, given its density as of
  // look_up_background().
  float pdf_of_background(const LightSampleContext& context, glm::vec3 direction, float density) const;

 private:
  // A point or spot light, or a directional light without an angle.
  struct DeltaLight {
    compiler::Light light;
    float cos_outer = -1, cos_inner = -1;  // of a spot's cone
  };
  struct DiffuseAreaLight {
    AreaLightShape shape;
    glm::vec3 radiance;
    bool touches_earlier;  // its bounding ball meets that of an earlier area light
  };
  struct SelectionProbabilities {
    float near, environment, directional;  // probabilities of sampling them; the rest is no sample
  };

  void add_area_lights(const compiler::CompiledScene& scene, std::vector<LightBounds>& bounds);
  void add_delta(const compiler::Light& light, std::vector<LightBounds>& bounds);
  void find_touching();
  double tolerance(const AreaLightShape& shape, glm::dvec3 place) const;
  // Returns the area light that a point of the area lights' surfaces belongs to, the first if several coincide there.
  std::optional<std::uint32_t> area_light_at(glm::dvec3 place) const;
  float directional_importance(const DeltaLight& delta, const LightSampleContext& context) const;
  SelectionProbabilities selection_probabilities(const LightSampleContext& context) const;
  // Samples a light that is neither a box nor beyond the scene.
  LightSample sample_near(const LightSampleContext& context, std::uint32_t light, glm::vec2 u) const;
  LightSample box_sample(const LightSampleContext& context, const BoxLightRows& rows, std::size_t k) const;
  LightSample area_light_sample(const LightSampleContext& context, std::uint32_t light, glm::dvec3 way,
                                double distance, double pdf) const;
  LightSample sample_delta(const LightSampleContext& context, const DeltaLight& delta) const;
  LightSample sample_directional(const LightSampleContext& context, float choice) const;

  Environment environment_;
  std::vector<DiffuseAreaLight> area_lights_;
  std::vector<BoxLight> boxes_;                // [area light]; used for boxes and rectangles
  std::vector<bool> has_area_lights_;          // [surface]
  std::vector<DeltaLight> near_delta_lights_;  // in the tree numbered after the area lights
  std::vector<DeltaLight> directional_;
  LightTree tree_;
  bool all_near_ = false;                             // no light comes from beyond the scene
  std::optional<SelectionProbabilities> everywhere_;  // if they are the same everywhere
};

}  // namespace fathom::runtime
