// The parts of a scene that are of one material each, as far as unions and moves tell parts from each other: what
// compiler/analysis/media.h makes solids of.
// Tested by: tests/compiler/analysis/media_test.cpp
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

inline constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

// The materials below a node, as far as it matters.
struct Painted {
  std::uint32_t one = kNoMaterial;          // a material found there
  std::uint32_t transparent = kNoMaterial;  // the first of those that transmit
  bool several = false;
  bool bare = false;  // some leaf has none, and will get that of the next Paint above

  bool uneven() const { return several || (bare && one != kNoMaterial); }
};

// The index of the surface that a Paint node gives.
std::size_t surface_of(const Graph& graph, NodeId paint);

// What `below` becomes under a Paint of the material, which it gives to what has none.
Painted paint(Painted below, std::uint32_t material, std::span<const Material> materials);

// [node]
std::vector<Painted> painted_below(const Scene& scene, std::span<const Surface> surfaces,
                                   std::span<const Material> materials);

struct Body {
  NodeId node;  // in the graph that find_bodies() adds to
  std::uint32_t material;
  bool transparent;
};

// Takes the union apart, in the order of the file; a body that the graph shows twice in one place is listed once.
// Adds the Transform and Paint nodes around each body to `graph`, a copy of the scene's. nullopt when these or the
// bodies are more than `most`, or it takes too many steps to tell.
std::optional<std::vector<Body>> find_bodies(const Scene& scene, const std::vector<Painted>& below,
                                             std::span<const Surface> surfaces, std::span<const Material> materials,
                                             std::size_t most, Graph& graph);

}  // namespace fathom::compiler
