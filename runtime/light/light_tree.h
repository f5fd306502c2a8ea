// Chooses one of many lights for a shading point, by an estimate of the irradiance that each light gives there, from
// a ball around the light and a cone around the directions that it faces.
//
// Up to kFewLights lights are all estimated. More lights go into a binary tree, whose nodes are estimated like lights
// and which sample() descends at random.
//
// Source: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018; without
// the adaptive splitting, and with nodes divided at the middle light along the longest axis instead of by cost.
// Tested by: tests/runtime/light/light_tree_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "runtime/light/light_sample_context.h"

namespace fathom::runtime {

// Bounds on the place and the emission of a light, or of several together.
struct LightBounds {
  glm::dvec3 centre{0};
  double radius = 0;  // of a ball that contains the light
  // The directions that the light faces lie within the angle of cosine cos_spread around the axis. The light goes to
  // directions whose angle from one of these has at least the cosine cos_emission. cos_spread -1: all directions.
  glm::vec3 axis{0, 1, 0};
  float cos_spread = -1, cos_emission = 0;
  bool two_sided = false;  // the light faces along -axis, too
  float intensity = 0;     // luminance: irradiance of a surface that faces the light, times the distance squared
};

// Returns an estimate of the irradiance at the shading point. 0 only if no light can arrive.
float importance(const LightBounds& light, const LightSampleContext& context);

class LightTree {
 public:
  static constexpr std::size_t kFewLights = 32, kLeafLights = 8;

  explicit LightTree(std::vector<LightBounds> lights);

  struct SampledLight {
    std::uint32_t light;
    float pmf;
  };
  // Chooses a light by a number in [0,1). Returns nothing if no light can arrive.
  std::optional<SampledLight> sample(const LightSampleContext& context, float u) const;
  // Returns the probability with which sample() returns `light`.
  float pmf(const LightSampleContext& context, std::uint32_t light) const;
  // Returns an estimate of the irradiance by all lights together.
  float total_importance(const LightSampleContext& context) const;
  bool empty() const { return lights_.empty(); }
  std::size_t size() const { return lights_.size(); }

  // Calls `use` with every light whose ball is within `reach` of `place`.
  template <class Use>
  void for_each_near(glm::dvec3 place, double reach, const Use& use) const;

 private:
  // A node's lights are order_[first, first + count). The children of an inner node are the next node and
  // `second_child`.
  struct Node {
    LightBounds bounds;
    std::uint32_t first, count;
    std::uint32_t second_child = 0;  // 0: a leaf
  };
  void build(std::uint32_t first, std::uint32_t count, std::size_t max_in_leaf);
  float total_importance_of(const Node& leaf, const LightSampleContext& context) const;

  std::vector<LightBounds> lights_;
  std::vector<std::uint32_t> order_, slot_;  // slot_[order_[i]] = i
  std::vector<Node> nodes_;
};

template <class Use>
void LightTree::for_each_near(glm::dvec3 place, double reach, const Use& use) const {
  const auto touches = [&](const LightBounds& bounds) {
    return glm::length(bounds.centre - place) <= bounds.radius + reach;
  };
  std::array<std::uint32_t, 64> pending;  // the tree's depth is the logarithm of the number of lights
  std::size_t count = 0;
  if (!empty()) pending[count++] = 0;
  while (count > 0) {
    const std::uint32_t at = pending[--count];
    const Node& node = nodes_[at];
    if (!touches(node.bounds)) continue;
    if (node.second_child != 0) {
      pending[count++] = node.second_child;
      pending[count++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (touches(lights_[order_[i]])) use(order_[i]);
    }
  }
}

}  // namespace fathom::runtime
