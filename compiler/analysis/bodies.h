// Bodies: the parts of a scene that unions separate, also below transforms and Paint.
// compiler/analysis/media.h makes solids of bodies.
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

// Summary of the materials at and below a node.
struct Painted {
  std::uint32_t one = kNoMaterial;          // any material found there
  std::uint32_t transparent = kNoMaterial;  // the transparent material with the lowest index
  bool several = false;
  bool bare = false;  // some leaf has no material yet and gets that of the next Paint above

  bool uneven() const { return several || (bare && one != kNoMaterial); }
};

// Returns the index of the surface that a Paint node refers to.
std::size_t surface_of(const Graph& graph, NodeId paint);

// Returns `below` as seen above a Paint of `material`: the Paint gives its material to bare leaves.
Painted paint(Painted below, std::uint32_t material, std::span<const Material> materials);

// Summarises the materials of every node. [node]
std::vector<Painted> painted_below(const Scene& scene, std::span<const Surface> surfaces,
                                   std::span<const Material> materials);

struct Body {
  NodeId node;  // in the graph that find_bodies() adds to
  std::uint32_t material;
  bool transparent;
};

// Splits the scene's union into bodies, in file order. A body that the graph shows twice in one place is listed once.
// Adds the Transform and Paint nodes around each body to `graph`, a copy of the scene's. Returns nullopt when the
// added nodes or the bodies are more than `most`, or the search takes too many steps.
std::optional<std::vector<Body>> find_bodies(const Scene& scene, const std::vector<Painted>& below,
                                             std::span<const Surface> surfaces, std::span<const Material> materials,
                                             std::size_t most, Graph& graph);

}  // namespace fathom::compiler
