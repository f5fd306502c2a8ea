// Rows of the alterations that change a child's distance, or place the child without bending space: round, onion,
// extrude, transform and similar nodes. domain.cpp and repetition.cpp have those that fold, bend or repeat space.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "compiler/geometry/affine.h"
#include "compiler/shapes/revolve.h"
#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

NodeFacts know_round(Params params, std::span<const NodeFacts> children) {
  NodeFacts k = offset(children[0], params[0]);
  k.inside = std::max(k.inside, Exactness::Bound);
  return k;
}

NodeFacts know_onion(Params params, std::span<const NodeFacts> children) {
  NodeFacts k = offset(children[0], params[0]);
  k.outside = std::max(k.outside, children[0].inside);
  k.inside = std::max(k.inside, Exactness::Bound);
  return k;
}

NodeFacts know_complement(Params, std::span<const NodeFacts> children) {
  NodeFacts k = children[0];
  std::swap(k.outside, k.inside);
  k.box = Box::everything();
  return k;
}

NodeFacts know_same(Params, std::span<const NodeFacts> children) { return children[0]; }

NodeFacts know_scaled(Params params, std::span<const NodeFacts> children) {
  NodeFacts k = only_bound(children[0]);
  k.lipschitz *= params[0];
  if (std::abs(k.lipschitz - 1) < 1e-12) k.lipschitz = 1;  // the product is 1 except for rounding
  k.reach *= params[0];
  k.reach_max *= params[0];
  k.cancellation *= params[0];
  return k;
}

NodeFacts know_transform(Params params, std::span<const NodeFacts> children) {
  const NodeFacts& child = children[0];
  const Affine to_child = Affine::from_params(params);
  const double factor = params[12];
  const SingularValues s = singular_values(to_child);
  NodeFacts k = mapped(child);
  k.box = image(inverse(to_child), child.box);
  // The translation adds to a point's coordinates in the child's space, but a point near the surface lies within the
  // child's box.
  const glm::dvec3 t = glm::abs(to_child.translation);
  const double cancelled = std::min(std::max({t.x, t.y, t.z}), largest_coordinate(child.box));
  k.cancellation = factor * (cancelled * std::max(1.0, child.lipschitz) + child.cancellation);
  // A product that is 1 except for rounding is 1: the factor is the smallest scale, and the largest stretch its
  // inverse.
  const double slope = factor * s.most;
  k.lipschitz = child.lipschitz * (std::abs(slope - 1) < 1e-12 ? 1 : slope);
  const double reach = std::min(1.0, factor * s.least * (1 + 1e-15));
  k.reach = child.reach * reach;
  k.reach_max = std::max(k.reach, child.reach_max * reach / (is_axis_aligned(to_child) ? 1 : kSqrt3));
  if (s.most - s.least > 1e-12 * s.most) k = only_bound(k);
  // Scaling along the axes keeps a mirror plane unless the translation moves the plane.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    const glm::dvec3 row = to_child.rows[axis];
    const bool own = row[i] != 0 && std::abs(row[i]) == std::abs(row.x) + std::abs(row.y) + std::abs(row.z);
    k.symmetric[axis] = child.symmetric[axis] && own && is_axis_aligned(to_child) && to_child.translation[i] == 0;
  }
  return k;
}

// True if there is a block between the pieces pulled apart, in which the distance to the block's faces adds depth.
bool has_core(Params half_size) { return half_size[0] > 0 && half_size[1] > 0 && half_size[2] > 0; }

// The child's surface, cut at the planes through the origin and pulled apart by the half size along each axis.
NodeFacts know_elongate(Params params, std::span<const NodeFacts> children) {
  const NodeFacts& child = children[0];
  NodeFacts k = child;
  // Exact only if the child's point nearest to any point of the plane lies in the plane, which the compiler does not
  // know.
  k = only_bound(k);
  for (int i = 0; i < 3; ++i) {
    // If the child lies on one side of the plane, a side of its box moves the other way. Distances are measured from
    // this larger box anyway.
    k.box.lo[i] -= params[static_cast<std::size_t>(i)];
    k.box.hi[i] += params[static_cast<std::size_t>(i)];
  }
  if (has_core(params)) k.lipschitz = std::max(1.0, k.lipschitz);
  return k;
}

NodeFacts know_extrude(Params params, std::span<const NodeFacts> children) {
  NodeFacts k = children[0];
  k.box.lo.z = -params[0];
  k.box.hi.z = params[0];
  k.symmetric[2] = true;
  k.lipschitz = std::max(1.0, k.lipschitz);
  return k;
}

NodeFacts know_revolve(Params params, std::span<const NodeFacts> children) {
  const NodeFacts& child = children[0];
  NodeFacts k = child;
  const double radius = std::max(0.0, child.box.hi.x + params[0]);
  k.cancellation += std::min(std::abs(params[0]), largest_coordinate(child.box));
  k.box.lo.x = k.box.lo.z = -radius;
  k.box.hi.x = k.box.hi.z = radius;
  k.symmetric = {true, child.symmetric[1], true};
  const bool exact = params[1] != 0;
  return exact ? k : only_bound(k);
}

Code round_code(Params params) { return {.after = {{Opcode::Offset, {params[0]}}}}; }
Code onion_code(Params params) { return {.after = {{Opcode::Onion, {params[0]}}}}; }
Code complement_code(Params) { return {.after = {{Opcode::Negate}}}; }
Code scaled_code(Params params) { return {.after = {{Opcode::Scale, {params[0]}}}}; }
Code paint_code(Params params) { return {.after = {{Opcode::Tag, {}, static_cast<std::uint32_t>(params[0])}}}; }

Code transform_code(Params params) {
  const Affine map = Affine::from_params(params);
  const Affine identity{{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}, glm::dvec3(0)};
  Code code;
  if (map.rows == identity.rows) {
    code.points = {{{Opcode::Translate, {-map.translation.x, -map.translation.y, -map.translation.z}}}};
  } else {
    const auto twelve = map.params();
    code.points = {{{Opcode::Affine, {twelve.begin(), twelve.end()}}}};
  }
  if (params[12] != 1) code.after = {{Opcode::Scale, {params[12]}}};
  return code;
}

// In the middle block of a body pulled apart along all axes the distance is the child's at the origin, to which the
// distance to the block's faces adds depth.
Code elongate_code(Params params) {
  Code code{.points = {{{Opcode::Elongate, {params[0], params[1], params[2]}}}}};
  if (has_core(params)) {
    code.after = {{Opcode::Core, {params[0], params[1], params[2]}}, {Opcode::Deepen}};
  }
  return code;
}

Code extrude_code(Params params) { return {.after = {{Opcode::Slab, {params[0]}}, {Opcode::Meet}}}; }
Code revolve_code(Params params) { return {.points = {{{Opcode::Revolve, {params[0]}}}}}; }

ErrorText check_elongate(Params params) {
  if (params[0] == 0 && params[1] == 0 && params[2] == 0) {
    return "`half_size` is 0 along every axis, which changes nothing; leave the elongate out";
  }
  if (params[0] >= 0 && params[1] >= 0 && params[2] >= 0) return std::nullopt;
  return "`half_size` holds a negative number; give how far to pull apart along each axis, 0 or more";
}

}  // namespace

std::vector<NodeSpec> alteration_rows() {
  constexpr auto kAlteration = Category::Alteration;
  return {
      {.kind = Kind::Round,
       .name = "round",
       .category = kAlteration,
       .params = {length_or_zero("radius", "how far the surface moves out")},
       .doc = "a node made larger, its edges round",
       .code = round_code,
       .derive_facts = know_round},
      {.kind = Kind::Onion,
       .name = "onion",
       .category = kAlteration,
       .params = {thickness()},
       .doc = "a shell around a node's surface",
       .code = onion_code,
       .derive_facts = know_onion},
      {.kind = Kind::Complement,
       .name = "complement",
       .category = kAlteration,
       .doc = "what is not in the node",
       .code = complement_code,
       .derive_facts = know_complement},
      {.kind = Kind::Elongate,
       .name = "elongate",
       .category = kAlteration,
       .params = {{"half_size", ParamType::Vec3, Rule::Any, kRequired, "how far along each axis, 0 or more"}},
       .doc = "a node cut in the middle and pulled apart",
       .check = check_elongate,
       .code = elongate_code,
       .derive_facts = know_elongate},
      {.kind = Kind::Extrude,
       .name = "extrude",
       .category = kAlteration,
       .params = {length("half_depth", "along z")},
       .doc = "an outline drawn along z",
       .operand = Sort::Outline,
       .code = extrude_code,
       .derive_facts = know_extrude},
      {.kind = Kind::Revolve,
       .name = "revolve",
       .category = kAlteration,
       .params = {number("offset", "how far the outline is moved along x before it turns", 0.0)},
       .doc = "an outline turned about the y axis",
       .operand = Sort::Outline,
       .code = revolve_code,
       .derive_facts = know_revolve,
       .build = build_revolve},
      {.kind = Kind::Transform,
       .name = "transform",
       .category = Category::Internal,
       .doc = "scale, rotate, translate",
       .code = transform_code,
       .derive_facts = know_transform},
      {.kind = Kind::Scaled,
       .name = "scaled",
       .category = Category::Internal,
       .doc = "a distance made one that changes no faster than the way walked",
       .code = scaled_code,
       .derive_facts = know_scaled},
      {.kind = Kind::Paint,
       .name = "paint",
       .category = Category::Internal,
       .doc = "belongs to a surface",
       .code = paint_code,
       .derive_facts = know_same},
  };
}

}  // namespace fathom::compiler
