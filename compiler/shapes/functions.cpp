// Rows of the functions of numbers that formulas consist of, and of the nodes that make a distance of a formula. The
// names here are those of listings. compiler/frontend/formula/formula_functions.cpp has the spelling of formulas.
#include <algorithm>
#include <limits>
#include <utility>

#include "compiler/shapes/rows.h"
#include "vm/program/opcode_rows.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

// The compiler knows no facts about a single number, but proves facts about a formula as a whole
// (compiler/derive/formula_field.h).
NodeFacts know_number(Params, std::span<const NodeFacts>) {
  NodeFacts k;
  k.box = Box::everything();
  k.lipschitz = std::numeric_limits<double>::infinity();
  k.outside = k.inside = Exactness::Estimate;
  k.certified = false;
  k.reach = k.reach_max = 0;
  return k;
}

template <Opcode Op>
Code function_code(Params params) {
  Code code = code_of<Op>(params);
  // a - b equals -b + a, to the last bit.
  if (Op == Opcode::Minus) code.swapped_first = {{Opcode::Negate}}, code.swapped_join = {{Opcode::Add}};
  code.all_at_once = vm::info(Op).form == vm::Form::Ternary;
  return code;
}

template <Opcode Op>
NodeSpec function(Kind kind, std::string_view name, std::string_view doc, std::vector<ParamSpec> params = {}) {
  return {.kind = kind,
          .name = name,
          .category = Category::Function,
          .params = std::move(params),
          .doc = doc,
          .sort = Sort::Number,
          .commutes = vm::has(Op, vm::Fact::Commutes),
          .operand = Sort::Number,
          .code = function_code<Op>,
          .derive_facts = know_number};
}

// Bounded. Derived: the box's corners, the Lipschitz constant within the box, the scale of the float error, and the
// constant's FormulaProof (compiler/derive/formula_field.h), of which 1 and 3 hold in the whole box.
NodeFacts know_bounded(Params p, std::span<const NodeFacts>) {
  NodeFacts k;
  constexpr double kEndless = 1e18, kInfinity = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    k.box.lo[i] = p[axis] <= -kEndless ? -kInfinity : p[axis];
    k.box.hi[i] = p[axis + 3] >= kEndless ? kInfinity : p[axis + 3];
  }
  k.lipschitz = p[6];
  k.cancellation = p[7];
  k.certified = p[8] == 1 || p[8] == 3;
  k.outside = k.inside = k.certified ? Exactness::Bound : Exactness::Estimate;
  k.reach = k.reach_max = std::min(1.0, p[6]);
  return k;
}

Code bounded_code(Params p) {
  const std::vector<double> box(p.begin(), p.begin() + 6);
  Code code{.points = {{{Opcode::ClampBox, box}}}, .after = {{Opcode::BoxBetween, box}}};
  if (p[6] != 1) code.after.push_back({Opcode::Scale, {p[6]}});
  code.after.push_back({Opcode::Meet});
  return code;
}

std::vector<NodeSpec> scalar_rows() {
  return {
      function<Opcode::X>(Kind::X, "x", "the point's x"),
      function<Opcode::Y>(Kind::Y, "y", "the point's y"),
      function<Opcode::Z>(Kind::Z, "z", "the point's z"),
      function<Opcode::Constant>(Kind::Constant, "constant", "a number", {number("value", "a number")}),
#define FUNCTION(Name, name, form, cost, facts, meaning, doc, ...) function<Opcode::Name>(Kind::Name, name, doc),
#define FUNCTION_OF(Name, name, form, opcode, doc, ...) function<Opcode::opcode>(Kind::Name, name, doc),
#include "vm/program/functions.def"
  };
}

std::vector<NodeSpec> field_rows() {
  return {
      {.kind = Kind::Expression,
       .name = "expression",
       .category = Category::Alteration,
       .params = {{"half_size", ParamType::Vec3, Rule::Positive, 10.0,
                   "of the box the formula holds in; the solid ends there"},
                  {"formula", ParamType::Formula, Rule::Any, kRequired,
                   "in x, y and z; the solid is where it is negative"}},
       .doc = "a solid given by a formula",
       .operand = Sort::Number},
      {.kind = Kind::Displacement,
       .name = "displacement",
       .category = Category::Alteration,
       .params = {{"formula", ParamType::Formula, Rule::Any, kRequired,
                   "in x, y and z; added to the node's distance"}},
       .doc = "a node whose surface moves inwards by a formula",
       .operand = Sort::Solid},
      {.kind = Kind::Displaced,
       .name = "displaced",
       .category = Category::Internal,
       .doc = "a node's distance and a formula, added",
       .code = [](Params) { return Code{.after = {{Opcode::Add}}}; },  // in order: the first has the surface
       .derive_facts = know_number},
      {.kind = Kind::Bounded,
       .name = "bounded",
       .category = Category::Internal,
       .doc = "a formula within its box, made a distance",
       .operand = Sort::Number,
       .code = bounded_code,
       .derive_facts = know_bounded},
  };
}

}  // namespace

std::vector<NodeSpec> function_rows() {
  std::vector<NodeSpec> rows = scalar_rows();
  for (NodeSpec& row : field_rows()) rows.push_back(std::move(row));
  return rows;
}

}  // namespace fathom::compiler
