#include "compiler/frontend/elaborate/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "compiler/frontend/elaborate/fold_nodes.h"
#include "compiler/frontend/formula/formula_nodes.h"
#include "compiler/shapes/node_table.h"
#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

constexpr std::uint32_t kNoNode = 0xFFFFFFFF;

bool gives_material(const CheckedNode& node) {
  return node.material || std::any_of(node.children.begin(), node.children.end(), gives_material);
}

}  // namespace

SceneBuilder::SceneBuilder(const std::vector<CheckedNode>& named, const std::vector<std::vector<Use>>& uses,
                           const std::vector<std::uint32_t>& order, std::vector<Material>& materials,
                           std::span<const Texture> textures, const Limits& limits, Diagnostics& diagnostics)
    : named_(named),
      uses_(uses),
      materials_(materials),
      placed_(in_object_space(materials, textures)),
      limits_(limits),
      has_paint_(named.size(), false),
      diagnostics_(diagnostics) {
  for (const std::uint32_t name : order) {
    has_paint_[name] = gives_material(named[name]) || std::any_of(uses[name].begin(), uses[name].end(),
                                                                  [&](const Use& u) { return has_paint_[u.target]; });
  }
}

// Reports the excess once. Nodes left out after that report cause no further errors.
bool SceneBuilder::too_many_nodes(const CheckedNode& node) {
  const std::optional<Excess> excess =
      excess_of(static_cast<double>(std::max(scene_.graph.size(), built_nodes_)), limits_);
  if (full_ || !excess) return full_;
  full_ = true;
  diagnostics_.error("E0312", node.span, excess->what, "",
                     {"a named node with materials in it is another in each object that uses it", excess->remedy});
  return true;
}

void SceneBuilder::add_object(const CheckedNode& node) {
  if (too_many_nodes(node)) return;
  const auto object = static_cast<std::uint32_t>(object_names_.size());
  object_names_.push_back(unique_name(node));
  for (const Use& use : uses_of(node)) build_named(use.target, {object, use.material});
  if (full_) return;
  const Context context{object, node.material};
  Built built = build(node, {object, std::nullopt});
  if (!built.painted) paint(built, context, {node.span, node.name});
  objects_.push_back(built.id);
  too_many_nodes(node);
}

Scene SceneBuilder::finish() {
  CHECK(!objects_.empty(), "a scene has objects");
  scene_.root = objects_.size() == 1 ? objects_[0] : scene_.graph.add(Kind::Union, {}, objects_);
  return std::move(scene_);
}

SceneBuilder::Key SceneBuilder::key(std::uint32_t name, Context context) const {
  // A named node without materials inside is the same in every object.
  if (!has_paint_[name]) return {name, kNoNode, kNoNode};
  return {name, context.object, context.material.value_or(kNoNode)};
}

void SceneBuilder::build_named(std::uint32_t name, Context context) {
  // Explicit stack: names can use each other in a chain as long as the file.
  struct Pending {
    std::uint32_t name;
    Context context;
    std::size_t next_use;
  };
  std::vector<Pending> stack = {{name, context, 0}};
  while (!stack.empty()) {
    Pending& top = stack.back();
    const Key top_key = key(top.name, top.context);
    if (built_.contains(top_key)) {
      stack.pop_back();
    } else if (top.next_use < uses_[top.name].size()) {
      const Use& use = uses_[top.name][top.next_use++];
      const Context inner{top.context.object, use.material ? use.material : top.context.material};
      if (!built_.contains(key(use.target, inner))) stack.push_back({use.target, inner, 0});
    } else {
      const Pending ready = top;
      if (too_many_nodes(named_[ready.name])) return;
      stack.pop_back();
      built_.emplace(top_key, build(named_[ready.name], ready.context));
    }
  }
}

SceneBuilder::Built SceneBuilder::build(const CheckedNode& root, Context context) {
  const auto enter = [this](const CheckedNode& node, Context above) {
    if (!node.material) return Context{above.object, above.material, false};
    return Context{above.object, node.material, node.material != above.material || is_placed(node.material)};
  };
  return fold_nodes<Built>(root, context, enter,
                           [this](const CheckedNode& node, Context here, std::span<const Built> children) {
                             ++built_nodes_;
                             Built built = node.use ? built_.at(key(*node.use, here)) : make(node, children);
                             const SourceLocation origin{node.span, node.name};
                             if (node.between) transform(built, *node.between, origin);
                             if (node.transform) transform(built, *node.transform, origin);
                             if (here.is_new && !built.painted) paint(built, here, origin);
                             return built;
                           });
}

SceneBuilder::Built SceneBuilder::make(const CheckedNode& node, std::span<const Built> over) {
  std::vector<NodeId> children;
  for (const Built& child : over) children.push_back(child.id);
  if (node.formula && !holds_in_float(*node.formula, diagnostics_)) {
    children.push_back(scene_.graph.add(Kind::Constant, std::array<double, 1>{1.0}, {}));  // placeholder
  } else if (node.formula) {
    children.push_back(make_formula(scene_.graph, *node.formula, node.name));
  }
  const bool painted = !over.empty() && std::all_of(over.begin(), over.end(), std::mem_fn(&Built::painted));
  const NodeId id = scene_.graph.add(node.kind, node.params, children, {node.span, node.name});
  if (type_spans_.size() <= id) type_spans_.resize(id + 1);
  if (type_spans_[id].end == 0) type_spans_[id] = node.type_span;
  Built built{id, painted};
  // A combinator with one child is that child.
  if (spec(node.kind).category == Category::Combinator && over.size() == 1) {
    built.placements = over[0].placements;
    built.placements.push_back(id);
  }
  return built;
}

void SceneBuilder::transform(Built& built, std::span<const double> params, const SourceLocation& origin) {
  const NodeId children[] = {built.id};
  built.id = scene_.graph.add(Kind::Transform, params, children, origin);
  built.placements.push_back(built.id);
}

void SceneBuilder::paint(Built& built, Context context, const SourceLocation& origin) {
  if (!context.material) {
    if (!default_material_) {
      default_material_ = static_cast<std::uint32_t>(materials_.size());
      materials_.emplace_back().name = "default";
      placed_.push_back(false);
    }
    context.material = default_material_;
  }
  const auto number = static_cast<std::uint32_t>(surfaces_.size());
  const auto [found, is_new] = surface_numbers_.emplace(std::pair(context.object, *context.material), number);
  const bool placed = is_placed(context.material);
  if (is_new) {
    surfaces_.push_back({.name = object_names_[context.object], .material = *context.material, .placed = placed});
  }
  const double params[] = {static_cast<double>(found->second)};
  const auto add = [&](NodeId child) {
    return scene_.graph.add(Kind::Paint, params, std::array<NodeId, 1>{child}, origin);
  };
  built.painted = true;
  if (!placed || built.placements.empty()) {
    built.id = add(built.id);
    return;
  }
  built.id = add(scene_.graph.children(built.placements[0])[0]);
  for (NodeId& placement : built.placements) {
    const std::span<const double> old = scene_.graph.params(placement);
    const std::vector<double> own(old.begin(), old.end());
    const SourceLocation place = scene_.graph.origin(placement);
    placement = scene_.graph.add(scene_.graph.kind(placement), own, std::array<NodeId, 1>{built.id}, place);
    built.id = placement;
  }
}

std::string SceneBuilder::unique_name(const CheckedNode& node) {
  const std::string wanted = node.name.empty() ? node.word : node.name;
  std::string name = wanted;
  int& count = name_counts_[wanted];
  do {
    if (++count > 1) name = fmt::format("{} {}", wanted, count);
  } while (!taken_names_.insert(name).second);
  return name;
}

}  // namespace fathom::compiler
