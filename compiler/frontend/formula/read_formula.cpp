#include "compiler/frontend/formula/read_formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/frontend/formula/formula_evaluate.h"
#include "compiler/frontend/formula/formula_parser.h"

namespace fathom::compiler {
namespace {

// Reads `name = expression` into the context. A name is defined even if its expression is in error, so that the
// parser reads later lines as intended.
void read_definition(const FormulaText& text, FormulaContext& context) {
  FormulaParser parser(text, context);
  const std::optional<Token> name = parser.definition();
  if (!name) return;
  const Span place = text.span_of(name->text);
  std::string misfit = misfit_name(name->text, context.functions);
  if (misfit.empty() && context.scope.use(name->text)) misfit = "is a parameter of the scene";
  if (misfit.empty() && context.definitions.contains(name->text)) misfit = "is defined already";
  if (!misfit.empty()) {
    context.diagnostics.error("E0407", place, fmt::format("the name `{}` {}", name->text, misfit), "",
                              {"choose another name"});
    context.good = false;
  }
  const auto value = parser.expression_to_end();
  context.definitions.emplace(name->text, value ? *value : context.builder.constant(0, place));
}

std::optional<Formula> finish(FormulaContext& context, std::optional<FormulaId> root) {
  if (!root || !context.good) return std::nullopt;
  return context.builder.finish(*root);
}

std::optional<Formula> read_lines(const syntax::List& lines, FormulaContext& context) {
  std::optional<FormulaId> result;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto* line = std::get_if<std::string>(&lines[i].data);
    if (line == nullptr) {
      context.diagnostics.error("E0101", lines[i].span, "a line of a formula must be a string");
      context.good = false;
    } else if (i + 1 < lines.size()) {
      read_definition({*line, lines[i].span}, context);
    } else {
      result = FormulaParser({*line, lines[i].span}, context).expression_to_end();
    }
  }
  return finish(context, result);
}

}  // namespace

std::optional<Formula> read_formula(const syntax::Value& value, const Scope& scope,
                                    std::span<const FunctionSpec> functions, Diagnostics& diagnostics) {
  if (const auto* formula = std::get_if<syntax::ReadFormula>(&value.data)) return **formula;
  FormulaContext context{scope, formula_functions(functions), true, diagnostics};
  const auto* lines = std::get_if<syntax::List>(&value.data);
  if (lines && !lines->empty()) return read_lines(*lines, context);
  if (const auto* text = std::get_if<std::string>(&value.data)) {
    return finish(context, FormulaParser({*text, value.span}, context).expression_to_end());
  }
  diagnostics.error("E0101", value.span, "a formula must be a string or a list of strings", "",
                    {"such as \"length(x, y, z) - 1\" or [\"d = length(x, z)\", \"d - 1\"]"});
  return std::nullopt;
}

std::optional<double> read_number(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics,
                                  bool may_vary) {
  if (const auto* formula = std::get_if<syntax::ReadFormula>(&value.data)) {
    const auto axis = std::ranges::find_if((*formula)->nodes, [](const Formula::Node& node) {
      return node.function == "x" || node.function == "y" || node.function == "z";
    });
    if (axis == (*formula)->nodes.end()) return evaluate(**formula);
    report_no_point(axis->function, axis->span, diagnostics);
    return std::nullopt;
  }
  FormulaContext context{scope, formula_functions(constant_functions()), false, diagnostics};
  context.may_have_point = may_vary;
  const FormulaText text{std::get<std::string>(value.data), value.span};
  const std::optional<Formula> formula = finish(context, FormulaParser(text, context).expression_to_end());
  return formula ? std::optional(evaluate(*formula)) : std::nullopt;
}

}  // namespace fathom::compiler
