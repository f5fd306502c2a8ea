// From checked nodes to the graph of nodes as described (compiler/derive/derive.h), each object painted with its surface.
//
// A node without a material of its own is painted by what it lies in. A Paint is left out where every point below it
// is painted further in already.
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
  // `named` are the definitions, `uses` their uses, `order` as order_names() gives it without cycles. The default
  // material is added to `materials`, whose textures are `textures`, when an object needs it. All must outlive the
  // builder.
  SceneBuilder(const std::vector<CheckedNode>& named, const std::vector<std::vector<Use>>& uses,
               const std::vector<std::uint32_t>& order, std::vector<Material>& materials,
               std::span<const Texture> textures, const Limits& limits, Diagnostics& diagnostics);

  void add_object(const CheckedNode& node);

  // The union of the objects; the builder is empty afterwards.
  Scene finish();
  std::vector<Surface> take_surfaces() { return std::move(surfaces_); }
  std::vector<Span> take_type_spans() { return std::move(type_spans_); }  // as Elaborated::type_spans

 private:
  // What a node becomes depends on the object it is in and the material it inherits.
  struct Context {
    std::uint32_t object;
    std::optional<std::uint32_t> material;
    bool is_new = false;  // the material is the node's own, and another than around it or in the node's coordinates
  };
  struct Built {
    NodeId id;
    bool painted;  // every point has a surface
    // The nodes that place it, a move or a union of one each, the innermost first. A material in the node's
    // coordinates is given to what they hold: so to move a thing is the same before it is painted and after.
    std::vector<NodeId> placements = {};
  };
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // named node, object, material

  Key key(std::uint32_t name, Context context) const;
  void build_named(std::uint32_t name, Context context);
  Built build(const CheckedNode& root, Context context);
  Built make(const CheckedNode& node, std::span<const Built> over);
  void transform(Built& built, std::span<const double> params, const Origin& origin);
  bool is_placed(std::optional<std::uint32_t> material) const { return material && placed_[*material]; }
  void paint(Built& built, Context context, const Origin& origin);
  std::string unique_name(const CheckedNode& node);
  bool too_many_nodes(const CheckedNode& node);

  const std::vector<CheckedNode>& named_;
  const std::vector<std::vector<Use>>& uses_;
  std::vector<Material>& materials_;
  std::vector<bool> placed_;  // [material] whether it is in the coordinates of its node
  const Limits& limits_;
  std::size_t built_nodes_ = 0;  // those of equal nodes, too: what is used in many objects is built anew in each
  bool full_ = false;            // there are more nodes than the limit, which was reported
  std::vector<bool> has_paint_;  // of each named node: whether a material is given in it or in what it uses
  Diagnostics& diagnostics_;
  Scene scene_;
  std::vector<Span> type_spans_;  // [node]
  std::vector<Surface> surfaces_;
  std::vector<std::string> object_names_;
  std::vector<NodeId> objects_;
  std::set<std::string> taken_names_;
  std::map<std::string, int> name_counts_;  // how many objects wanted each name
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> surface_numbers_;  // of object and material
  std::optional<std::uint32_t> default_material_;
  std::map<Key, Built> built_;
};

}  // namespace fathom::compiler
