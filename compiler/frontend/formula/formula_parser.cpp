#include "compiler/frontend/formula/formula_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compiler/frontend/syntax/suggest.h"

namespace fathom::compiler {
namespace {

struct NamedConstant {
  std::string_view name;
  double value;
};
constexpr NamedConstant kConstants[] = {
    {"pi", std::numbers::pi}, {"e", std::numbers::e}, {"tau", 2 * std::numbers::pi}};

bool is_axis(std::string_view name) { return name == "x" || name == "y" || name == "z"; }

const NamedConstant* find_constant(std::string_view name) {
  const auto same = [&](const NamedConstant& row) { return row.name == name; };
  const auto found = std::find_if(std::begin(kConstants), std::end(kConstants), same);
  return found == std::end(kConstants) ? nullptr : found;
}

const FormulaFunction* find_function(std::span<const FormulaFunction> functions, std::string_view name) {
  // The parser looks up every name here, and most names differ in the first character.
  const auto same = [&](const FormulaFunction& row) { return row.name[0] == name[0] && row.name == name; };
  const auto found = std::find_if(functions.begin(), functions.end(), same);
  return found == functions.end() ? nullptr : &*found;
}

std::vector<std::string_view> names_of(const std::vector<FormulaFunction>& functions) {
  std::vector<std::string_view> names;
  for (const FormulaFunction& function : functions) names.push_back(function.name);
  return names;
}

std::vector<std::string_view> known_names(const FormulaContext& context) {
  std::vector<std::string_view> names = context.scope.known_names();
  const auto scope = static_cast<std::ptrdiff_t>(names.size());
  for (const auto& [name, node] : context.definitions) names.push_back(name);
  std::sort(names.begin() + scope, names.end());  // sorted, so that messages are the same on every platform
  for (const NamedConstant& row : kConstants) names.push_back(row.name);
  if (context.has_point || context.may_have_point) names.insert(names.end(), {"x", "y", "z"});
  return names;
}

std::string count_of_arguments(std::size_t count) {
  return fmt::format("{} argument{}", count, count == 1 ? "" : "s");
}

}  // namespace

Span FormulaText::span_of(std::string_view part) const {
  // Escapes are longer than the characters they stand for. In a string with escapes only the span of the whole string
  // is known.
  if (span.end - span.begin != text.size() + 2) return span;
  const auto begin = span.begin + 1 + static_cast<std::uint32_t>(part.data() - text.data());
  return {begin, begin + static_cast<std::uint32_t>(std::max<std::size_t>(part.size(), 1))};
}

FormulaParser::FormulaParser(const FormulaText& text, FormulaContext& context)
    : text_(text), context_(context), lexer_(text.text), next_(lexer_.next()) {}

Token FormulaParser::take() { return std::exchange(next_, lexer_.next()); }

Span FormulaParser::join(Span from, Span to) const { return {from.begin, std::max(from.end, to.end)}; }

FormulaParser::Result FormulaParser::operation(std::string_view function, FormulaId a, FormulaId b) {
  const FormulaId arguments[] = {a, b};
  return context_.builder.call(function, arguments, join(context_.builder.span(a), context_.builder.span(b)));
}

std::optional<Token> FormulaParser::definition() {
  const Token name = take();
  if (name.kind == Token::Kind::Name && next_.is('=')) {
    take();
    return name;
  }
  report(
      "E0401", text_.span, "a line before the last must be `name = ...`", "",
      {"the last line is the result; those before it define names for it, as in [\"d = length(x, z)\", \"d - 1\"]"});
  return std::nullopt;
}

FormulaParser::Result FormulaParser::expression_to_end() {
  const Result result = expression();
  if (result && next_.kind != Token::Kind::End) {
    report_rest();
    return std::nullopt;
  }
  return result;
}

FormulaParser::Result FormulaParser::expression() {
  Result left = term();
  while (left && (next_.is('+') || next_.is('-'))) {
    const bool plus = take().is('+');
    const Result right = term();
    if (!right) return std::nullopt;
    left = operation(plus ? "add" : "minus", *left, *right);
  }
  return left;
}

FormulaParser::Result FormulaParser::term() {
  Result left = factor();
  while (left && (next_.is('*') || next_.is('/'))) {
    const bool times = take().is('*');
    const Result right = factor();
    if (!right) return std::nullopt;
    left = operation(times ? "multiply" : "divide", *left, *right);
  }
  return left;
}

// Every recursion of the parser passes through here, so this function checks the limits.
FormulaParser::Result FormulaParser::factor() {
  if (depth_ > context_.scope.limits().formula_nesting) return too_deep();
  if (static_cast<double>(context_.builder.size()) > context_.scope.limits().nodes) return too_long();
  ++depth_;
  Result result;
  if (next_.is('-')) {
    const Token minus = take();
    result = factor();
    if (result) {
      const FormulaId argument[] = {*result};
      result = context_.builder.call("negate", argument, join(span(minus), context_.builder.span(*result)));
    }
  } else {
    result = power();
  }
  --depth_;
  return result;
}

FormulaParser::Result FormulaParser::power() {
  const Result base = primary();
  if (!base || !next_.is('^')) return base;
  take();
  const Result exponent = factor();
  if (!exponent) return std::nullopt;
  FormulaBuilder& builder = context_.builder;
  return builder.power(*base, *exponent, join(builder.span(*base), builder.span(*exponent)));
}

FormulaParser::Result FormulaParser::primary() {
  if (next_.is('(')) return parenthesis();
  if (next_.kind == Token::Kind::Name) return name();
  if (next_.kind != Token::Kind::Number) return no_value();
  const Token number = take();
  if (!std::isfinite(number.value)) return too_large(number);
  return context_.builder.constant(number.value, span(number));
}

FormulaParser::Result FormulaParser::parenthesis() {
  const Token open = take();
  const Result inner = expression();
  if (!inner) return std::nullopt;
  if (!next_.is(')')) return not_closed(open);
  take();
  return inner;
}

FormulaParser::Result FormulaParser::name() {
  const Token name = take();
  if (next_.is('(')) return call(name);
  return find_function(context_.functions, name.text) ? bare_function(name) : resolve(name);
}

FormulaParser::Result FormulaParser::call(const Token& name) {
  const Token open = take();
  std::vector<FormulaId> arguments;
  while (!next_.is(')') || !arguments.empty()) {
    const Result argument = expression();
    if (!argument) return std::nullopt;
    arguments.push_back(*argument);
    if (!next_.is(',')) break;
    take();
  }
  if (!next_.is(')')) return not_closed(open);
  const Span place = join(span(name), span(take()));
  const FormulaFunction* function = find_function(context_.functions, name.text);
  if (function == nullptr) return unknown_function(name);
  if (arguments.size() < function->least || arguments.size() > function->most) {
    return wrong_count(name, place, *function, arguments.size());
  }
  const FormulaId last = arguments.back();
  const std::string misfit = function->misfit_of(context_.builder.value(last));
  if (misfit.empty()) return function->call(context_.builder, arguments, place);
  report("E0410", context_.builder.span(last), misfit);
  return stand_in(name);
}

FormulaId FormulaParser::stand_in(const Token& name) {
  context_.good = false;
  return context_.builder.constant(0, span(name));
}

FormulaId FormulaParser::resolve(const Token& name) {
  const auto defined = context_.definitions.find(name.text);
  if (defined != context_.definitions.end()) return defined->second;
  if (const NamedConstant* row = find_constant(name.text)) return context_.builder.constant(row->value, span(name));
  if (is_axis(name.text)) {
    if (context_.has_point) return context_.builder.coordinate(name.text[0], span(name));
    report_no_point(name.text, span(name), context_.diagnostics);
    return stand_in(name);
  }
  const Scope::Entry* entry = context_.scope.use(name.text);
  if (entry == nullptr) {
    // The parser reports "a = 1" at its `=` where no definition is allowed.
    if (next_.is('=')) return stand_in(name);
    report("E0402", span(name), fmt::format("unknown name `{}`", name.text), "",
           {context_.diagnostics.full() ? "" : did_you_mean(name.text, known_names(context_))});
  } else if (entry->state == Scope::State::Later) {
    report("E0402", span(name), fmt::format("`{}` has no value yet", name.text), "",
           {"a parameter's formula can use the parameters before it"});
  } else if (entry->state == Scope::State::Known) {
    return context_.builder.constant(entry->parameter.value, span(name));
  }
  return stand_in(name);
}

// Reports are separate functions partly to keep their strings out of the stack frames of the recursion.
FormulaParser::Result FormulaParser::too_deep() {
  report("E0406", span(next_),
         fmt::format("the formula is nested more than {} deep", context_.scope.limits().formula_nesting),
         "one level too many", {"give inner parts names of their own"});
  return std::nullopt;
}

FormulaParser::Result FormulaParser::too_long() {
  const double most = context_.scope.limits().nodes;
  report("E0312", span(next_), fmt::format("the formula has more than {} operations and numbers", most),
         "one too many", {raise(&Limits::nodes, 2 * most)});
  return std::nullopt;
}

FormulaParser::Result FormulaParser::too_large(const Token& number) {
  report("E0009", span(number), fmt::format("the number `{}` is too large", number.text));
  return std::nullopt;
}

FormulaId FormulaParser::unknown_function(const Token& name) {
  const bool value = is_axis(name.text) || find_constant(name.text) || context_.scope.use(name.text) ||
                     context_.definitions.contains(name.text);
  report("E0403", span(name), fmt::format("unknown function `{}`", name.text), "",
         {value                         ? fmt::format("for a product write {}*(...)", name.text)
          : context_.diagnostics.full() ? ""
                                        : did_you_mean(name.text, names_of(context_.functions))});
  return stand_in(name);
}

FormulaId FormulaParser::wrong_count(const Token& name, Span place, const FormulaFunction& function,
                                     std::size_t count) {
  const std::string right = function.least == function.most
                                ? count_of_arguments(function.least)
                                : fmt::format("{} or {}", function.least, count_of_arguments(function.most));
  report("E0404", place, fmt::format("`{}` takes {}, not {}", name.text, right, count), "",
         {fmt::format("write {}({})", name.text, std::string_view("a, b, c, d").substr(0, 3 * function.most - 2))});
  return stand_in(name);
}

FormulaParser::Result FormulaParser::bare_function(const Token& name) {
  report("E0402", span(name), fmt::format("the function `{}` without arguments", name.text), "",
         {fmt::format("write {}(...)", name.text)});
  return std::nullopt;
}

FormulaParser::Result FormulaParser::no_value() {
  if (next_.kind == Token::Kind::Foreign) {
    report_rest();
  } else if (next_.kind == Token::Kind::End) {
    report("E0401", span(next_), text_.text.empty() ? "an empty formula" : "the formula ends too early",
           "a value is missing");
  } else {
    report("E0401", span(next_), fmt::format("`{}` where a value was expected", next_.text),
           "a number, a name or ( is missing");
  }
  return std::nullopt;
}

FormulaParser::Result FormulaParser::not_closed(const Token& open) {
  if (next_.kind == Token::Kind::End) {
    report("E0401", span(open), "`(` is never closed", "", {"add the `)` that belongs to it"});
  } else {
    report_rest();
  }
  return std::nullopt;
}

// Reports the token found where an operator, a `)` or the end was expected.
void FormulaParser::report_rest() {
  const std::string shown(next_.text);
  std::vector<std::string> help;
  if (next_.kind == Token::Kind::Foreign) {
    if (!next_.help.empty()) help.emplace_back(next_.help);
    report("E0401", span(next_), fmt::format("formulas have no `{}`", shown), "", std::move(help));
  } else if (next_.is(')')) {
    report("E0401", span(next_), "`)` without a `(` before it");
  } else if (next_.is(',')) {
    report("E0401", span(next_), "`,` outside a function's arguments", "", {"decimal numbers have a point: 0.5"});
  } else if (next_.is('=')) {
    report("E0401", span(next_), "`=` within a formula", "",
           {context_.has_point ? "definitions come before the last line: [\"a = 2*r\", \"a + 1\"]"
                               : "names for numbers are given under `params`"});
  } else {
    const bool unit = shown == "deg" || shown == "rad";
    report("E0401", span(next_), fmt::format("an operator is missing before `{}`", shown), "",
           {unit ? "units are not written: angles of a scene are in degrees, those of sin, cos and tan in radians"
                 : "for a product write a*b"});
  }
}

void FormulaParser::report(const char* code, Span span, std::string message, std::string label,
                           std::vector<std::string> help) {
  context_.good = false;
  std::erase(help, "");
  context_.diagnostics.error(code, span, std::move(message), std::move(label), std::move(help));
}

void report_no_point(std::string_view axis, Span span, Diagnostics& diagnostics) {
  diagnostics.error("E0405", span, fmt::format("`{}` has no value here", axis), "",
                    {"x, y and z are known only in the formula of a node, and in those of materials that may vary"});
}

std::optional<double> formula_constant(std::string_view name) {
  const NamedConstant* row = find_constant(name);
  return row ? std::optional(row->value) : std::nullopt;
}

std::string misfit_name(std::string_view name, std::span<const FormulaFunction> functions) {
  if (!is_formula_name(name)) return "is not a letter or _ followed by letters, digits and _";
  if (is_axis(name)) return "is a coordinate";
  if (find_constant(name)) return "is a constant of formulas";
  if (find_function(functions, name)) return "is a function of formulas";
  return "";
}

}  // namespace fathom::compiler
