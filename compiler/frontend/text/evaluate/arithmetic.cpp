#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "compiler/frontend/text/evaluate/evaluator.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler::text {
namespace {

struct BlendWord {
  std::string_view word, prefix, width;
};
// Blends by the name in their braces. `{0.1}` is short for `{k = 0.1}`.
constexpr BlendWord kBlendWords[] = {{"", "smooth", "k"},
                                     {"k", "smooth", "k"},
                                     {"chamfer", "chamfer", "radius"},
                                     {"round", "round", "radius"},
                                     {"stairs", "stairs", "radius"}};

std::string_view combinator(char mark) {
  return mark == '+' ? "union" : mark == '-' ? "subtraction" : "intersection";
}
std::string_view function_of(char mark) {
  return mark == '+' ? "add" : mark == '-' ? "minus" : mark == '*' ? "multiply" : "divide";
}

double apply(char mark, double a, double b) {
  return mark == '+' ? a + b : mark == '-' ? a - b : mark == '*' ? a * b : a / b;
}

bool same_numbers(const std::vector<Field>& a, const std::vector<Field>& b) {
  return std::ranges::equal(a, b, [](const Field& one, const Field& other) {
    return one.name == other.name && one.value.is(Value::Type::Number) && other.value.is(Value::Type::Number) &&
           std::bit_cast<std::uint64_t>(one.value.number) == std::bit_cast<std::uint64_t>(other.value.number);
  });
}

}  // namespace

Value Evaluator::evaluate_row(const Expr& expr) {
  const Value first = evaluate(*expr.of[0]);
  const bool sum = expr.joints[0].mark != '*' && expr.joints[0].mark != '/';
  return sum && is_node(first) ? evaluate_nodes(expr, first) : evaluate_numbers(expr, first);
}

Value Evaluator::evaluate_numbers(const Expr& expr, const Value& first) {
  Value sum = first;
  for (std::size_t i = 0; i < expr.joints.size(); ++i) {
    const Joint& joint = expr.joints[i];
    const Value next = evaluate(*expr.of[i + 1]);
    if (joint.mark == '&' || joint.blend) {
      fail("E0807", joint.span,
           fmt::format("`{}` joins nodes, not {} and {}", joint.blend ? "{...}" : "&", describe(sum), describe(next)),
           {joint.blend ? "" : "`and` of conditions is &&"});
    }
    if (is_node(next)) {
      fail("E0807", joint.span, fmt::format("`{}` of {} and {}", joint.mark, describe(sum), describe(next)),
           {joint.mark == '*' ? "to make a node larger write sphere(1).scale(2)"
                              : "+, - and & join nodes with nodes, and numbers with numbers"});
    }
    sum = operate(joint.mark, sum, next, {expr.span.begin, expr.of[i + 1]->span.end});
  }
  return sum;
}

Value Evaluator::operate(char mark, const Value& a, const Value& b, Span span) {
  if (is_number(a) && is_number(b)) {
    Value value = a.is(Type::Number) && b.is(Type::Number) ? number(apply(mark, a.number, b.number), span)
                                                           : formula_of_pair(mark, a, b, span);
    spell_pair(value, mark, a, b);
    return value;
  }
  if (a.is(Type::List) || b.is(Type::List)) return elementwise(mark, a, b, span);
  const bool texts = a.is(Type::Text) || b.is(Type::Text), nodes = a.is(Type::Node) || b.is(Type::Node);
  fail("E0807", span, fmt::format("`{}` of {} and {}", mark, describe(a), describe(b)),
       {texts                  ? "texts are not computed with"
        : nodes && mark == '*' ? "a body is made larger by body.scale(2); an intersection is written a & b"
        : nodes                ? "bodies take +, - and &; body.round(0.1) makes one thicker"
                               : "it takes numbers, vectors or nodes"});
}

Value Evaluator::formula_of_pair(char mark, const Value& a, const Value& b, Span span) {
  const FormulaId arguments[] = {formula_of(a), formula_of(b)};
  return formula(out_.store.formulas.call(function_of(mark), arguments, here(span)), span);
}

// Applies an operator to two vectors, or to a vector and a number.
Value Evaluator::elementwise(char mark, const Value& a, const Value& b, Span span) {
  const std::size_t count = a.is(Type::List) ? a.list->of.size() : b.list->of.size();
  if (a.is(Type::List) && b.is(Type::List) && b.list->of.size() != count) {
    fail("E0807", span, fmt::format("`{}` of {} and {}", mark, describe(a), describe(b)),
         {"vectors are of one length: see len(...)"});
  }
  std::vector<Value> parts;
  for (std::size_t i = 0; i < count; ++i) {
    take_step(span);
    parts.push_back(operate(mark, a.is(Type::List) ? a.list->of[i] : a, b.is(Type::List) ? b.list->of[i] : b, span));
  }
  return list(std::move(parts), span);
}

// Evaluates from left to right. Consecutive operands with the same operator and blend become one combinator.
Value Evaluator::evaluate_nodes(const Expr& expr, const Value& first) {
  std::vector<const Node*> operands = {node_of(first, "a row")};
  std::vector<Field> blend;
  std::size_t from = 0;
  for (std::size_t i = 0; i <= expr.joints.size(); ++i) {
    std::vector<Field> next;
    if (i < expr.joints.size() && expr.joints[i].blend) {
      const Value record = evaluate(*expr.joints[i].blend);
      next = record.record->fields;
    }
    const bool goes_on = i < expr.joints.size() &&
                         (i == 0 || (expr.joints[i].mark == expr.joints[from].mark && same_numbers(blend, next)));
    if (!goes_on) {
      Node made;
      made.span = here({expr.span.begin, expr.of[i]->span.end});
      made.word_span = here(expr.joints[from].span);
      combine(expr.joints[from], blend, made);
      made.of = std::move(operands);
      operands = {node(std::move(made)).node};
      from = i;
    }
    if (i == expr.joints.size()) break;
    blend = std::move(next);
    const Value value = evaluate(*expr.of[i + 1]);
    operands.push_back(node_of(value, fmt::format("`{}`", expr.joints[i].mark).c_str()));
  }
  Value made = blank(Type::Node, operands[0]->span);
  made.node = operands[0];
  return made;
}

// Sets the combinator that an operator and its blend stand for, and its properties.
void Evaluator::combine(const Joint& joint, const std::vector<Field>& blend, Node& made) {
  std::string name(combinator(joint.mark));
  for (const Field& field : blend) {
    const auto* row = std::ranges::find(kBlendWords, field.name, &BlendWord::word);
    if (row == std::end(kBlendWords)) {
      made.fields.push_back(field);
      continue;
    }
    name = fmt::format("{}_{}", row->prefix, combinator(joint.mark));
    made.fields.push_back({row->width, field.value.span, field.value});
  }
  made.spec = find_node(name);
  const bool named = std::ranges::any_of(blend, [](const Field& field) {
    return std::ranges::find(kBlendWords, field.name, &BlendWord::word) != std::end(kBlendWords);
  });
  if (made.spec == nullptr || (!blend.empty() && !named)) {
    fail("E0805", joint.span, "a blend of an unknown kind",
         {"{0.1} or {k = 0.1} is smooth; others are {chamfer = 0.1}, {round = 0.1} and {stairs = 0.1, steps = 3}"});
  }
}

Value Evaluator::negate(const Value& value, Span span) {
  if (is_number(value)) {
    const auto negated = [&] {
      const FormulaId argument[] = {formula_of(value)};
      return formula(out_.store.formulas.call("negate", argument, here(span)), span);
    };
    Value made = value.is(Type::Number) ? number(-value.number, span) : negated();
    spell_sign(made, value);
    return made;
  }
  if (!value.is(Type::List)) {
    fail("E0807", span, fmt::format("`-` of {}", describe(value)),
         {value.is(Type::Node) ? "to take a node from another write a - b" : ""});
  }
  std::vector<Value> parts;
  for (const Value& part : value.list->of) {
    take_step(span);
    parts.push_back(negate(part, span));
  }
  return list(std::move(parts), span);
}

Value Evaluator::power(const Value& base, const Value& exponent, Span span) {
  if (!is_number(base) || !is_number(exponent)) {
    fail("E0807", span, fmt::format("`^` of {} and {}", describe(base), describe(exponent)),
         {"powers are of numbers"});
  }
  const auto varying = [&] {
    const FormulaId of = formula_of(base), to = formula_of(exponent);
    return formula(out_.store.formulas.power(of, to, here(span)), span);
  };
  const auto known = [&] {
    FormulaBuilder builder;
    const FormulaId of = builder.constant(base.number, span), to = builder.constant(exponent.number, span);
    return number(*builder.value(builder.power(of, to, span)), span);
  };
  Value value = base.is(Type::Number) && exponent.is(Type::Number) ? known() : varying();
  spell_pair(value, '^', base, exponent);
  return value;
}

Value Evaluator::compare(const Expr& expr) {
  const Value a = evaluate(*expr.of[0]), b = evaluate(*expr.of[1]);
  const auto by_mark = [&](auto one, auto other) {
    return expr.name == "=="   ? one == other
           : expr.name == "!=" ? one != other
           : expr.name == "<"  ? one < other
           : expr.name == "<=" ? one <= other
           : expr.name == ">"  ? one > other
                               : one >= other;
  };
  freeze(a, expr.span), freeze(b, expr.span);
  if (a.is(Type::Formula) || b.is(Type::Formula)) {
    fail("E0808", expr.span, "a condition cannot vary with x, y and z",
         {"step(edge, v) is 0 where v < edge and 1 elsewhere; mix(a, b, step(edge, v)) chooses; see clamp, too"});
  }
  if (a.is(Type::Number) && b.is(Type::Number)) return truth(by_mark(a.number, b.number), expr.span);
  const bool equality = expr.name == "==" || expr.name == "!=";
  if (equality && a.is(Type::Text) && b.is(Type::Text)) return truth(by_mark(*a.text, *b.text), expr.span);
  if (equality && a.is(Type::Truth) && b.is(Type::Truth)) return truth(by_mark(a.truth, b.truth), expr.span);
  fail("E0807", expr.span, fmt::format("`{}` of {} and {}", expr.name, describe(a), describe(b)),
       {"numbers are compared; texts are equal or not"});
}

bool Evaluator::condition(const Expr& expr) {
  const Value value = evaluate(expr);
  if (value.is(Type::Truth)) return value.truth;
  fail("E0807", expr.span, fmt::format("a condition must be true or false, not {}", describe(value)),
       {value.is(Type::Number) || value.is(Type::Formula) ? "compare it, as in n != 0" : ""});
}

}  // namespace fathom::compiler::text
