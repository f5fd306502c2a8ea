#include "compiler/analysis/bodies.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace fathom::compiler {
namespace {

Painted join(const Painted& a, const Painted& b) {
  const bool bare = a.bare || b.bare;
  if (a.one == kNoMaterial || b.one == kNoMaterial) {
    Painted some = a.one == kNoMaterial ? b : a;
    some.bare = bare;
    return some;
  }
  return {a.one, std::min(a.transparent, b.transparent), a.several || b.several || a.one != b.one, bare};
}

bool is_identity(std::span<const double> transform) {
  constexpr std::array<double, 13> kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1};
  return std::equal(kIdentity.begin(), kIdentity.end(), transform.begin());
}

// Walks the graph from the root to the bodies. Visits a shared node once per combination of place and Paint.
class BodyFinder {
 public:
  BodyFinder(const Scene& scene, std::size_t most)
      : graph_(scene.graph), most_(most), around_(1), shared_(scene.root + 1), divides_(scene.root + 1) {
    std::vector<bool> used(scene.root + 1);
    for (NodeId id = 0; id <= scene.root; ++id) {
      const Kind kind = graph_.kind(id);
      divides_[id] = kind == Kind::Union ||
                     ((kind == Kind::Transform || kind == Kind::Paint) && divides_[graph_.children(id)[0]]);
      for (const NodeId child : graph_.children(id)) {
        shared_[child] = shared_[child] || used[child];
        used[child] = true;
      }
    }
    pending_.push_back({scene.root, 0});
  }

  bool run() {
    for (std::size_t visits = 0; !pending_.empty(); ++visits) {
      const Part part = pending_.back();
      pending_.pop_back();
      visit(part);
      if (parts_.size() > most_ || added_ > kWork * most_ || visits > graph_.size() + kWork * most_) {
        return false;
      }
    }
    return true;
  }

  struct Part {
    NodeId node;
    std::uint32_t around;  // index for around()
  };
  // A Transform or Paint node, linked to the one around it. Entry 0 stands for no node.
  struct Around {
    NodeId node = 0;
    std::uint32_t outer = 0;
    std::uint32_t length = 0;
    std::uint32_t place = 0;      // equal for equal sequences of transforms
    std::uint32_t paint = kNone;  // surface of the innermost Paint
  };
  const std::vector<Part>& parts() const { return parts_; }
  const Around& around(std::uint32_t i) const { return around_[i]; }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  // Limit on visits, and on uses of Transform and Paint nodes, per node that the caller allows.
  static constexpr std::size_t kWork = 8;

  void visit(const Part& part) {
    const Around& around = around_[part.around];
    if (shared_[part.node] && !visited_.insert({part.node, around.place, around.paint}).second) return;
    if (!divides_[part.node]) {
      added_ += around.length;
      parts_.push_back(part);
      return;
    }
    const std::uint32_t inner = graph_.kind(part.node) == Kind::Union ? part.around : enter(part);
    const std::span<const NodeId> children = graph_.children(part.node);
    for (std::size_t i = children.size(); i-- > 0;) pending_.push_back({children[i], inner});
  }

  // Returns the entry of around() for the inside of the part's own Transform or Paint.
  std::uint32_t enter(const Part& part) {
    Around next = around_[part.around];
    const std::span<const double> params = graph_.params(part.node);
    if (graph_.kind(part.node) == Kind::Paint) {
      next.paint = static_cast<std::uint32_t>(params[0]);
    } else {
      if (is_identity(params)) return part.around;
      const std::pair<std::uint32_t, std::vector<double>> made{next.place, {params.begin(), params.end()}};
      next.place = places_.try_emplace(made, static_cast<std::uint32_t>(places_.size() + 1)).first->second;
    }
    next.node = part.node;
    next.outer = part.around;
    ++next.length;
    around_.push_back(next);
    return static_cast<std::uint32_t>(around_.size() - 1);
  }

  const Graph& graph_;
  const std::size_t most_;
  std::vector<Around> around_;
  std::vector<bool> shared_;   // [node] true if the graph uses it more than once
  std::vector<bool> divides_;  // [node] true for a union, moved or painted as it may be
  std::vector<Part> pending_, parts_;
  std::size_t added_ = 0;  // Transform and Paint nodes around the parts, summed over the parts
  std::set<std::tuple<NodeId, std::uint32_t, std::uint32_t>> visited_;
  std::map<std::pair<std::uint32_t, std::vector<double>>, std::uint32_t> places_;
};

}  // namespace

std::size_t surface_of(const Graph& graph, NodeId paint) { return static_cast<std::size_t>(graph.params(paint)[0]); }

Painted paint(Painted below, std::uint32_t material, std::span<const Material> materials) {
  if (!below.bare) return below;
  below.bare = false;
  return join(below, {material, transmits(materials[material]) ? material : kNoMaterial});
}

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

std::optional<std::vector<Body>> find_bodies(const Scene& scene, const std::vector<Painted>& below,
                                             std::span<const Surface> surfaces, std::span<const Material> materials,
                                             std::size_t most, Graph& graph) {
  BodyFinder finder(scene, most);
  if (!finder.run()) return std::nullopt;
  std::vector<Body> bodies;
  for (const BodyFinder::Part& part : finder.parts()) {
    Painted painted = below[part.node];
    NodeId node = part.node;
    bool is_painted = false;
    for (std::uint32_t i = part.around; i != 0; i = finder.around(i).outer) {
      const NodeId outer = finder.around(i).node;
      if (graph.kind(outer) == Kind::Paint) {
        if (std::exchange(is_painted, true)) continue;  // the inner Paint left no leaf without a surface
        painted = paint(painted, surfaces[surface_of(graph, outer)].material, materials);
      }
      const SourceLocation origin = graph.origin(outer);
      node = graph.add(graph.kind(outer), graph.params(outer), std::span(&node, 1), origin);
    }
    if (graph.size() > scene.graph.size() + most) return std::nullopt;
    const bool transparent = painted.transparent != kNoMaterial;
    bodies.push_back({node, transparent ? painted.transparent : painted.one, transparent});
  }
  return bodies;
}

}  // namespace fathom::compiler
