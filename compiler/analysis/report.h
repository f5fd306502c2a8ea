// The exactness report. It says for every object of a scene how far its distance can be trusted, how much of the
// distance a ray may step, and which node costs the most.
//
// A ray steps the field's value divided by its Lipschitz constant. The report's constants are those of the nodes as
// written: a factor that compiler/passes/normalise.cpp divides by counts at the node that causes it. A node's cost is
// its constant over the largest of its children's constants, so that the costs along a path multiply to the whole.
// Tested by: tests/compiler/analysis/report_test.cpp
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/node_facts.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Type, name and position of a node in messages.
struct Place {
  std::string type, name;  // `type` as scenes spell it; `name` may be empty
  Span span;
};

// Returns e.g. `box "lid"`.
std::string describe(const Place& place);

struct CostlyNode {
  Place place;
  double times;  // factor by which the node shortens steps
};

struct ObjectReport {
  std::string name;
  NodeFacts facts;                      // of the object's own field
  double lipschitz = 1;                 // of the object's own field, before levelling
  std::optional<CostlyNode> costliest;  // none when no node shortens steps
};

// A node whose constant is not proved, although the constants of its children are.
struct Estimate : Place {
  // For a formula, the operation whose slope has no bound. Only the first kMaxSearched estimates have one.
  std::optional<Span> operation;
};

struct Report {
  static constexpr std::size_t kMaxSearched = 20;

  std::vector<ObjectReport> objects;
  bool certified = true;  // true if every step length is proved
  // True if some constants are proved only cell by cell (compiler/analysis/formula_cells.h): those of `estimates`.
  bool in_cells = false;
  std::vector<Estimate> estimates;
};

// Makes the report. `scene` is the graph before the first pass. Its Paint nodes are indices into `surfaces`.
Report make_report(const Scene& scene, const std::vector<Surface>& surfaces);

// Returns "exact", "bound", "in cells" or "estimate": how far the field is a distance outside the solid.
std::string_view class_of(const NodeFacts& facts, bool in_cells);

// Facts about a graph that the report, the lints and the probe share.
class FieldGraph {
 public:
  explicit FieldGraph(const Scene& scene);  // analyses normalise(scene), compiler/passes/passes.h

  // True if the root reaches the node by nodes that are distances, not by the parts of formulas.
  bool reached(NodeId id) const { return reached_[id]; }
  const NodeFacts& known(NodeId id) const { return known_[id]; }
  // Returns the children that are distances; for a displacement, the displaced node.
  std::vector<NodeId> children(NodeId id) const;
  // Returns the node's constant over the largest of its children's; 1 for nodes that level.
  double cost(NodeId id) const { return cost_[id]; }
  // Returns the node's constant before levelling.
  double steepness(NodeId id) const { return steepness_[id]; }
  // True if formulas have bounds cell by cell (compiler/analysis/formula_cells.h).
  bool has_cells() const;
  // True if every constant that is not proved is proved cell by cell.
  bool in_cells() const;
  // True if the node's constant is not proved, although all of its children's are.
  bool estimates(NodeId id) const;
  // Returns the position of the operation that has no bound, if estimates() is true and the node is a boxed formula.
  std::optional<Span> unbounded_operation(NodeId id) const;
  // Returns the node with the largest cost, of `id` and all nodes below.
  NodeId costliest(NodeId id) const { return costliest_[id]; }
  // Describes a node. Paint, Scaled and Transform nodes have the type of the node below, at their own position.
  Place place(NodeId id) const;

  // Returns the roots of the scene's objects, below the nodes that level them, in file order.
  std::vector<NodeId> objects(const std::vector<Surface>& surfaces) const;
  // Returns the index in `surfaces` of the first Paint within the object; 0 when there is none.
  std::uint32_t surface(NodeId object) const;

  const Scene& scene() const { return scene_; }
  const Graph& graph() const { return scene_.graph; }
  NodeId root() const { return scene_.root; }

 private:
  const Scene scene_;
  std::vector<NodeFacts> known_;          // [node]
  std::vector<bool> reached_;             // [node]
  std::vector<double> cost_, steepness_;  // [node]
  std::vector<NodeId> costliest_;         // [node]
};

}  // namespace fathom::compiler
