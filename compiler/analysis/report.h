// The exactness report: of every object of a scene how far its distance can be trusted and how much of it a ray may
// step, and which node costs the most.
//
// A ray steps the field's value divided by its Lipschitz constant. Constants are those of the nodes as written: what
// passes/level.cpp divides by is counted where it comes from. A node's cost is its constant over the largest of its
// children's, so that those along a path multiply to the whole.
// Tested by: tests/compiler/analysis/report_test.cpp
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/knowledge.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// A node as messages name it.
struct Place {
  std::string type, name;  // `type` as scenes spell it; `name` may be empty
  Span span;
};

// e.g. `box "lid"`.
std::string describe(const Place& place);

struct CostlyNode {
  Place place;
  double times;  // steps are this many times shorter for it
};

struct ObjectReport {
  std::string name;
  Knowledge knowledge;                  // of its own field
  double lipschitz = 1;                 // of its own field, before levelling
  std::optional<CostlyNode> costliest;  // none when every node leaves steps as long as they were
};

// A node whose constant is not proved, though the constants of its children are.
struct Estimate : Place {
  std::optional<Span> operation;  // of a formula, the operation whose slope has no bound; of the first kMostSearched
};

struct Report {
  static constexpr std::size_t kMostSearched = 20;

  std::vector<ObjectReport> objects;
  bool certified = true;  // whether every constant is proved
  std::vector<Estimate> estimates;
};

// `scene` is the graph before the first pass; `surfaces` are those its Paint nodes number.
Report make_report(const Scene& scene, const std::vector<Surface>& surfaces);

// "exact", "bound", "estimate": how far the field is a distance outside the solid.
std::string_view class_of(const Knowledge& knowledge);

// What the report and the checks beside it (lints, probe) know of a graph.
class FieldGraph {
 public:
  explicit FieldGraph(const Scene& scene);  // looks at level(scene), compiler/passes/passes.h

  // Whether the root reaches the node by nodes that are distances, not by the parts of formulas.
  bool reached(NodeId id) const { return reached_[id]; }
  const Knowledge& known(NodeId id) const { return known_[id]; }
  // The children that are distances; of a displacement, the displaced node.
  std::vector<NodeId> children(NodeId id) const;
  // The node's constant over the largest of its children's; 1 for what levels.
  double cost(NodeId id) const { return cost_[id]; }
  // The node's constant before levelling.
  double steepness(NodeId id) const { return steepness_[id]; }
  // Whether nothing is proved of the node though all of what it is made of is.
  bool estimates(NodeId id) const;
  // Of such a node that is a formula within its box: where the operation stands that leaves it without a bound.
  std::optional<Span> unbounded_operation(NodeId id) const;
  // Of the node and what lies below it, the one with the largest cost.
  NodeId costliest(NodeId id) const { return costliest_[id]; }
  // Of what only paints or places a node, that node, at the place of what does.
  Place place(NodeId id) const;

  // The roots of the scene's objects, without what levels them, in file order.
  std::vector<NodeId> objects(const std::vector<Surface>& surfaces) const;
  // The object's number in `surfaces` of the first Paint within; 0 when there is none.
  std::uint32_t surface(NodeId object) const;

  const Scene& scene() const { return scene_; }
  const Graph& graph() const { return scene_.graph; }
  NodeId root() const { return scene_.root; }

 private:
  const Scene scene_;
  std::vector<Knowledge> known_;          // [node]
  std::vector<bool> reached_;             // [node]
  std::vector<double> cost_, steepness_;  // [node]
  std::vector<NodeId> costliest_;         // [node]
};

}  // namespace fathom::compiler
