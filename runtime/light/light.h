// The lights of a scene, and what light to look for at a place: next-event estimation asks sample(), and rays that
// find a light by themselves ask for the density with which it would have.
//
// Lights are the lamps of the graph (compiler/analysis/lamps.h), the scene's point, spot and directional lights, and all that
// lies beyond the scene (runtime/light/environment.h). Near ones and those beyond are sampled in proportion to
// estimates of what they give, but each side at least one time in four when there are both; near ones by a tree
// (runtime/light/light_tree.h).
//
//     const LightQuery query{position, normal};
//     const LightSample light = lights.sample(query, u0, {u1, u2});
//     if (light.pdf > 0) ... BSDF, shadow ray ... radiance += throughput * f * light.radiance / light.pdf * weight;
//
// Sources: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapter 9 (the densities' use).
// Tested by: tests/runtime/light/light_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/light/environment.h"
#include "runtime/light/light_query.h"
#include "runtime/light/light_shapes.h"
#include "runtime/light/light_tree.h"

namespace fathom::runtime {

inline constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

struct LightSample {
  glm::vec3 wi{0};                                            // unit, from the place towards the light
  double distance = std::numeric_limits<double>::infinity();  // to the sampled point; infinite beyond the scene
  glm::vec3 radiance{0};                                      // arriving if nothing is in the way; delta: irradiance
                                                              // of what faces it
  float pdf = 0;          // per solid angle; delta: the probability of this light; 0: no sample
  bool delta = false;     // no ray finds this light by itself
  float lamp_cosine = 1;  // of lamps: between their normal and -wi
  std::uint32_t material = kNoMaterial, surface = kNoMaterial;  // of lamps: indices into the scene's tables
};

class Lights {
 public:
  // `image`: the picture that the scene's background names, when it names one.
  explicit Lights(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentImage> image = nullptr);

  // Whether there is nothing to sample.
  bool empty() const;
  // Whether sample() makes use of `choice`.
  bool has_choice() const;
  // Whether some are not found by rays.
  bool has_deltas() const { return !near_deltas_.empty() || !directional_.empty(); }

  // By three numbers in [0,1). `distance` ends on the lamp's surface, which the field holds, too: a shadow ray stops
  // short of it, at a slant by more (lamp_cosine).
  LightSample sample(const LightQuery& query, float choice, glm::vec2 u) const;

  // The density with which sample() gives the way to `hit`, a point on surface number `surface` that a ray from
  // `query` found; 0 when that is no lamp, or a part that is not sampled.
  float pdf_of_hit(const LightQuery& query, std::uint32_t surface, glm::dvec3 hit) const;

  glm::vec3 background(glm::vec3 direction) const { return environment_.radiance(direction); }
  float pdf_of_background(const LightQuery& query, glm::vec3 direction) const;

 private:
  // A point, spot or directional light without an angle.
  struct Delta {
    compiler::Light light;
    float cos_outer = -1, cos_inner = -1;  // of a spot's cone
  };
  struct LampLight {
    LampShape shape;
    glm::vec3 radiance;
    bool touches_earlier;  // its ball meets that of a lamp before it
  };
  struct Shares {
    float near, environment, directional;  // probabilities
  };

  void add_lamps(const compiler::CompiledScene& scene, std::vector<LightBounds>& bounds);
  void add_delta(const compiler::Light& light, std::vector<LightBounds>& bounds);
  void find_touching();
  double tolerance(const LampShape& shape, glm::dvec3 place) const;
  // The lamp that a point of lamps' surfaces counts for: of those that coincide there the first.
  std::optional<std::uint32_t> lamp_at(glm::dvec3 place) const;
  float directional_estimate(const Delta& delta, const LightQuery& query) const;
  Shares shares(const LightQuery& query) const;
  LightSample sample_lamp(const LightQuery& query, std::uint32_t lamp, glm::vec2 u) const;
  LightSample sample_delta(const LightQuery& query, const Delta& delta) const;
  LightSample sample_directional(const LightQuery& query, float choice) const;

  Environment environment_;
  std::vector<LampLight> lamps_;
  std::vector<bool> has_lamps_;     // [surface]
  std::vector<Delta> near_deltas_;  // after the lamps in the tree's numbers
  std::vector<Delta> directional_;
  LightTree tree_;
  bool all_near_ = false;  // no light comes from beyond the scene
};

}  // namespace fathom::runtime
