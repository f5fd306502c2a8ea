// Helpers that the files of rows share: makers of parameters and code, and facts about nodes composed of others.
#pragma once

#include <array>
#include <vector>

#include "compiler/shapes/node_spec.h"

namespace fathom::compiler {

inline constexpr double kSqrt2 = 1.4142135623730951, kSqrt3 = 1.7320508075688772, kSqrt6 = 2.4494897427831781;

std::vector<NodeSpec> solid_rows();
std::vector<NodeSpec> polyhedron_rows();
std::vector<NodeSpec> fractal_rows();
std::vector<NodeSpec> composed_rows();
std::vector<NodeSpec> outline_rows();
std::vector<NodeSpec> round_outline_rows();
std::vector<NodeSpec> alteration_rows();
std::vector<NodeSpec> domain_rows();
std::vector<NodeSpec> repetition_rows();
std::vector<NodeSpec> combinator_rows();
std::vector<NodeSpec> function_rows();

inline constexpr auto kPrimitive = Category::Primitive;
inline constexpr std::optional<double> kRequired = std::nullopt;

// Makers of parameters: a length above 0, a length of at least 0, any number, half extents, a corner, a thickness, a
// blend's width.
ParamSpec length(std::string_view name, std::string_view doc, std::optional<double> fallback = kRequired);
ParamSpec length_or_zero(std::string_view name, std::string_view doc, std::optional<double> fallback = kRequired);
ParamSpec number(std::string_view name, std::string_view doc, std::optional<double> fallback = kRequired);
ParamSpec half_size(std::string_view doc);
ParamSpec corner(std::string_view name);
ParamSpec thickness();
ParamSpec blend_width();

// Returns code of one instruction, which takes two operands in either order if the opcode's row says that they
// commute.
Code one(vm::Opcode opcode, std::vector<double> immediates);
// Returns code of one instruction, whose immediates are the parameters or the result of `Immediates`.
template <vm::Opcode Op>
Code code_of(Params params) {
  return one(Op, {params.begin(), params.end()});
}
template <vm::Opcode Op, std::vector<double> (*Immediates)(Params)>
Code code_of(Params params) {
  return one(Op, Immediates(params));
}

// Returns the immediates of a straight side from (bottom, -half_height) to (top, half_height), of a cone or a
// trapezoid: the sizes, the side's outward normal, the side's length.
std::vector<double> slanted_profile(double bottom, double top, double half_height);
// Returns the immediates of a side that touches two balls or disks, whose radii and distance are the parameters: the
// parameters, then the side's outward normal.
std::vector<double> round_profile(Params params);

// Returns the largest magnitude of a coordinate in the box: infinite if the box has no end, 0 if it is empty.
double largest_coordinate(const Box& box);
// Returns the cancellation of an outline whose parts are evaluated from points as far away as its box reaches in the
// plane.
template <Box (*Bound)(Params)>
double outline_magnitude(Params params) {
  Box box = Bound(params);
  box.lo.z = box.hi.z = 0;
  return largest_coordinate(box);
}

inline constexpr std::array<bool, 3> kAllAxes = {true, true, true}, kXAndZ = {true, false, true};
inline constexpr PrimitiveFacts kSymmetric{.symmetric = kAllAxes}, kUpright{.symmetric = kXAndZ};

// Combines the facts of several children by taking the worst of each: Lipschitz constants, certificates, reach and
// symmetry. The caller sets the box and the exactness inside.
NodeFacts together(std::span<const NodeFacts> children);
// Returns the facts of the surface moved out by `by`.
NodeFacts offset(NodeFacts k, double by);
// Returns the facts without exactness: at best a bound.
NodeFacts only_bound(NodeFacts k);
// Returns the facts of a node that maps its child's point, for which no symmetry is known.
NodeFacts mapped(NodeFacts k);

}  // namespace fathom::compiler
