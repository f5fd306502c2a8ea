#include "compiler/shapes/rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vm/program/opcode_rows.h"

namespace fathom::compiler {

Code one(vm::Opcode opcode, std::vector<double> immediates) {
  Code code;
  code.after.push_back({opcode, std::move(immediates)});
  if (vm::has(opcode, vm::Fact::Commutes)) code.swapped_join = code.after;
  return code;
}

ParamSpec length(std::string_view name, std::string_view doc, std::optional<double> fallback) {
  return {name, ParamType::Number, Rule::Positive, fallback, doc};
}
ParamSpec length_or_zero(std::string_view name, std::string_view doc, std::optional<double> fallback) {
  return {name, ParamType::Number, Rule::NotNegative, fallback, doc};
}
ParamSpec number(std::string_view name, std::string_view doc, std::optional<double> fallback) {
  return {name, ParamType::Number, Rule::Any, fallback, doc};
}
ParamSpec half_size(std::string_view doc) { return {"half_size", ParamType::Vec3, Rule::Positive, kRequired, doc}; }
ParamSpec corner(std::string_view name) {
  return {name, ParamType::Vec3, Rule::Any, kRequired, "a corner, scene units"};
}
ParamSpec thickness() { return length("thickness", "to either side of the surface"); }
ParamSpec blend_width() { return length_or_zero("k", "width of the blend; the surface moves by at most k/4"); }

std::vector<double> slanted_profile(double bottom, double top, double half_height) {
  const double slant = std::sqrt(4 * half_height * half_height + (bottom - top) * (bottom - top));
  return {half_height, bottom, top, 2 * half_height / slant, (bottom - top) / slant, slant};
}

// The side touches both balls, so its outward normal in the half-plane is (sqrt(1 - b^2), b) with b = (r1 - r2) / h.
std::vector<double> round_profile(Params p) {
  const double b = (p[0] - p[1]) / p[2];
  // Balls that touch from inside (b = +-1) have no side. A normal of not quite 0 keeps the cases apart on the axis.
  return {p[0], p[1], p[2], std::max(1e-30, std::sqrt((1 - b) * (1 + b))), b};
}

double largest_coordinate(const Box& box) {
  if (box.empty()) return 0;
  double largest = 0;
  for (int i = 0; i < 3; ++i) largest = std::max({largest, std::abs(box.lo[i]), std::abs(box.hi[i])});
  return largest;
}

NodeFacts only_bound(NodeFacts k) {
  k.outside = std::max(k.outside, Exactness::Bound);
  k.inside = std::max(k.inside, Exactness::Bound);
  return k;
}

NodeFacts mapped(NodeFacts k) {
  k.symmetric = {false, false, false};
  return k;
}

NodeFacts offset(NodeFacts k, double by) {
  if (by <= 0) return k;
  k.cancellation += by;
  if (!(k.reach_max > 0)) {
    k.box = Box::everything();
    return k;
  }
  k.box = k.box.grown(by / k.reach_max);
  if (k.reach < k.reach_max) k.reach = std::min(k.reach, k.reach_max / kSqrt3);
  return k;
}

NodeFacts together(std::span<const NodeFacts> children) {
  NodeFacts k = children[0];
  for (const NodeFacts& c : children) {
    k.lipschitz = std::max(k.lipschitz, c.lipschitz);
    k.certified = k.certified && c.certified;
    k.reach = std::min(k.reach, c.reach);
    k.reach_max = std::min(k.reach_max, c.reach_max);
    k.outside = std::max(k.outside, c.outside);
    k.inside = std::max(k.inside, c.inside);
    k.cancellation = std::max(k.cancellation, c.cancellation);
    for (std::size_t axis = 0; axis < 3; ++axis) k.symmetric[axis] = k.symmetric[axis] && c.symmetric[axis];
  }
  return k;
}

}  // namespace fathom::compiler
