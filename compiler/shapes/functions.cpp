// Rows of the functions of numbers that formulas consist of, and of the nodes that make a distance of a formula. The
// names here are those of listings. compiler/frontend/formula/formula_functions.cpp has the spelling of formulas.
#include <algorithm>
#include <limits>
#include <utility>

#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

// The compiler knows no facts about a single number, but proves facts about a formula as a whole
// (compiler/derive/formula_field.h).
Knowledge know_number(Params, std::span<const Knowledge>) {
  Knowledge k;
  k.box = Box::everything();
  k.lipschitz = std::numeric_limits<double>::infinity();
  k.outside = k.inside = Exactness::Estimate;
  k.certified = false;
  k.reach = k.reach_max = 0;
  return k;
}

template <Opcode Op>
Code commutative(Params) {
  Code code;
  code.after = {{Op}};
  code.swapped_join = code.after;
  return code;
}
// a - b equals -b + a, to the last bit.
Code minus_code(Params) {
  return {.after = {{Opcode::Minus}}, .swapped_first = {{Opcode::Negate}}, .swapped_join = {{Opcode::Add}}};
}

template <Opcode Op>
Code all_at_once(Params) {
  Code code;
  code.after = {{Op}};
  code.all_at_once = true;
  return code;
}

NodeSpec function(Kind kind, std::string_view name, Code (*code)(Params), std::string_view doc,
                  std::vector<ParamSpec> params = {}) {
  return {.kind = kind,
          .name = name,
          .category = Category::Function,
          .params = std::move(params),
          .doc = doc,
          .sort = Sort::Number,
          .operand = Sort::Number,
          .code = code,
          .know = know_number};
}

// Bounded. Derived: the box's corners, the Lipschitz constant within the box, the magnitude of the float error, 1 if
// the constant is proved.
Knowledge know_bounded(Params p, std::span<const Knowledge>) {
  Knowledge k;
  constexpr double kEndless = 1e18, kInfinity = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    k.box.lo[i] = p[axis] <= -kEndless ? -kInfinity : p[axis];
    k.box.hi[i] = p[axis + 3] >= kEndless ? kInfinity : p[axis + 3];
  }
  k.lipschitz = p[6];
  k.magnitude = p[7];
  k.certified = p[8] == 1;
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

}  // namespace

std::vector<NodeSpec> function_rows() {
  const ParamSpec value = number("value", "a number");
  return {
      function(Kind::X, "x", code_of<Opcode::X>, "the point's x"),
      function(Kind::Y, "y", code_of<Opcode::Y>, "the point's y"),
      function(Kind::Z, "z", code_of<Opcode::Z>, "the point's z"),
      function(Kind::Constant, "constant", code_of<Opcode::Constant>, "a number", {value}),
      function(Kind::Negate, "negate", code_of<Opcode::Negate>, "-a"),
      function(Kind::Abs, "abs", code_of<Opcode::Abs>, "a without its sign"),
      function(Kind::Square, "square", code_of<Opcode::Square>, "a times a"),
      function(Kind::Sqrt, "sqrt", code_of<Opcode::Sqrt>, "the square root"),
      function(Kind::Sin, "sin", code_of<Opcode::Sin>, "the sine, a in radians"),
      function(Kind::Cos, "cos", code_of<Opcode::Cos>, "the cosine, a in radians"),
      function(Kind::Tan, "tan", code_of<Opcode::Tan>, "the tangent, a in radians"),
      function(Kind::Asin, "asin", code_of<Opcode::Asin>, "the angle whose sine is a, radians"),
      function(Kind::Acos, "acos", code_of<Opcode::Acos>, "the angle whose cosine is a, radians"),
      function(Kind::Atan, "atan", code_of<Opcode::Atan>, "the angle whose tangent is a, radians"),
      function(Kind::Exp, "exp", code_of<Opcode::Exp>, "e to the power of a"),
      function(Kind::Log, "log", code_of<Opcode::Log>, "the natural logarithm"),
      function(Kind::Floor, "floor", code_of<Opcode::Floor>, "the largest whole number up to a"),
      function(Kind::Ceil, "ceil", code_of<Opcode::Ceil>, "the smallest whole number from a"),
      function(Kind::Nearest, "nearest", code_of<Opcode::Nearest>, "the nearest whole number, the even one of two"),
      function(Kind::Sign, "sign", code_of<Opcode::Sign>, "-1, 0 or 1"),
      function(Kind::Not, "not", code_of<Opcode::Not>, "1 where a is 0, else 0"),
      function(Kind::Add, "add", commutative<Opcode::Add>, "a + b"),
      function(Kind::Minus, "minus", minus_code, "a - b"),
      function(Kind::Multiply, "multiply", commutative<Opcode::Multiply>, "a times b"),
      function(Kind::Divide, "divide", code_of<Opcode::Divide>, "a divided by b"),
      function(Kind::Modulo, "modulo", code_of<Opcode::Modulo>, "a - b floor(a / b)"),
      function(Kind::ModuloEuclid, "modulo_euclid", code_of<Opcode::ModuloEuclid>, "what is left of a, at least 0"),
      function(Kind::Minimum, "min", commutative<Opcode::Min>, "the lesser of a and b"),
      function(Kind::Maximum, "max", commutative<Opcode::Max>, "the greater of a and b"),
      function(Kind::Atan2, "atan2", code_of<Opcode::Atan2>, "the angle of the point (b, a), radians"),
      function(Kind::Power, "power", code_of<Opcode::Power>, "a to the power of b"),
      function(Kind::Compare, "compare", code_of<Opcode::Compare>, "-1, 0 or 1 as a is less than, equal to, above b"),
      function(Kind::And, "and", code_of<Opcode::And>, "b where a is not 0, else a"),
      function(Kind::Or, "or", code_of<Opcode::Or>, "a where it is not 0, else b"),
      function(Kind::Step, "step", code_of<Opcode::Step>, "0 where b is less than a, else 1"),
      function(Kind::Noise, "noise", all_at_once<Opcode::Noise>, "gradient noise at the point (a, b, c)"),
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
       .code = [](Params) { return one(Opcode::Add, {}); },
       .know = know_number},
      {.kind = Kind::Bounded,
       .name = "bounded",
       .category = Category::Internal,
       .doc = "a formula within its box, made a distance",
       .operand = Sort::Number,
       .code = bounded_code,
       .know = know_bounded},
  };
}

}  // namespace fathom::compiler
