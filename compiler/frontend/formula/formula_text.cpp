#include "compiler/frontend/formula/formula_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::compiler {
namespace {

struct Infix {
  std::string_view function, mark;
  int precedence;
};
constexpr Infix kInfix[] = {{"add", " + ", 1}, {"minus", " - ", 1}, {"multiply", "*", 2}, {"divide", "/", 2}};
constexpr int kSign = 3, kPower = 4, kCall = 5;
// Longer subexpressions get a name on a line of their own.
constexpr std::size_t kLongestPart = 200;

struct Spelled {
  std::string text;
  int precedence;
};

std::string at_least(const Spelled& part, int precedence) {
  return part.precedence >= precedence ? part.text : "(" + part.text + ")";
}

Spelled spell_number(double value) {
  const std::string text = fmt::format("{}", std::abs(value));
  return std::signbit(value) ? Spelled{"-" + text, kSign} : Spelled{text, kCall};
}

Spelled spell(const Formula::Node& node, const std::vector<Spelled>& parts) {
  if (node.function == "const") return spell_number(node.value);
  const auto argument = [&](std::size_t i) -> const Spelled& { return parts[node.arguments[i]]; };
  for (const Infix& row : kInfix) {
    if (row.function != node.function) continue;
    return {at_least(argument(0), row.precedence) + std::string(row.mark) + at_least(argument(1), row.precedence + 1),
            row.precedence};
  }
  // A negated sum needs parentheses, and so does a product, because -x*y parses as a product.
  if (node.function == "negate") return {"-" + at_least(argument(0), kSign), kSign};
  if (node.function == "square") return {at_least(argument(0), kCall) + "^2", kPower};
  std::string_view name = node.function;
  if (name == "power") name = "pow";
  if (name == "nearest") name = "round";
  if (name == "modulo") name = "mod";
  std::string out(name);
  for (std::size_t i = 0; i < node.arguments.size(); ++i) out += (i == 0 ? "(" : ", ") + argument(i).text;
  return {node.arguments.empty() ? out : out + ")", kCall};
}

}  // namespace

std::vector<std::string> formula_lines(const Formula& formula) {
  std::vector<std::uint32_t> uses(formula.nodes.size(), 0);
  for (const Formula::Node& node : formula.nodes) {
    for (const std::uint32_t argument : node.arguments) ++uses[argument];
  }
  std::vector<Spelled> parts;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < formula.nodes.size(); ++i) {
    Spelled text = spell(formula.nodes[i], parts);
    const bool plain = formula.nodes[i].arguments.empty();
    if (!plain && i + 1 < formula.nodes.size() && (uses[i] > 1 || text.text.size() > kLongestPart)) {
      const std::string name = fmt::format("t{}", lines.size() + 1);
      lines.push_back(name + " = " + text.text);
      text = {name, kCall};
    }
    parts.push_back(std::move(text));
  }
  lines.push_back(parts.back().text);
  return lines;
}

}  // namespace fathom::compiler
