// Fuzz target for formulas. The input is the text between quotes, as the parser reads it, one line of input per line
// of the formula. A formula of the point is read for the machine, whose value must equal the front end's own
// evaluation in double. A formula without a point is a number.
#include <fmt/format.h>

#include <cmath>

#include "compiler/frontend/formula/formula_evaluate.h"
#include "compiler/frontend/formula/formula_nodes.h"
#include "compiler/frontend/formula/read_formula.h"
#include "compiler/lower/lower.h"
#include "tests/fuzz/check_program.h"
#include "tests/fuzz/target.h"

namespace fathom::fuzz {
namespace {

using compiler::Diagnostics;
using compiler::Formula;
using compiler::Source;

constexpr const char* kFormulas[] = {
    "sqrt(x^2 + z^2) - r*(1 + 0.1*sin(8*atan2(z, x)))",
    "-x^2 + 2^3^2 - 2^-x*(y - 1.5e-3)/pi",
    "d = length(x, y, z)\nk = max(abs(d) - 0.5, -z)\nmin(k, d, 3)",
    "clamp(x, 0, 1)*mix(y, z, 0.25) - smoothstep(0, 1, x)",
    "modulo(x, 0.5) + floor(y) + ceil(z) + round(x) + sign(y) + step(0, z) + fract(x)",
    "exp(-x*x)*log(abs(y) + 1) + tan(z) + asin(x/9) + acos(y/9) + atan(z) + cos(e*tau)",
    "((((((((((x))))))))))",
    "1e999 + x",
    "unknown(x, y)",
    "x +",
    "x = 1\nx",
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

// The text as a value of a scene file, so that its spans are valid positions.
compiler::syntax::Value as_value(const std::string& text) {
  const std::vector<std::string> lines = lines_of(text);
  if (lines.size() == 1) return {{0, static_cast<std::uint32_t>(text.size() + 2)}, text};
  compiler::syntax::List list;
  std::uint32_t at = 0;
  for (const std::string& line : lines) {
    const auto end = at + static_cast<std::uint32_t>(line.size());
    list.push_back({{at, end + 2}, line});
    at = end + 1;
  }
  return {{0, at + 2}, std::move(list)};
}

void print_all(const Diagnostics& diagnostics, const std::string& text) {
  diagnostics.print(Source("formula", "\"" + text + "\"" + "\n"), compiler::ErrorFormat::Text);
}

// Reads the formula as a number, without a point. There is a number if and only if there is no error.
void check_number(const compiler::syntax::Value& value, const std::string& text, const compiler::Scope& scope) {
  if (!std::holds_alternative<std::string>(value.data)) return;
  Diagnostics diagnostics;
  const auto number = compiler::read_number(value, scope, diagnostics);
  print_all(diagnostics, text);
  promise(number.has_value() != diagnostics.has_errors(), "there is a number exactly when there is no error");
}

void check_program_of(const Formula& formula, std::size_t size) {
  compiler::Scene scene;
  scene.root = compiler::make_formula(scene.graph, formula, "f");
  auto code = compiler::lower(scene.graph, scene.root, Source("formula", ""), 2000);
  if (!code) return;
  auto verified = vm::verify(std::move(*code));
  // The front end has refused constants beyond float (holds_in_float). Values beyond float are the machine's concern.
  const auto* program = std::get_if<vm::VerifiedProgram>(&verified);
  if (program == nullptr) throw BrokenPromise(std::get<vm::VerifyError>(verified).reason);
  test::Random random(size);
  check_program(*program, random);
}

}  // namespace

void run_formula(Bytes input) {
  const std::string text = to_text(input);
  const compiler::syntax::Value value = as_value(text);
  compiler::Scope scope;
  scope.declare("r", {});
  scope.at(0).parameter.value = 0.75;
  scope.at(0).state = compiler::Scope::State::Known;
  check_number(value, text, scope);
  Diagnostics diagnostics;
  const auto formula = compiler::read_formula(value, scope, compiler::machine_functions(), diagnostics);
  print_all(diagnostics, text);
  promise(formula.has_value() != diagnostics.has_errors(), "there is a formula exactly when there is no error");
  if (!formula) return;
  for (std::uint32_t i = 0; i < formula->nodes.size(); ++i) {
    for (const std::uint32_t argument : formula->nodes[i].arguments) promise(argument < i, "arguments come first");
  }
  if (compiler::holds_in_float(*formula, diagnostics)) check_program_of(*formula, text.size());
}

std::vector<Input> seeds_of_formula() {
  std::vector<Input> seeds;
  for (const char* formula : kFormulas) seeds.push_back(to_input(formula));
  return seeds;
}

}  // namespace fathom::fuzz
