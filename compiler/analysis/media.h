// Media: the interiors of transparent materials, one solid per material.
//
// The scene's field is a union, so it has no surface where a drink meets its glass, or a glass meets the table it
// stands on. Rays within a transparent body are marched against a separate solid instead: the union of all bodies of
// the material, each minus the bodies of higher rank that may overlap it. Opaque bodies rank highest. Transparent
// bodies rank by `priority`, then by the order of their materials in the file (after Schmidt and Budge, "Simple
// Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools 7(2), 2002). Tested by:
// tests/compiler/analysis/media_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/analysis/bodies.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

struct MediumScene {
  std::uint32_t material;  // index into SceneTables::materials
  Scene scene;             // negative inside; Paint nodes refer to the surfaces of the whole scene
};

// Makes the solids of all transparent materials that some body has, in the order of the materials. A body that blends
// or cuts several materials belongs to the first transparent material among them.
//
// The solids together can have the square of the scene's number of nodes. The maker therefore counts their nodes
// first, and then makes one solid at a time.
class MediaMaker {
 public:
  // The arguments must stay unchanged while the maker is used. `most`: maximum number of nodes of all solids.
  MediaMaker(const Scene& scene, std::span<const Surface> surfaces, std::span<const Material> materials,
             std::size_t most);

  // Returns the node at which the solids exceed the limit. If there is one, no solid can be made.
  std::optional<NodeId> excess() const { return excess_; }

  const Graph& graph() const { return graph_; }  // holds excess() and the bodies

  std::size_t count() const { return media_.size(); }
  NodeId first_body(std::size_t i) const { return media_[i].groups[0].own[0]; }
  MediumScene make(std::size_t i);

 private:
  // Nodes of bodies: some that the same cuts may overlap.
  struct Group {
    std::vector<NodeId> own, cuts;
  };
  struct Medium {
    std::uint32_t material;
    std::vector<Group> groups;
  };
  struct Places;
  std::vector<NodeId> cuts_within(const Box& box, const Body& sample, const Places& places);
  Medium medium(std::span<const std::uint32_t> own, const Places& places);
  const std::vector<NodeId>& reached(const Medium& medium);

  std::span<const Material> materials_;
  Graph graph_;  // the scene's graph, plus nodes around its bodies
  std::vector<Body> bodies_;
  std::vector<Medium> media_;
  std::optional<NodeId> excess_;
  std::size_t most_looks_, looks_ = 0;  // number of box tests: the limit, and so far
  std::vector<std::uint32_t> walk_of_;  // [node] number of the last walk that reached it
  std::uint32_t walk_ = 0;
  std::vector<NodeId> reached_;
};

// Sets Surface::mixed of all surfaces that take part in a blend or morph of several surfaces.
void mark_mixed(const Scene& scene, std::span<const Material> materials, std::span<Surface> surfaces);

}  // namespace fathom::compiler
