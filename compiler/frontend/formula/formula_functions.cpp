#include "compiler/frontend/formula/formula_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::compiler {
namespace {

using Arguments = std::span<const FormulaId>;

// Machine functions that formulas spell differently. An empty spelling means that formulas write an operator.
struct Spelling {
  std::string_view machine, formula;
};
constexpr Spelling kSpellings[] = {
    {"add", ""},    {"minus", ""}, {"multiply", ""},     {"divide", ""},
    {"negate", ""}, {"power", ""}, {"nearest", "round"}, {"modulo", "mod"},
};

FormulaId clamp(const FormulaMaker& make, FormulaId v, FormulaId lo, FormulaId hi) {
  return make("min", {make("max", {v, lo}), hi});
}

FormulaId expand_clamp(const FormulaMaker& make, Arguments a) { return clamp(make, a[0], a[1], a[2]); }

FormulaId expand_mix(const FormulaMaker& make, Arguments a) {
  return make("add", {a[0], make("multiply", {make("minus", {a[1], a[0]}), a[2]})});
}

// t^2 (3 - 2t) with t from 0 at the first edge to 1 at the second: Hermite's cubic, as in GLSL.
FormulaId expand_smoothstep(const FormulaMaker& make, Arguments a) {
  const FormulaId part = make("divide", {make("minus", {a[2], a[0]}), make("minus", {a[1], a[0]})});
  const FormulaId t = clamp(make, part, make(0.0), make(1.0));
  return make("multiply", {make("square", {t}), make("minus", {make(3.0), make("multiply", {make(2.0), t})})});
}

FormulaId expand_length(const FormulaMaker& make, Arguments a) {
  FormulaId sum = make("square", {a[0]});
  for (const FormulaId v : a.subspan(1)) sum = make("add", {sum, make("square", {v})});
  return make("sqrt", {sum});
}

FormulaId expand_pow(const FormulaMaker& make, Arguments a) { return make.builder.power(a[0], a[1], make.span); }

FormulaId expand_tan(const FormulaMaker& make, Arguments a) {
  if (make.builder.value(a[0])) return make("tan", {a[0]});
  return make("divide", {make("sin", {a[0]}), make("cos", {a[0]})});
}

// Fractional Brownian motion (Mandelbrot & Van Ness, 1968), approximated by the sum of noise(2^k p + c_k) / 2^k. The
// noise is zero at whole coordinates. The offsets c_k are 0 for k = 0 and (2 k + 1) c otherwise, where c has odd
// sixteenths. They keep the zeros of different octaves apart: if 2^j p + c_j is whole, 2^k p + c_k is an odd number
// of sixteenths off.
FormulaId expand_fbm(const FormulaMaker& make, Arguments a) {
  constexpr double kApart[] = {37.0 / 16, 55.0 / 16, 91.0 / 16};
  FormulaId sum = make("noise", {a[0], a[1], a[2]});
  const int octaves = static_cast<int>(*make.builder.value(a[3]));
  for (int k = 1; k < octaves; ++k) {
    const FormulaId scale = make(std::ldexp(1.0, k));
    const auto moved = [&](std::size_t axis) {
      return make("add", {make("multiply", {a[axis], scale}), make((2 * k + 1) * kApart[axis])});
    };
    const FormulaId octave = make("noise", {moved(0), moved(1), moved(2)});
    sum = make("add", {sum, make("multiply", {octave, make(std::ldexp(1.0, -k))})});
  }
  return sum;
}
constexpr int kMaxOctaves = 12;

constexpr FormulaFunction kDerived[] = {
    {"clamp", 3, 3, "", expand_clamp},            // value, minimum, maximum
    {"mix", 3, 3, "", expand_mix},                // a (result at t = 0), b (result at t = 1), t
    {"smoothstep", 3, 3, "", expand_smoothstep},  // edge where the result is 0, edge where it is 1, value
    {"length", 2, 3, "", expand_length},
    {"hypot", 2, 3, "", expand_length},
    {"pow", 2, 2, "", expand_pow},
    {"tan", 1, 1, "", expand_tan},
    {"fbm", 4, 4, "", expand_fbm, kMaxOctaves},  // x, y, z, octaves
};

}  // namespace

std::string FormulaFunction::misfit_of(std::optional<double> last) const {
  if (max_times == 0 || (last && *last >= 1 && *last <= max_times && *last == std::floor(*last))) return "";
  return fmt::format("the last argument of `{}` is a whole number from 1 to {}, not {}", name, max_times,
                     last ? fmt::format("{}", *last) : "one that varies");
}

FormulaId FormulaFunction::call(FormulaBuilder& builder, std::span<const FormulaId> arguments, Span span) const {
  return expand ? expand({builder, span}, arguments) : builder.call(basic, arguments, span);
}

std::vector<FormulaFunction> formula_functions(std::span<const FunctionSpec> machine) {
  std::vector<FormulaFunction> out;
  for (const FunctionSpec& function : machine) {
    const auto other = std::find_if(std::begin(kSpellings), std::end(kSpellings),
                                    [&](const Spelling& row) { return row.machine == function.name; });
    const std::string_view name = other == std::end(kSpellings) ? function.name : other->formula;
    const auto arity = static_cast<std::size_t>(function.arity);
    if (!name.empty()) out.push_back({name, arity, arity, function.name});
  }
  const auto basic = out.size();
  for (const FormulaFunction& function : kDerived) {
    const auto end = out.begin() + static_cast<std::ptrdiff_t>(basic);
    const auto same = [&](const FormulaFunction& known) { return known.name == function.name; };
    if (std::none_of(out.begin(), end, same)) out.push_back(function);
  }
  return out;
}

}  // namespace fathom::compiler
