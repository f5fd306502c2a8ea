#include "compiler/analysis/media.h"

#include <algorithm>
#include <map>
#include <utility>

#include "compiler/geometry/box_tree.h"
#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/blends.h"
#include "compiler/shapes/bounds.h"
#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

// Limit on box tests per allowed node, in the search for overlapping bodies.
constexpr std::size_t kLooksPerNode = 64;

// True if `a` shows where it overlaps `b`, a transparent body of another material.
bool outranks(const Body& a, const Body& b, std::span<const Material> materials) {
  if (!a.transparent) return true;
  const int first = materials[a.material].priority, second = materials[b.material].priority;
  return first != second ? first > second : a.material < b.material;
}

}  // namespace

// Bounding boxes of the bodies.
struct MediaMaker::Places {
  explicit Places(std::vector<Box> all) : boxes(std::move(all)), tree(boxes) {}
  const std::vector<Box> boxes;  // [body]
  const BoxTree tree;
};

MediaMaker::MediaMaker(const Scene& scene, std::span<const Surface> surfaces, std::span<const Material> materials,
                       std::size_t most)
    : materials_(materials), most_looks_(kLooksPerNode * most) {
  const std::vector<Painted> below = painted_below(scene, surfaces, materials);
  if (below[scene.root].transparent == kNoMaterial) return;
  graph_ = scene.graph;
  auto bodies = find_bodies(scene, below, surfaces, materials, most, graph_);
  if (!bodies) {
    excess_ = scene.root;
    return;
  }
  bodies_ = std::move(*bodies);
  std::map<std::uint32_t, std::vector<std::uint32_t>> bodies_of;  // [transparent material]
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].transparent) bodies_of[bodies_[i].material].push_back(i);
  }
  const std::vector<NodeFacts> known = analyse(graph_);
  std::vector<Box> boxes;
  for (const Body& body : bodies_) boxes.push_back(known[body.node].box);
  const Places places(std::move(boxes));
  walk_of_.assign(graph_.size(), 0);
  std::size_t nodes = 0;
  for (const auto& [material, own] : bodies_of) {
    media_.push_back(medium(own, places));
    nodes += reached(media_.back()).size();
    if (nodes <= most && looks_ <= most_looks_) continue;
    excess_ = bodies_[own[0]].node;
    return;
  }
}

// Returns the bodies that outrank those of the sample's material and whose boxes meet `box`.
std::vector<NodeId> MediaMaker::cuts_within(const Box& box, const Body& sample, const Places& places) {
  std::vector<std::uint32_t> near;
  looks_ += places.tree.find(box, near);
  std::vector<NodeId> cuts;
  for (const std::uint32_t i : near) {
    const Body& body = bodies_[i];
    const bool is_own = body.transparent && body.material == sample.material;
    if (!is_own && outranks(body, sample, materials_)) cuts.push_back(body.node);
  }
  return cuts;
}

// Groups the bodies `own` of a material by the bodies that outrank them and may overlap them. If each body has many
// of these, all bodies are one group.
MediaMaker::Medium MediaMaker::medium(std::span<const std::uint32_t> own, const Places& places) {
  constexpr std::size_t kCutsPerBody = 4;
  const Body& sample = bodies_[own[0]];
  Medium medium{sample.material, {}};
  std::map<std::vector<NodeId>, std::size_t> group_of;  // [cuts]
  std::size_t references = 0;
  Box all;
  Group together;
  for (const std::uint32_t one : own) {
    all = unite(all, places.boxes[one]);
    together.own.push_back(bodies_[one].node);
    if (references > kCutsPerBody * bodies_.size() || looks_ > most_looks_) continue;
    std::vector<NodeId> cuts = cuts_within(places.boxes[one], sample, places);
    const auto [found, is_new] = group_of.try_emplace(cuts, medium.groups.size());
    references += is_new ? cuts.size() : 0;
    if (is_new) medium.groups.push_back({{}, std::move(cuts)});
    medium.groups[found->second].own.push_back(bodies_[one].node);
  }
  if (references <= kCutsPerBody * bodies_.size()) return medium;
  together.cuts = cuts_within(all, sample, places);
  medium.groups = {std::move(together)};
  return medium;
}

// Returns the nodes at and below the medium's bodies, in ascending order. The result is valid until the next call.
const std::vector<NodeId>& MediaMaker::reached(const Medium& medium) {
  ++walk_;
  reached_.clear();
  const auto reach = [&](NodeId node) {
    if (std::exchange(walk_of_[node], walk_) != walk_) reached_.push_back(node);
  };
  for (const Group& group : medium.groups) {
    for (const NodeId node : group.own) reach(node);
    for (const NodeId node : group.cuts) reach(node);
  }
  for (std::size_t i = 0; i < reached_.size(); ++i) {
    for (const NodeId child : graph_.children(reached_[i])) reach(child);
  }
  std::sort(reached_.begin(), reached_.end());
  return reached_;
}

MediumScene MediaMaker::make(std::size_t i) {
  CHECK(!excess_, "the solids are within the limit");
  const Medium& medium = media_[i];
  const std::vector<NodeId>& nodes = reached(medium);
  Scene scene;
  const auto copied = [&](NodeId node) {  // nodes are added in order, each once
    return static_cast<NodeId>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  std::vector<NodeId> children;
  for (const NodeId node : nodes) {
    children.clear();
    for (const NodeId child : graph_.children(node)) children.push_back(copied(child));
    const NodeId copy = scene.graph.add(graph_.kind(node), graph_.params(node), children, graph_.origin(node));
    CHECK(copy == copied(node), "different nodes stay different");
  }
  const auto all_copied = [&](const std::vector<NodeId>& of) {
    std::vector<NodeId> all;
    for (const NodeId node : of) all.push_back(copied(node));
    return all;
  };
  const SourceLocation origin = graph_.origin(medium.groups[0].own[0]);
  const auto unite_all = [&](const std::vector<NodeId>& all) {
    return all.size() == 1 ? all[0] : scene.graph.add(Kind::Union, {}, all, origin);
  };
  std::vector<NodeId> arms;
  for (const Group& group : medium.groups) {
    std::vector<NodeId> operands = {unite_all(all_copied(group.own))};
    for (const NodeId cut : group.cuts) operands.push_back(copied(cut));
    arms.push_back(operands.size() == 1 ? operands[0] : scene.graph.add(Kind::Subtraction, {}, operands, origin));
  }
  scene.root = unite_all(arms);
  return {medium.material, std::move(scene)};
}

void mark_mixed(const Scene& scene, std::span<const Material> materials, std::span<Surface> surfaces) {
  const Graph& graph = scene.graph;
  const std::vector<bool> reached = reachable(scene);
  const std::vector<Painted> below = painted_below(scene, surfaces, materials);
  // Bodies of one material can have different texture coordinates, if a texture is placed with the node.
  std::vector<bool> placed_below(scene.root + 1);
  for (NodeId id = 0; id <= scene.root; ++id) {
    placed_below[id] = graph.kind(id) == Kind::Paint && surfaces[surface_of(graph, id)].placed;
    for (const NodeId child : graph.children(id)) placed_below[id] = placed_below[id] || placed_below[child];
  }
  const auto mixes = [&](NodeId id) {
    return (below[id].uneven() || placed_below[id]) && (is_blend(graph.kind(id)) || graph.kind(id) == Kind::Morph);
  };
  const auto mark = [&](NodeId paint) { surfaces[surface_of(graph, paint)].mixed = true; };
  // Upwards: a bare leaf in a mixing node gets the surface of the next Paint above.
  std::vector<bool> bare_in_mix(scene.root + 1);
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id]) continue;
    bool some = mixes(id) && below[id].bare;
    for (const NodeId child : graph.children(id)) some = some || bare_in_mix[child];
    const bool paints = graph.kind(id) == Kind::Paint;
    if (some && paints) mark(id);
    bare_in_mix[id] = some && !paints;
  }
  // Downwards: every Paint within a mixing node is mixed.
  std::vector<bool> within(scene.root + 1);
  for (NodeId id = scene.root + 1; id-- > 0;) {
    if (!reached[id]) continue;
    if (within[id] && graph.kind(id) == Kind::Paint) mark(id);
    for (const NodeId child : graph.children(id)) within[child] = within[child] || within[id] || mixes(id);
  }
}

}  // namespace fathom::compiler
