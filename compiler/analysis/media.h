// The insides of what light passes through: one solid for each transparent material.
//
// The scene's field is a union, so it has no surface where a drink meets its glass, or glass the table it stands in.
// Rays within a transparent body are followed against that body's own solid instead: the union of all bodies of its
// material, without those that rank higher where they overlap. Opaque bodies rank highest; among transparent ones the
// higher `priority`, then the material first in the file (after Schmidt and Budge, "Simple Nested Dielectrics in Ray
// Traced Images", Journal of Graphics Tools 7(2), 2002).
// Tested by: tests/compiler/analysis/media_test.cpp
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
  Scene scene;             // negative inside; its Paint nodes are those of the whole
};

// The solids of all transparent materials that some body has, in the materials' order. A body blended or cut of
// several materials is inside as the first transparent one of them.
//
// Together they can have the square of the scene's nodes, so they are counted first and made one at a time.
class MediaMaker {
 public:
  // The arguments stay as they are while the maker is used. `most`: nodes of all solids together.
  MediaMaker(const Scene& scene, std::span<const Surface> surfaces, std::span<const Material> materials,
             std::size_t most);

  // The node at which the solids have more than the limit; then none can be made.
  std::optional<NodeId> excess() const { return excess_; }

  const Graph& graph() const { return graph_; }  // of that node and of bodies

  std::size_t count() const { return media_.size(); }
  NodeId first_body(std::size_t i) const { return media_[i].own[0]; }
  MediumScene make(std::size_t i);

 private:
  struct Medium {
    std::uint32_t material;
    std::vector<NodeId> own, cuts;  // bodies
  };
  struct Places;
  Medium medium(std::span<const std::uint32_t> own, const Places& places);
  const std::vector<NodeId>& reached(const Medium& medium);

  std::span<const Material> materials_;
  Graph graph_;  // the scene's, and nodes around its bodies
  std::vector<Body> bodies_;
  std::vector<Medium> media_;
  std::optional<NodeId> excess_;
  std::size_t looks_ = 0;               // at boxes
  std::vector<std::uint32_t> walk_of_;  // [node] the last walk that reached it
  std::uint32_t walk_ = 0;
  std::vector<NodeId> reached_;
};

// Sets Surface::mixed.
void mark_mixed(const Scene& scene, std::span<const Material> materials, std::span<Surface> surfaces);

}  // namespace fathom::compiler
