// What the files of rows share: makers of parameters and rows, and what is known of nodes made of others.
#pragma once

#include <array>
#include <vector>

#include "compiler/shapes/node_spec.h"

namespace fathom::compiler {

inline constexpr double kSqrt2 = 1.4142135623730951, kSqrt3 = 1.7320508075688772, kSqrt6 = 2.4494897427831781;

std::vector<NodeSpec> solid_rows();
std::vector<NodeSpec> composed_rows();
std::vector<NodeSpec> outline_rows();
std::vector<NodeSpec> alteration_rows();
std::vector<NodeSpec> domain_rows();
std::vector<NodeSpec> repetition_rows();
std::vector<NodeSpec> combinator_rows();
std::vector<NodeSpec> function_rows();

inline constexpr auto kPrimitive = Category::Primitive;
inline constexpr std::optional<double> kRequired = std::nullopt;

// A length above 0; at least 0; any number; a direction; a point.
ParamSpec length(std::string_view name, std::string_view doc, std::optional<double> fallback = kRequired);
ParamSpec length_or_zero(std::string_view name, std::string_view doc, std::optional<double> fallback = kRequired);
ParamSpec number(std::string_view name, std::string_view doc, std::optional<double> fallback = kRequired);
ParamSpec half_size(std::string_view doc);
ParamSpec corner(std::string_view name);
ParamSpec thickness();
ParamSpec blend_width();

Code one(vm::Opcode opcode, std::vector<double> immediates);
// Code of one instruction with the parameters, or what `Immediates` makes of them, as its immediates.
template <vm::Opcode Op>
Code code_of(Params params) {
  return one(Op, {params.begin(), params.end()});
}
template <vm::Opcode Op, std::vector<double> (*Immediates)(Params)>
Code code_of(Params params) {
  return one(Op, Immediates(params));
}

// The largest coordinate in the box, infinite when it has no end; 0 when it is empty.
double largest_coordinate(const Box& box);
// The magnitude of an outline whose parts are evaluated from points as far off as its box reaches in the plane.
template <Box (*Bound)(Params)>
double outline_magnitude(Params params) {
  Box box = Bound(params);
  box.lo.z = box.hi.z = 0;
  return largest_coordinate(box);
}

inline constexpr std::array<bool, 3> kAllAxes = {true, true, true};
inline constexpr PrimitiveFacts kSymmetric{.symmetric = kAllAxes};

// Lipschitz constants, certificates, reach and symmetry of several children together: the worst of each. Boxes and
// exactness inside are the caller's.
Knowledge together(std::span<const Knowledge> children);
// The surface moved out by `by`.
Knowledge offset(Knowledge k, double by);
// No longer exact.
Knowledge only_bound(Knowledge k);
// Of a node whose child's point is mapped: no symmetry is known any more.
Knowledge mapped(Knowledge k);

}  // namespace fathom::compiler
