// Builder of the graph of described nodes (compiler/derive/derive.h), where each object is painted with its surface.
//
// A node without a material of its own inherits the material of the enclosing node. The builder omits a Paint node if
// every point below that node is painted further inside already.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "compiler/frontend/elaborate/checked_node.h"
#include "compiler/frontend/elaborate/name_order.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

class SceneBuilder {
 public:
  // `named` are the definitions, `uses` their uses, and `order` is the result of order_names() for definitions
  // without cycles. The builder adds the default material to `materials` when an object needs it. `textures` are the
  // textures of `materials`. All arguments must outlive the builder.
  SceneBuilder(const std::vector<CheckedNode>& named, const std::vector<std::vector<Use>>& uses,
               const std::vector<std::uint32_t>& order, std::vector<Material>& materials,
               std::span<const Texture> textures, const Limits& limits, Diagnostics& diagnostics);

  void add_object(const CheckedNode& node);

  // Returns the union of the objects. The builder is empty afterwards.
  Scene finish();
  std::vector<Surface> take_surfaces() { return std::move(surfaces_); }
  std::vector<Span> take_type_spans() { return std::move(type_spans_); }  // as ElaboratedScene::type_spans

 private:
  // Context of a node. The node's result depends on its object and on the material it inherits.
  struct Context {
    std::uint32_t object;
    std::optional<std::uint32_t> material;
    // The node has a material of its own, which differs from the inherited one or is in the node's coordinates.
    bool is_new = false;
  };
  struct Built {
    NodeId id;
    bool painted;  // every point has a surface
    // Nodes that place the result, innermost first: Transform nodes, and combinators with one child. A material in
    // the node's coordinates is applied below all of them, so moving a node before or after painting gives the same
    // result.
    std::vector<NodeId> placements = {};
  };
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // named node, object, material

  Key key(std::uint32_t name, Context context) const;
  void build_named(std::uint32_t name, Context context);
  Built build(const CheckedNode& root, Context context);
  Built make(const CheckedNode& node, std::span<const Built> over);
  void transform(Built& built, std::span<const double> params, const SourceLocation& origin);
  bool is_placed(std::optional<std::uint32_t> material) const { return material && placed_[*material]; }
  void paint(Built& built, Context context, const SourceLocation& origin);
  std::string unique_name(const CheckedNode& node);
  bool too_many_nodes(const CheckedNode& node);

  const std::vector<CheckedNode>& named_;
  const std::vector<std::vector<Use>>& uses_;
  std::vector<Material>& materials_;
  std::vector<bool> placed_;  // [material] true if the material is in its node's coordinates
  const Limits& limits_;
  // Number of nodes built, including duplicates of graph nodes: a named node with materials is built again per
  // object.
  std::size_t built_nodes_ = 0;
  // The number of nodes exceeded the limit, and the error is reported.
  bool full_ = false;
  // [named node] true if the node or any node it uses has a material.
  std::vector<bool> has_paint_;
  Diagnostics& diagnostics_;
  Scene scene_;
  std::vector<Span> type_spans_;  // [node]
  std::vector<Surface> surfaces_;
  std::vector<std::string> object_names_;
  std::vector<NodeId> objects_;
  std::set<std::string> taken_names_;
  std::map<std::string, int> name_counts_;  // number of objects that asked for each name
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> surface_numbers_;  // by object and material
  std::optional<std::uint32_t> default_material_;
  std::map<Key, Built> built_;
};

}  // namespace fathom::compiler
