#include "compiler/media.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "compiler/blends.h"
#include "compiler/bounds.h"
#include "compiler/passes/passes.h"
#include "compiler/passes/rewrite.h"

namespace fathom::compiler {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The materials below a node, as far as it matters.
struct Painted {
  std::uint32_t one = kNone;          // a material found there
  std::uint32_t transparent = kNone;  // the first of those that transmit
  bool several = false;
};

Painted join(const Painted& a, const Painted& b) {
  if (a.one == kNone) return b;
  if (b.one == kNone) return a;
  return {a.one, std::min(a.transparent, b.transparent), a.several || b.several || a.one != b.one};
}

// [node]
std::vector<Painted> painted_below(const Scene& scene, std::span<const Surface> surfaces,
                                   std::span<const Material> materials) {
  std::vector<Painted> below(scene.root + 1);
  for (NodeId id = 0; id <= scene.root; ++id) {
    for (const NodeId child : scene.graph.children(id)) below[id] = join(below[id], below[child]);
    if (scene.graph.kind(id) != Kind::Paint) continue;
    const std::uint32_t material = surfaces[static_cast<std::size_t>(scene.graph.params(id)[0])].material;
    below[id] = join(below[id], {material, transmits(materials[material]) ? material : kNone, false});
  }
  return below;
}

// A part of the scene that is of one material, as far as unions and moves tell parts from each other.
struct Body {
  NodeId node;  // in the graph that is made
  std::uint32_t material;
  bool transparent;
};

// Takes the union apart; the bodies are added to `graph`, a copy of the scene's.
class Bodies {
 public:
  Bodies(const std::vector<Painted>& below, Graph& graph) : below_(below), graph_(graph) {}

  std::vector<Body> of(NodeId root) {
    pending_ = {{root, {}}};
    while (!pending_.empty()) {
      const Part part = std::move(pending_.back());
      pending_.pop_back();
      if (below_[part.node].several && divides(graph_.kind(part.node))) {
        descend(part);
      } else {
        add(part);
      }
    }
    return std::move(bodies_);
  }

 private:
  struct Part {
    NodeId node;
    std::vector<NodeId> around;  // Transform and Paint nodes, the outermost first
  };

  static bool divides(Kind kind) { return kind == Kind::Union || kind == Kind::Transform || kind == Kind::Paint; }

  void descend(const Part& part) {
    const std::span<const NodeId> children = graph_.children(part.node);
    for (std::size_t i = children.size(); i-- > 0;) {
      Part& next = pending_.emplace_back(Part{children[i], part.around});
      if (graph_.kind(part.node) != Kind::Union) next.around.push_back(part.node);
    }
  }

  void add(const Part& part) {
    Painted painted = below_[part.node];
    NodeId node = part.node;
    for (std::size_t i = part.around.size(); i-- > 0;) {
      const NodeId outer = part.around[i];
      if (painted.one == kNone) painted = below_[outer];
      const std::vector<double> params(graph_.params(outer).begin(), graph_.params(outer).end());
      const Origin origin = graph_.origin(outer);
      node = graph_.add(graph_.kind(outer), params, std::span(&node, 1), origin);
    }
    const bool transparent = painted.transparent != kNone;
    bodies_.push_back({node, transparent ? painted.transparent : painted.one, transparent});
  }

  const std::vector<Painted>& below_;
  Graph& graph_;
  std::vector<Part> pending_;
  std::vector<Body> bodies_;
};

// Whether `a` is what shows where it overlaps `b`, which is transparent and of another material.
bool outranks(const Body& a, const Body& b, std::span<const Material> materials) {
  if (!a.transparent) return true;
  const int first = materials[a.material].priority, second = materials[b.material].priority;
  return first != second ? first > second : a.material < b.material;
}

bool apart(const Box& a, const Box& b) {
  const Box both = intersect(a, b);
  return both.empty() && !(a.empty() || b.empty());
}

// The bodies of `material` without what outranks them and may be where they are.
Scene inside_of(std::uint32_t material, const Graph& graph, const std::vector<Body>& bodies,
                const std::vector<Knowledge>& known, std::span<const Material> materials) {
  Scene scene{graph, 0};
  std::vector<NodeId> own;
  Box box;
  for (const Body& body : bodies) {
    if (!body.transparent || body.material != material) continue;
    own.push_back(body.node);
    box = unite(box, known[body.node].box);
  }
  const Origin origin = graph.origin(own[0]);
  std::vector<NodeId> operands = {own.size() == 1 ? own[0] : scene.graph.add(Kind::Union, {}, own, origin)};
  const Body sample{own[0], material, true};
  for (const Body& body : bodies) {
    if (body.transparent && body.material == material) continue;
    if (outranks(body, sample, materials) && !apart(known[body.node].box, box)) operands.push_back(body.node);
  }
  scene.root = operands.size() == 1 ? operands[0] : scene.graph.add(Kind::Subtraction, {}, operands, origin);
  return scene;
}

}  // namespace

std::vector<MediumScene> media_of(const Scene& scene, std::span<const Surface> surfaces,
                                  std::span<const Material> materials) {
  const std::vector<Painted> below = painted_below(scene, surfaces, materials);
  std::vector<MediumScene> media;
  if (below[scene.root].transparent == kNone) return media;
  Graph graph = scene.graph;
  const std::vector<Body> bodies = Bodies(below, graph).of(scene.root);
  const std::vector<Knowledge> known = analyse(graph);
  for (std::uint32_t material = 0; material < materials.size(); ++material) {
    const auto is_its = [&](const Body& body) { return body.transparent && body.material == material; };
    if (std::none_of(bodies.begin(), bodies.end(), is_its)) continue;
    media.push_back({material, level(inside_of(material, graph, bodies, known, materials))});
  }
  return media;
}

bool mixes_materials(const Scene& scene, std::span<const Surface> surfaces) {
  const std::vector<bool> reached = reachable(scene);
  std::vector<Painted> below(scene.root + 1);
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id]) continue;
    for (const NodeId child : scene.graph.children(id)) below[id] = join(below[id], below[child]);
    const Kind kind = scene.graph.kind(id);
    if (kind == Kind::Paint) {
      const std::uint32_t material = surfaces[static_cast<std::size_t>(scene.graph.params(id)[0])].material;
      below[id] = join(below[id], {material, kNone, false});
    }
    if (below[id].several && (is_blend(kind) || kind == Kind::Morph)) return true;
  }
  return false;
}

}  // namespace fathom::compiler
