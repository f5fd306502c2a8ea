// Rows of the combinators. Hard combinators keep the distances that they choose from. The gradient of a blend is a
// convex combination of its operands' gradients, so a blend changes no faster than its operands unless its row says
// otherwise.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

NodeFacts know_union(Params, std::span<const NodeFacts> children) {
  NodeFacts k = together(children);
  for (const NodeFacts& child : children) k.box = unite(k.box, child.box);
  if (children.size() > 1) k.inside = std::max(k.inside, Exactness::Bound);
  return k;
}

NodeFacts know_intersection(Params, std::span<const NodeFacts> children) {
  NodeFacts k = only_bound(together(children));
  for (const NodeFacts& child : children) k.box = intersect(k.box, child.box);
  // Disjoint operands leave nothing, but an offset of the field may leave something, so keep a box to measure from.
  if (k.box.empty()) k.box = children[0].box;
  k.reach /= kSqrt3;  // an intersection's corner is up to sqrt 3 further than its faces
  return k;
}

NodeFacts know_subtraction(Params, std::span<const NodeFacts> children) {
  NodeFacts k = only_bound(together(children));
  const NodeFacts& base = children[0];  // a subtraction only cuts away: the base's box and reach hold
  k.box = base.box;
  k.reach = base.reach;
  k.reach_max = base.reach_max;
  return k;
}

// Facts of a blend of width `width`: the operands' distances count up to that width.
NodeFacts blended(NodeFacts k, double width) {
  k.cancellation += width;
  return only_bound(k);
}

// Returns a bound on how far a blend lowers the distance: by `deepest` * k per operand after the first, and by k in
// all, because an operand k away changes nothing.
double lowered(Params params, std::size_t operands, double deepest) {
  return std::min(params[0], deepest * params[0] * static_cast<double>(operands - 1));
}

NodeFacts know_smooth_union(Params params, std::span<const NodeFacts> children) {
  return blended(offset(know_union(params, children), lowered(params, children.size(), 0.25)), params[0]);
}
NodeFacts know_smooth_intersection(Params params, std::span<const NodeFacts> children) {
  return blended(know_intersection(params, children), params[0]);
}
NodeFacts know_smooth_subtraction(Params params, std::span<const NodeFacts> children) {
  return blended(know_subtraction(params, children), params[0]);
}

// A chamfer, (a + b - k) / 2, is at least min(a, b) - k/2. A round or a stair dips by less.
NodeFacts know_edge_union(Params params, std::span<const NodeFacts> children) {
  return blended(offset(know_union(params, children), lowered(params, children.size(), 0.5)), params[0]);
}
// The gradients of two nearly parallel surfaces add up under the square root.
NodeFacts steeper(NodeFacts k, std::size_t operands) {
  for (std::size_t i = 1; i < operands; ++i) k.lipschitz *= kSqrt2;
  return k;
}
NodeFacts know_round_union(Params params, std::span<const NodeFacts> children) {
  return steeper(know_edge_union(params, children), params[0] > kMinBlend ? children.size() : 1);
}
NodeFacts know_round_intersection(Params params, std::span<const NodeFacts> children) {
  return steeper(know_smooth_intersection(params, children), params[0] > kMinBlend ? children.size() : 1);
}
NodeFacts know_round_subtraction(Params params, std::span<const NodeFacts> children) {
  return steeper(know_smooth_subtraction(params, children), params[0] > kMinBlend ? children.size() : 1);
}

// Outside the operands, xor is the union of the points in one operand alone, which is exact because its boundaries
// are those of the operands. The facts claim only a bound.
NodeFacts know_xor(Params params, std::span<const NodeFacts> children) {
  return only_bound(know_union(params, children));
}

NodeFacts know_morph(Params, std::span<const NodeFacts> children) {
  NodeFacts k = only_bound(together(children));
  for (const NodeFacts& child : children) k.box = unite(k.box, child.box);
  return k;
}

ErrorText check_two(Params, std::span<const NodeFacts> children) {
  if (children.size() == 2) return std::nullopt;
  return "it goes from one node to another; give exactly two in `of`";
}

ErrorText check_morph(Params params) {
  if (params[0] >= 0 && params[0] <= 1) return std::nullopt;
  return fmt::format("`t` is {}; it must be between 0 and 1", params[0]);
}

Code any_order(Opcode opcode) {
  Code code = one(opcode, {});
  code.any_order = true;
  return code;
}
Code union_code(Params) { return any_order(Opcode::Min); }
Code intersection_code(Params) { return any_order(Opcode::Max); }
// a - b is the intersection of a with the complement of b. With b first: max(-b, a).
Code subtraction_code(Params) {
  return {.after = {{Opcode::Subtract}}, .swapped_first = {{Opcode::Negate}}, .swapped_join = {{Opcode::Max}}};
}

// A width of 0 blends nothing. The optimiser replaces the node by the hard operator, but unoptimised code must not
// divide by the width.
std::vector<double> blend_immediates(Params params) {
  return {params[0], params[0] > kMinBlend ? 0.25 / params[0] : 0};
}
Code smooth_subtraction_code(Params params) {
  Code code = code_of<Opcode::SmoothSubtract, blend_immediates>(params);
  code.swapped_first = {{Opcode::Negate}};
  code.swapped_join = {{Opcode::SmoothMax, blend_immediates(params)}};
  return code;
}

// Returns the instructions of an edge, which is the hard operator if the width is 0.
template <Opcode Join, Opcode Hard, std::vector<double> (*Immediates)(Params)>
std::vector<Instruction> edge(Params params) {
  if (!(params[0] > kMinBlend)) return {{Hard}};
  return {{Join, Immediates(params)}};
}
std::vector<double> same(Params params) { return {params.begin(), params.end()}; }
std::vector<double> stairs_immediates(Params params) {
  const double step = params[0] / params[1];
  return {params[0], step, 0.5 / step};
}

template <Opcode Join, std::vector<double> (*Immediates)(Params)>
Code edge_union_code(Params params) {
  return {.after = edge<Join, Opcode::Min, Immediates>(params)};
}
template <Opcode Join, std::vector<double> (*Immediates)(Params)>
Code edge_intersection_code(Params params) {
  return {.after = edge<Join, Opcode::Max, Immediates>(params)};
}
template <Opcode Join, std::vector<double> (*Immediates)(Params)>
Code edge_subtraction_code(Params params) {
  Code code{.after = edge<Join, Opcode::Max, Immediates>(params)};
  code.after.insert(code.after.begin(), {Opcode::Negate});
  return code;
}

Code xor_code(Params) { return any_order(Opcode::Xor); }
Code morph_code(Params params) { return code_of<Opcode::Mix, same>(params); }

NodeSpec combinator(Kind kind, std::string_view name, std::vector<ParamSpec> params, std::string_view doc,
                    Code (*code)(Params), NodeFacts (*derive_facts)(Params, std::span<const NodeFacts>)) {
  return {.kind = kind,
          .name = name,
          .category = Category::Combinator,
          .params = std::move(params),
          .doc = doc,
          .code = code,
          .derive_facts = derive_facts};
}

}  // namespace

std::vector<NodeSpec> combinator_rows() {
  const ParamSpec width = length_or_zero("radius", "how far from the edge the surfaces are cut");
  const ParamSpec steps{"steps", ParamType::Integer, Rule::Positive, 4.0, "number of steps, 1 or more"};
  std::vector<NodeSpec> rows = {
      combinator(Kind::Union, "union", {}, "what is in any of the nodes", union_code, know_union),
      combinator(Kind::Intersection, "intersection", {}, "what is in all of the nodes", intersection_code,
                 know_intersection),
      combinator(Kind::Subtraction, "subtraction", {}, "the first node without the others", subtraction_code,
                 know_subtraction),
      combinator(Kind::Xor, "xor", {}, "what is in an odd number of the nodes", xor_code, know_xor),
      combinator(Kind::SmoothUnion, "smooth_union", {blend_width()}, "union, blended from the left",
                 code_of<Opcode::SmoothMin, blend_immediates>, know_smooth_union),
      combinator(Kind::SmoothIntersection, "smooth_intersection", {blend_width()},
                 "intersection, blended from the left", code_of<Opcode::SmoothMax, blend_immediates>,
                 know_smooth_intersection),
      combinator(Kind::SmoothSubtraction, "smooth_subtraction", {blend_width()}, "subtraction, blended from the left",
                 smooth_subtraction_code, know_smooth_subtraction),
      combinator(Kind::ChamferUnion, "chamfer_union", {width}, "union, its inner edges filled at 45 degrees",
                 edge_union_code<Opcode::ChamferMin, same>, know_edge_union),
      combinator(Kind::ChamferIntersection, "chamfer_intersection", {width},
                 "intersection, its edges cut off at 45 degrees", edge_intersection_code<Opcode::ChamferMax, same>,
                 know_smooth_intersection),
      combinator(Kind::ChamferSubtraction, "chamfer_subtraction", {width},
                 "subtraction, its edges cut off at 45 degrees", edge_subtraction_code<Opcode::ChamferMax, same>,
                 know_smooth_subtraction),
      combinator(Kind::RoundUnion, "round_union", {width}, "union, its inner edges filled with a quarter circle",
                 edge_union_code<Opcode::RoundMin, same>, know_round_union),
      combinator(Kind::RoundIntersection, "round_intersection", {width},
                 "intersection, its edges rounded to a quarter circle",
                 edge_intersection_code<Opcode::RoundMax, same>, know_round_intersection),
      combinator(Kind::RoundSubtraction, "round_subtraction", {width},
                 "subtraction, its edges rounded to a quarter circle", edge_subtraction_code<Opcode::RoundMax, same>,
                 know_round_subtraction),
      combinator(Kind::StairsUnion, "stairs_union", {width, steps}, "union, its inner edges filled with stairs",
                 edge_union_code<Opcode::StairsMin, stairs_immediates>, know_edge_union),
      combinator(Kind::StairsIntersection, "stairs_intersection", {width, steps},
                 "intersection, its edges cut to stairs",
                 edge_intersection_code<Opcode::StairsMax, stairs_immediates>, know_smooth_intersection),
      combinator(Kind::StairsSubtraction, "stairs_subtraction", {width, steps},
                 "subtraction, its edges cut to stairs", edge_subtraction_code<Opcode::StairsMax, stairs_immediates>,
                 know_smooth_subtraction),
      combinator(Kind::Morph, "morph", {number("t", "0: the first node, 1: the second")},
                 "between two nodes: their distances mixed", morph_code, know_morph),
  };
  rows.back().check = check_morph;
  rows.back().check_children = check_two;
  return rows;
}

}  // namespace fathom::compiler
