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

constexpr std::uint32_t kNoMaterial = std::numeric_limits<std::uint32_t>::max();

// The materials below a node, as far as it matters.
struct Painted {
  std::uint32_t one = kNoMaterial;          // a material found there
  std::uint32_t transparent = kNoMaterial;  // the first of those that transmit
  bool several = false;
  bool bare = false;  // some leaf has none, and will get that of the next Paint above

  bool uneven() const { return several || (bare && one != kNoMaterial); }
};

Painted join(const Painted& a, const Painted& b) {
  const bool bare = a.bare || b.bare;
  if (a.one == kNoMaterial || b.one == kNoMaterial) {
    Painted some = a.one == kNoMaterial ? b : a;
    some.bare = bare;
    return some;
  }
  return {a.one, std::min(a.transparent, b.transparent), a.several || b.several || a.one != b.one, bare};
}

// A Paint node gives its material to what has none.
Painted paint(Painted below, std::uint32_t material, std::span<const Material> materials) {
  if (!below.bare) return below;
  below.bare = false;
  return join(below, {material, transmits(materials[material]) ? material : kNoMaterial});
}

std::size_t surface_of(const Graph& graph, NodeId paint) { return static_cast<std::size_t>(graph.params(paint)[0]); }

// [node]
std::vector<Painted> painted_below(const Scene& scene, std::span<const Surface> surfaces,
                                   std::span<const Material> materials) {
  std::vector<Painted> below(scene.root + 1);
  for (NodeId id = 0; id <= scene.root; ++id) {
    const std::span<const NodeId> children = scene.graph.children(id);
    below[id].bare = children.empty();
    for (const NodeId child : children) below[id] = join(below[id], below[child]);
    if (scene.graph.kind(id) != Kind::Paint) continue;
    below[id] = paint(below[id], surfaces[surface_of(scene.graph, id)].material, materials);
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
  Bodies(const std::vector<Painted>& below, std::span<const Surface> surfaces, std::span<const Material> materials,
         Graph& graph)
      : below_(below), surfaces_(surfaces), materials_(materials), graph_(graph) {}

  std::vector<Body> of(NodeId root) {
    pending_ = {{root, {}}};
    while (!pending_.empty()) {
      const Part part = std::move(pending_.back());
      pending_.pop_back();
      if (below_[part.node].uneven() && divides(graph_.kind(part.node))) {
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
      if (graph_.kind(outer) == Kind::Paint) {
        painted = paint(painted, surfaces_[surface_of(graph_, outer)].material, materials_);
      }
      const std::vector<double> params(graph_.params(outer).begin(), graph_.params(outer).end());
      const Origin origin = graph_.origin(outer);
      node = graph_.add(graph_.kind(outer), params, std::span(&node, 1), origin);
    }
    const bool transparent = painted.transparent != kNoMaterial;
    bodies_.push_back({node, transparent ? painted.transparent : painted.one, transparent});
  }

  const std::vector<Painted>& below_;
  std::span<const Surface> surfaces_;
  std::span<const Material> materials_;
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
  if (below[scene.root].transparent == kNoMaterial) return media;
  Graph graph = scene.graph;
  const std::vector<Body> bodies = Bodies(below, surfaces, materials, graph).of(scene.root);
  const std::vector<Knowledge> known = analyse(graph);
  for (std::uint32_t material = 0; material < materials.size(); ++material) {
    const auto is_its = [&](const Body& body) { return body.transparent && body.material == material; };
    if (std::none_of(bodies.begin(), bodies.end(), is_its)) continue;
    media.push_back({material, level(inside_of(material, graph, bodies, known, materials))});
  }
  return media;
}

void mark_mixed(const Scene& scene, std::span<const Material> materials, std::span<Surface> surfaces) {
  const Graph& graph = scene.graph;
  const std::vector<bool> reached = reachable(scene);
  const std::vector<Painted> below = painted_below(scene, surfaces, materials);
  const auto mixes = [&](NodeId id) {
    return below[id].uneven() && (is_blend(graph.kind(id)) || graph.kind(id) == Kind::Morph);
  };
  const auto mark = [&](NodeId paint) { surfaces[surface_of(graph, paint)].mixed = true; };
  // Upwards: what is bare in such a blend is of the next Paint above it.
  std::vector<bool> bare_in_mix(scene.root + 1);
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id]) continue;
    bool some = mixes(id) && below[id].bare;
    for (const NodeId child : graph.children(id)) some = some || bare_in_mix[child];
    const bool paints = graph.kind(id) == Kind::Paint;
    if (some && paints) mark(id);
    bare_in_mix[id] = some && !paints;
  }
  // Downwards: all that is painted within one.
  std::vector<bool> within(scene.root + 1);
  for (NodeId id = scene.root + 1; id-- > 0;) {
    if (!reached[id]) continue;
    if (within[id] && graph.kind(id) == Kind::Paint) mark(id);
    for (const NodeId child : graph.children(id)) within[child] = within[child] || within[id] || mixes(id);
  }
}

}  // namespace fathom::compiler
