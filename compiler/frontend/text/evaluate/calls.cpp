#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/frontend/formula/formula_evaluate.h"
#include "compiler/frontend/syntax/suggest.h"
#include "compiler/frontend/text/evaluate/evaluator.h"

namespace fathom::compiler::text {
namespace {

constexpr double kLargestExact = 9007199254740992;  // 2^53

std::string_view property_of(Placement placement) {
  constexpr std::string_view kNames[] = {"", "scale", "rotate", "translate", "material", "name"};
  return kNames[static_cast<std::size_t>(placement)];
}

std::string arguments_of(std::size_t count) { return fmt::format("{} argument{}", count, count == 1 ? "" : "s"); }

// Mixing function of SplitMix64. Source: Steele et al., "Fast Splittable Pseudorandom Number Generators", 2014.
std::uint64_t mix(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
  z = (z ^ z >> 27) * 0x94D049BB133111EB;
  return z ^ z >> 31;
}

// Prints a value as written in a text, for notes.
std::string shown(const Value& value) {
  if (value.is(Value::Type::Text)) return fmt::format("\"{}\"", *value.text);
  if (!value.is(Value::Type::List)) return describe(value);
  std::string out = "[";
  for (std::size_t i = 0; i < value.list->of.size(); ++i) {
    out += (i > 0 ? ", " : "") + shown(value.list->of[i]);
    if (out.size() > 500) return out + ", ...]";
  }
  return out + "]";
}

}  // namespace

Value Evaluator::call(const Expr& expr) {
  if (expr.reference.kind == Reference::Kind::Definition) {
    return call_definition(expr, tree_.statements[expr.reference.number]);
  }
  if (expr.word == nullptr) throw Failure();  // the name resolver has reported the error
  const Word& word = *expr.word;
  // `noise` is both a pattern, with named arguments, and a function of numbers.
  const bool has_positional = std::ranges::any_of(expr.arguments, [](const Argument& a) { return a.name.empty(); });
  if (word.is_record() && !(word.formula && has_positional)) return call_record(expr);
  if (word.builtin == Builtin::Require) return call_require(expr);
  const std::vector<Value> arguments = positional_arguments(expr);
  if (word.placement != Placement::None) return place(expr, arguments);
  const bool of_node = word.node && (!word.formula || (!arguments.empty() && is_node(arguments[0])));
  if (of_node) return make_node(expr, arguments);
  for (const Argument& argument : expr.arguments) {
    if (argument.name.empty()) continue;
    fail("E0805", argument.name_span, fmt::format("`{}` has no argument `{}`", word.text, argument.name),
         {"its arguments have no names"});
  }
  return word.formula ? call_formula(expr, arguments) : call_builtin(expr, arguments);
}

// Returns the values of the arguments without a name.
std::vector<Value> Evaluator::positional_arguments(const Expr& expr) {
  std::vector<Value> values;
  for (const Argument& argument : expr.arguments) {
    if (argument.name.empty()) add_items(*argument.value, values);
  }
  return values;
}

Value Evaluator::call_definition(const Expr& expr, const Statement& definition) {
  const std::vector<Argument>& parameters = definition.fields;
  std::vector<const Value*> given(parameters.size(), nullptr);
  std::vector<Value> values = positional_arguments(expr);
  const std::size_t without_name = values.size();
  if (without_name > parameters.size()) {
    fail("E0805", expr.span,
         fmt::format("`{}` takes {}, not {}", expr.name, arguments_of(parameters.size()), without_name));
  }
  values.reserve(values.size() + expr.arguments.size());
  for (std::size_t i = 0; i < without_name; ++i) given[i] = &values[i];
  for (const Argument& argument : expr.arguments) {
    if (argument.name.empty()) continue;
    const auto found = std::ranges::find(parameters, argument.name, &Argument::name);
    if (found == parameters.end()) {
      std::vector<std::string_view> known;
      for (const Argument& parameter : parameters) known.push_back(parameter.name);
      fail("E0805", argument.name_span, fmt::format("`{}` has no argument `{}`", expr.name, argument.name),
           {did_you_mean(argument.name, known)});
    }
    const Value*& place = given[static_cast<std::size_t>(found - parameters.begin())];
    if (place) fail("E0010", argument.name_span, fmt::format("`{}` is given twice", argument.name), {"keep one of them"});
    place = &values.emplace_back(evaluate(*argument.value));
  }
  const std::uint32_t outside_trace = trace_;
  const std::size_t outside_base = base_;
  enter(expr, expr.name_span, nullptr);
  base_ = locals_.size();
  locals_.resize(base_ + definition.slots);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (given[i] == nullptr && parameters[i].value == nullptr) {
      trace_ = outside_trace;
      fail("E0805", expr.span, fmt::format("`{}` has no `{}`", expr.name, parameters[i].name),
           {"arguments that may be left out have a value where the function is declared: def f(a, b = 1)"});
    }
    const Value value = given[i] ? *given[i] : evaluate(*parameters[i].value);
    bind(value, parameters[i].name);
    local(static_cast<std::uint32_t>(i)) = value;
  }
  const Value result = evaluate(*definition.value);
  locals_.resize(base_);
  base_ = outside_base;
  trace_ = outside_trace;
  return result;
}

// Calls a formula function. `length` also accepts a vector.
Value Evaluator::call_formula(const Expr& expr, Values arguments) {
  const FormulaFunction& function = *expr.word->formula;
  if (arguments.size() == 1 && arguments[0].is(Type::List) && function.most > 1) arguments = arguments[0].list->of;
  if (arguments.size() < function.least || arguments.size() > function.most) {
    const std::string right = function.least == function.most
                                  ? arguments_of(function.least)
                                  : fmt::format("{} or {}", function.least, arguments_of(function.most));
    fail("E0404", expr.span, fmt::format("`{}` takes {}, not {}", expr.name, right, arguments.size()),
         {fmt::format("write {}({})", expr.name, std::string_view("a, b, c, d").substr(0, 3 * function.most - 2))});
  }
  for (const Value& argument : arguments) {
    if (!is_number(argument)) {
      fail("E0807", argument.span, fmt::format("`{}` takes numbers, not {}", expr.name, describe(argument)),
           {std::string(argument.is(Type::Node) ? foreign_help(expr.name) : "")});
    }
  }
  const Value& last = arguments.back();
  const std::string misfit = function.misfit_of(last.is(Type::Number) ? std::optional(last.number) : std::nullopt);
  if (!misfit.empty()) fail("E0410", last.span, misfit);
  Value value = apply_function(function, arguments, expr.span);
  spell_call(value, expr.name, arguments);
  return value;
}

Value Evaluator::apply_function(const FormulaFunction& function, Values arguments, Span span) {
  std::vector<double> numbers;
  for (const Value& argument : arguments) {
    if (argument.is(Type::Number)) numbers.push_back(argument.number);
  }
  if (numbers.size() == arguments.size() && !function.expand) {
    if (const auto value = call_function(function.basic, numbers)) return number(*value, span);
  }
  FormulaBuilder scratch;
  FormulaBuilder& builder = numbers.size() == arguments.size() ? scratch : out_.store.formulas;
  std::vector<FormulaId> ids;
  for (const Value& argument : arguments) {
    ids.push_back(argument.is(Type::Formula) ? argument.formula : builder.constant(argument.number, argument.span));
  }
  const FormulaId made = function.call(builder, ids, here(span));
  if (const auto value = builder.value(made)) return number(*value, span);
  return formula(made, span);
}

Value Evaluator::call_builtin(const Expr& expr, Values arguments) {
  const Builtin which = expr.word->builtin;
  if (which == Builtin::Random) return call_random(expr, arguments);
  const std::size_t wanted = which == Builtin::Dot ? 2 : 1;
  if (arguments.size() != wanted) {
    fail("E0805", expr.span, fmt::format("`{}` takes {}, not {}", expr.name, arguments_of(wanted), arguments.size()));
  }
  if (which == Builtin::Show) {
    diagnostics_.warning("W0407", here(expr.span), fmt::format("{}", shown(arguments[0])));
    return arguments[0];
  }
  const std::string what = fmt::format("`{}`", expr.name);
  const List& a = list_of(arguments[0], what.c_str());
  if (which == Builtin::Len) return number(static_cast<double>(a.of.size()), expr.span);
  const auto times = [&](const Value& p, const Value& q) { return operate('*', p, q, expr.span); };
  const auto sum_of_products = [&](const List& p, const List& q) {
    if (p.of.size() != q.of.size() || p.of.empty()) {
      fail("E0807", expr.span, fmt::format("{} of {} and {}", what, describe(arguments[0]), describe(arguments.back())),
           {"vectors are of one length: see len(...)"});
    }
    Value sum = times(p.of[0], q.of[0]);
    for (std::size_t i = 1; i < p.of.size(); ++i) sum = operate('+', sum, times(p.of[i], q.of[i]), expr.span);
    return sum;
  };
  if (which == Builtin::Dot) return sum_of_products(a, list_of(arguments[1], what.c_str()));
  const Value square = sum_of_products(a, a);
  const double length = std::sqrt(square.is(Type::Number) ? square.number : constant(square, "a vector's length"));
  if (!(length > 0)) fail("E0807", expr.span, "a vector of length 0 has no direction");
  Value divisor = number(length, expr.span);
  if (square.spelling && square.spelling->is_parametric) spell_call(divisor, "sqrt", Values(&square, 1));
  return operate('/', arguments[0], divisor, expr.span);
}

// Returns a random number in [0, 1) that depends only on the arguments, which are whole numbers: the same on every
// platform and in any order of calls.
Value Evaluator::call_random(const Expr& expr, Values arguments) {
  if (arguments.empty()) {
    fail("E0805", expr.span, "`random` takes whole numbers that say which random number it is",
         {"random(i) is another for each i, the same every time"});
  }
  std::uint64_t hash = 0;
  for (const Value& argument : arguments) {
    const double value = constant(argument, "an argument of `random`");
    if (value != std::floor(value) || std::abs(value) > kLargestExact) {
      fail("E0807", argument.span, fmt::format("`random` takes whole numbers, not {}", value),
           {"round(...), floor(...) and ceil(...) make whole numbers"});
    }
    hash = mix(hash + static_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
  }
  return number(static_cast<double>(hash >> 11) * 0x1p-53, expr.span);
}

// Evaluates require(condition, "what is wrong", value). A false condition is an error, and the value is not
// evaluated.
Value Evaluator::call_require(const Expr& expr) {
  const bool plain = std::ranges::all_of(expr.arguments, [](const Argument& argument) {
    return argument.name.empty() && argument.value->kind != Expr::Kind::Spread;
  });
  if (!plain || expr.arguments.size() != 3) {
    fail("E0805", expr.span, "`require` takes a condition, a text and a value",
         {"require(n > 2, \"a polygon has 3 corners or more\", value)"});
  }
  if (condition(*expr.arguments[0].value)) return evaluate(*expr.arguments[2].value);
  const Value message = evaluate(*expr.arguments[1].value);
  fail("E0811", expr.arguments[0].value->span, message.is(Type::Text) ? *message.text : shown(message), {},
       "this is required");
}

Value Evaluator::call_record(const Expr& expr) {
  Record made{.word = expr.word, .span = here(expr.span), .word_span = here(expr.name_span), .fields = {}};
  for (const Argument& argument : expr.arguments) {
    if (argument.name.empty()) {
      fail("E0805", argument.value->span, fmt::format("the arguments of `{}` have names", expr.name),
           {fmt::format("such as {}(color = 0.5)", expr.name)});
    }
    if (std::ranges::find(made.fields, argument.name, &Field::name) != made.fields.end()) {
      fail("E0010", argument.name_span, fmt::format("`{}` is given twice", argument.name), {"keep one of them"});
    }
    made.fields.push_back(field_of(argument));
  }
  return record(std::move(made));
}

Value Evaluator::make_node(const Expr& expr, Values arguments) {
  Node made;
  made.spec = expr.word->node, made.span = here(expr.span), made.word_span = here(expr.name_span);
  if (made.spec->category == Category::Combinator) {
    add_operands(expr, arguments, made);
  } else {
    add_positional(expr, arguments, made);
  }
  for (const Argument& argument : expr.arguments) {
    if (argument.name.empty()) continue;
    const Value value = evaluate(*argument.value);
    if (argument.name == "of") {
      made.of.push_back(node_of(value, fmt::format("`{}`", expr.name).c_str()));
    } else {
      add_field(argument, value, made);
    }
  }
  const bool alters = made.spec->category == Category::Alteration && positional(*made.spec).front() == "of";
  if (alters && made.of.empty()) {
    fail("E0805", expr.name_span, fmt::format("`{}` has no node to alter", expr.name),
         {fmt::format("write sphere(1).{}(...)", expr.name)});
  }
  return node(std::move(made));
}

void Evaluator::add_operands(const Expr& expr, Values arguments, Node& made) {
  for (const Value& argument : arguments) {
    made.of.push_back(node_of(argument, fmt::format("`{}`", expr.name).c_str()));
  }
  if (made.of.empty()) {
    fail("E0107", expr.span, fmt::format("`{}` of no nodes", expr.name), {"such as sphere(1), box([1, 1, 1])"});
  }
}

// True for three numbers in place of a vector, as in box(1, 2, 3).
bool Evaluator::is_spread_vector(const NodeSpec& node, Values arguments) {
  if (node.params.empty() || arguments.size() != 3) return false;
  return node.params[0].type == ParamType::Vec3 &&
         std::ranges::all_of(arguments, [](const Value& value) { return value.is(Type::Number); });
}

void Evaluator::add_positional(const Expr& expr, Values arguments, Node& made) {
  const std::vector<std::string_view>& names = positional(*made.spec);
  if (arguments.size() > names.size()) {
    std::vector<std::string_view> others;
    for (const ParamSpec& param : made.spec->params) {
      if (std::ranges::find(names, param.name) == names.end()) others.push_back(param.name);
    }
    fail("E0805", arguments[names.size()].span,
         fmt::format("`{}` takes {} without a name, not {}", expr.name, arguments_of(names.size()), arguments.size()),
         {is_spread_vector(*made.spec, arguments) ? fmt::format("vectors have brackets: {}([1, 2, 3])", expr.name)
          : names.empty()                         ? ""
                                                  : fmt::format("without a name: {}", fmt::join(names, ", ")),
          others.empty() ? "" : fmt::format("with a name: {} = ...", fmt::join(others, " = ..., "))});
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (names[i] == "of") {
      made.of.push_back(node_of(arguments[i], fmt::format("`{}`", expr.name).c_str()));
    } else {
      made.fields.push_back({names[i], arguments[i].span, arguments[i]});
    }
  }
}

void Evaluator::add_field(const Argument& argument, const Value& value, Node& made) {
  if (std::ranges::find(made.fields, argument.name, &Field::name) != made.fields.end()) {
    fail("E0010", argument.name_span, fmt::format("`{}` is given twice", argument.name), {"keep one of them"});
  }
  made.fields.push_back({argument.name, here(argument.name_span), value});
}

// Adds a placement to a node: x.scale(2), x.rotate([0, 90, 0]), x.rotate(axis = [0, 1, 0], angle = 90),
// x.translate(v), x.material(m) or x.name("n").
Value Evaluator::place(const Expr& expr, Values arguments) {
  if (arguments.empty()) {
    fail("E0805", expr.name_span, fmt::format("`{}` has no node", expr.name),
         {fmt::format("write sphere(1).{}(...)", expr.name)});
  }
  Node made;
  made.span = here(expr.span), made.word_span = here(expr.name_span);
  made.of = {node_of(arguments[0], fmt::format("`{}`", expr.name).c_str())};
  const bool turns = expr.word->placement == Placement::Rotate && arguments.size() == 1;
  if (!turns && arguments.size() != 2) {
    fail("E0805", expr.span,
         fmt::format("`{}` takes a node and one argument, not {}", expr.name, arguments.size() - 1),
         {arguments.size() > 2 ? fmt::format("vectors have brackets: sphere(1).{}([1, 2, 3])", expr.name) : ""});
  }
  for (const Argument& argument : expr.arguments) {
    if (argument.name.empty() || turns) continue;
    fail("E0805", argument.name_span, fmt::format("`{}` has no argument `{}`", expr.name, argument.name));
  }
  const Value value = turns ? rotation(expr) : arguments[1];
  made.fields.push_back({property_of(expr.word->placement), made.word_span, value});
  return node(std::move(made));
}

// Returns the named arguments as a record.
Value Evaluator::rotation(const Expr& expr) {
  Record made;
  made.span = here(expr.span);
  for (const Argument& argument : expr.arguments) {
    if (!argument.name.empty()) made.fields.push_back(field_of(argument));
  }
  return record(std::move(made));
}

}  // namespace fathom::compiler::text
