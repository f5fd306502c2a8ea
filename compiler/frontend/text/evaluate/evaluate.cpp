#include "compiler/frontend/text/evaluate/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/frontend/text/evaluate/evaluator.h"

namespace fathom::compiler::text {

namespace {

// Number of steps per list element that no expression creates. Such an element also takes memory.
constexpr double kStepsPerElement = 3;

double count_tokens(const Tree& tree) {
  double tokens = 0;
  for (const Module& module : tree.modules) tokens += static_cast<double>(module.tokens);
  return tokens;
}

}  // namespace

Evaluator::Evaluator(const Tree& tree, const Definitions& definitions, const Limits& limits, bool keep_formulas,
                     Diagnostics& diagnostics)
    : tree_(tree),
      definitions_(definitions),
      limits_(limits),
      made_nodes_(std::max(limits.made_nodes, count_tokens(tree))),
      keep_formulas_(keep_formulas),
      diagnostics_(diagnostics) {}

void Evaluator::take_step(Span span) {
  if (++steps_ <= limits_.steps) return;
  const double most = limits_.steps;
  steps_ = 0;  // so that other statements are still evaluated
  fail("E0312", span, fmt::format("the scene takes more than {} steps to evaluate", most),
       {raise(&Limits::steps, 2 * most)}, "evaluated when there were too many");
}

Value Evaluator::evaluate(const Expr& expr) {
  using enum Expr::Kind;
  take_step(expr.span);
  if (++depth_ > limits_.formula_nesting + 8) {  // 8 levels in addition to those of a formula
    fail("E0406", expr.span, fmt::format("calls and expressions are nested more than {} deep", limits_.formula_nesting),
         {"give inner parts names of their own with `let`"});
  }
  const auto by_kind = [&]() -> Value {
    switch (expr.kind) {
      case Number: {
        Value value = number(expr.number, expr.span);
        value.integer = integer_of(expr.name);
        spell_number(value, expr.name);
        return value;
      }
      case Text:
        return text(expr.text, expr.span);  // the tree owns the string
      case Truth:
        return truth(expr.number != 0, expr.span);
      case Name:
        return evaluate_name(expr);
      case List:
        return evaluate_list(expr);
      case Record:
        return evaluate_record(expr);
      case Call:
        return call(expr);
      case Index:
        return evaluate_index(expr);
      case Member:
        return evaluate_member(expr);
      case Row:
        return evaluate_row(expr);
      case Negate:
        return negate(evaluate(*expr.of[0]), expr.span);
      case Not:
        return truth(!condition(*expr.of[0]), expr.span);
      case Power: {
        const Value base = evaluate(*expr.of[0]);
        return power(base, evaluate(*expr.of[1]), expr.span);
      }
      case Compare:
        return compare(expr);
      case And:
        return truth(condition(*expr.of[0]) && condition(*expr.of[1]), expr.span);
      case Or:
        return truth(condition(*expr.of[0]) || condition(*expr.of[1]), expr.span);
      case Range:
        return evaluate_range(expr);
      case If:
        return evaluate_if(expr);
      case Let:
        return evaluate_let(expr);
      case Fold:
        return evaluate_fold(expr);
      case For:
      case Guard:
      case Spread:
        break;
    }
    fail("E0807", expr.span, "a list is spread where one value is expected");
  };
  Value value = by_kind();
  for (int i = 0; i < expr.groups && keep_formulas_; ++i) spell_group(value);
  --depth_;
  return value;
}

Value Evaluator::evaluate_name(const Expr& expr) {
  switch (expr.reference.kind) {
    case Reference::Kind::Local: {
      Value value = local(expr.reference.number);
      if (is_number(value)) value.span = here(expr.span);
      return value;
    }
    case Reference::Kind::Global: {
      const Statement& statement = tree_.statements[expr.reference.number];
      const std::string_view label = statement.label.empty() ? statement.name : std::string_view(statement.label);
      const bool parameter = statement.kind == Statement::Kind::Param && statement.module == 0;
      if (parameter) out_.parameters.use(label);
      if (!out_.values[expr.reference.number]) throw Failure();
      Value value = *out_.values[expr.reference.number];
      if (is_number(value)) value.span = here(expr.span);
      if (parameter) spell_name(value, label, true);
      return value;
    }
    case Reference::Kind::Coordinate: {
      Value value = formula(out_.store.formulas.coordinate(expr.name[0], here(expr.span)), expr.span);
      spell_name(value, expr.name, false);
      return value;
    }
    case Reference::Kind::Constant: {
      Value value = number(expr.reference.value, expr.span);
      spell_name(value, expr.name, false);
      return value;
    }
    case Reference::Kind::Objects:
      return objects_of(expr.reference.number, expr.span);
    case Reference::Kind::Definition:
    case Reference::Kind::None:
      break;
  }
  throw Failure();  // the name resolver has reported the error
}

Value Evaluator::evaluate_if(const Expr& expr) {
  return evaluate(condition(*expr.of[0]) ? *expr.of[1] : *expr.of[2]);
}

Value Evaluator::evaluate_let(const Expr& expr) {
  std::uint32_t slot = expr.reference.number;
  for (const Argument& binding : expr.arguments) {
    Value value = evaluate(*binding.value);
    bind(value, binding.name);
    spell_line(value, binding.name);
    local(slot++) = value;
  }
  Value value = evaluate(*expr.of[0]);
  if (keep_formulas_) {
    const std::vector<Value> bindings(&local(expr.reference.number), &local(slot - 1) + 1);
    keep_lines(value, bindings);
  }
  return value;
}

// Records the call or the loop iteration that is being evaluated, for messages.
void Evaluator::enter(const Expr& by, Span name, const Value* element) {
  const bool loop = by.kind != Expr::Kind::Call;
  const double value = element && element->is(Type::Number) ? element->number : std::nan("");
  trace_ = diagnostics_.add_trace({trace_, by.span, name, loop, value});
}

Value Evaluator::evaluate_fold(const Expr& expr) {
  Value result = evaluate(*expr.of[0]);
  const Value over = evaluate(*expr.of[1]);
  const std::uint32_t outside = trace_;
  for (const Value& element : list_of(over, "`fold`").of) {
    trace_ = outside;
    enter(expr, expr.arguments[0].name_span, &element);
    bind(result, expr.name), bind(element, expr.arguments[0].name);
    local(expr.reference.number) = result;
    local(expr.reference.number + 1) = element;
    result = evaluate(*expr.of[2]);
  }
  trace_ = outside;
  return result;
}

Value Evaluator::evaluate_list(const Expr& expr) {
  std::vector<Value> items;
  for (const Expr* item : expr.of) add_items(*item, items);
  return list(std::move(items), expr.span);
}

void Evaluator::add_items(const Expr& item, std::vector<Value>& to) {
  switch (item.kind) {
    case Expr::Kind::For:
      return add_each(item, to);
    case Expr::Kind::Guard:
      if (condition(*item.of[0])) add_items(*item.of[1], to);
      return;
    case Expr::Kind::Spread: {
      const Value spread = evaluate(*item.of[0]);
      for (const Value& value : list_of(spread, "`...`").of) {
        steps_ += kStepsPerElement - 1;
        take_step(item.span);
        to.push_back(value);
      }
      return;
    }
    default:
      to.push_back(evaluate(item));
  }
}

void Evaluator::add_each(const Expr& loop, std::vector<Value>& to) {
  const Value over = evaluate(*loop.of[0]);
  const std::uint32_t outside = trace_;
  for (const Value& element : list_of(over, "`for`").of) {
    trace_ = outside;
    enter(loop, loop.name_span, &element);
    bind(element, loop.name);
    local(loop.reference.number) = element;
    add_items(*loop.of[1], to);
  }
  trace_ = outside;
}

Value Evaluator::evaluate_index(const Expr& expr) {
  const Value of = evaluate(*expr.of[0]);
  const List& list = list_of(of, "`[...]`");
  const double index = constant(evaluate(*expr.of[1]), "an index");
  if (index >= 0 && index < static_cast<double>(list.of.size()) && index == std::floor(index)) {
    return list.of[static_cast<std::size_t>(index)];
  }
  fail("E0807", expr.of[1]->span, fmt::format("there is no element {} in {}", index, describe(of)),
       {list.of.empty() ? "" : fmt::format("elements are numbered from 0 to {}", list.of.size() - 1)});
}

// Evaluates .x, .y and .z of a vector, and the fields of a record.
Value Evaluator::evaluate_member(const Expr& expr) {
  const Value of = evaluate(*expr.of[0]);
  if (of.is(Type::List) && expr.name.size() == 1 && expr.name[0] >= 'x' && expr.name[0] <= 'z') {
    const auto axis = static_cast<std::size_t>(expr.name[0] - 'x');
    if (axis < of.list->of.size()) return of.list->of[axis];
  }
  if (of.is(Type::Record)) {
    for (const Field& field : of.record->fields) {
      if (field.name == expr.name) return field.value;
    }
  }
  std::vector<std::string> help;
  if (find_word(expr.name)) help = {fmt::format("`{0}` is a function: .{0}(...)", expr.name)};
  fail("E0807", expr.name_span, fmt::format("{} has no `{}`", describe(of), expr.name), std::move(help));
}

Field Evaluator::field_of(const Argument& argument) {
  const Value value = evaluate(*argument.value);
  return {argument.name, here(argument.name_span), value};
}

Value Evaluator::evaluate_record(const Expr& expr) {
  text::Record made;
  made.span = here(expr.span);
  for (const Argument& argument : expr.arguments) {
    for (const Field& before : made.fields) {
      if (before.name == argument.name) {
        fail("E0010", argument.name_span, fmt::format("`{}` is given twice", argument.name), {"keep one of them"});
      }
    }
    made.fields.push_back(field_of(argument));
  }
  return record(std::move(made));
}

Value Evaluator::evaluate_range(const Expr& expr) {
  const double from = constant(evaluate(*expr.of[0]), "a range's begin"),
               to = constant(evaluate(*expr.of[1]), "a range's end");
  if (from != std::floor(from) || to != std::floor(to) || std::abs(from) > 1e15 || std::abs(to) > 1e15) {
    fail("E0809", expr.span, fmt::format("a range from {} to {}", from, to),
         {"ranges are of whole numbers; for fractions divide: [for i in 0..10: i/10]"});
  }
  // Count the steps first, so that a range over the limit is never created.
  steps_ += kStepsPerElement * std::max(0.0, to - from);
  take_step(expr.span);
  std::vector<Value> numbers;
  numbers.reserve(static_cast<std::size_t>(std::max(0.0, to - from)));
  for (double i = from; i < to; ++i) {
    numbers.push_back(number(i, expr.span));
  }
  return list(std::move(numbers), expr.span);
}

const List& Evaluator::list_of(const Value& value, const char* what) {
  if (value.is(Type::List)) return *value.list;
  fail("E0807", value.span, fmt::format("{} takes a list, not {}", what, describe(value)),
       {value.is(Type::Number) ? "the whole numbers up to n are 0..n" : ""});
}

void Evaluator::bind(const Value& value, std::string_view name) {
  if (value.is(Type::Node) && value.node->name.empty()) value.node->name = name;
  if (value.is(Type::Record) && value.record->name.empty()) value.record->name = name;
}

Evaluated evaluate(const Tree& tree, const std::vector<std::uint32_t>& order, const Definitions& definitions,
                   const Limits& limits, Diagnostics& diagnostics, bool keep_formulas) {
  return Evaluator(tree, definitions, limits, keep_formulas, diagnostics).run(order);
}

}  // namespace fathom::compiler::text
