// Construction of values, and access to them.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/frontend/text/evaluate/evaluator.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler::text {
namespace {

void add_part(Extent& whole, const Value& part) {
  const Extent extent = extent_of(part);
  whole.depth = std::max(whole.depth, extent.depth + 1);
  whole.values += extent.values;
}

}  // namespace

Extent extent_of(const Value& value) {
  return value.is(Value::Type::List)     ? value.list->extent
         : value.is(Value::Type::Record) ? value.record->extent
                                         : Extent();
}

std::string describe(const Value& value) {
  switch (value.type) {
    case Value::Type::Truth:
      return value.truth ? "true" : "false";
    case Value::Type::Number:
      return fmt::format("{}", value.number);
    case Value::Type::Formula:
      return "a formula of x, y and z";
    case Value::Type::Text:
      return "a text";
    case Value::Type::List:
      return value.list->of.empty() ? "an empty list" : fmt::format("a list of {}", value.list->of.size());
    case Value::Type::Record:
      return value.record->word ? fmt::format("a `{}`", value.record->word->text) : "a record";
    case Value::Type::Node:
      break;
  }
  return "a node";
}

// Limits the nesting depth, because code that reads values recurses to that depth.
void Evaluator::check_depth(std::uint32_t depth, Span span) {
  if (depth <= limits_.formula_nesting) return;
  fail("E0406", span, fmt::format("lists are nested more than {} deep", limits_.formula_nesting),
       {"to add to a list spread it: [...list, element]"});
}

Value Evaluator::number(double value, Span span) const {
  Value made = blank(Type::Number, here(span));
  made.number = value;
  return made;
}
Value Evaluator::truth(bool value, Span span) const {
  Value made = blank(Type::Truth, here(span));
  made.truth = value;
  return made;
}

// Returns a number if the formula is constant.
Value Evaluator::formula(FormulaId id, Span span) {
  if (const auto known = out_.store.formulas.value(id)) return number(*known, span);
  if (static_cast<double>(out_.store.formulas.size()) > limits_.nodes) {
    fail("E0312", span, fmt::format("the formulas have more than {} operations and numbers", limits_.nodes),
         {raise(&Limits::nodes, 2 * limits_.nodes)});
  }
  Value made = blank(Type::Formula, here(span));
  made.formula = id;
  return made;
}
Value Evaluator::text(const std::string& value, Span span) {
  Value made = blank(Type::Text, here(span));
  made.text = &value;
  return made;
}
Value Evaluator::list(std::vector<Value> of, Span span) {
  text::List stored{std::move(of), {.depth = 1}};
  for (const Value& part : stored.of) add_part(stored.extent, part);
  check_depth(stored.extent.depth, span);
  Value made = blank(Type::List, here(span));
  made.list = &out_.store.lists.emplace_back(std::move(stored));
  return made;
}
Value Evaluator::record(text::Record from) {
  from.extent = {.depth = 1};
  for (const Field& field : from.fields) add_part(from.extent, field.value);
  check_depth(from.extent.depth, from.span);
  Value made = blank(Type::Record, from.span);
  made.record = &out_.store.records.emplace_back(std::move(from));
  return made;
}
Value Evaluator::node(Node from) {
  if (static_cast<double>(out_.store.nodes.size()) >= limits_.nodes) {
    fail("E0312", from.span, fmt::format("the scene has more than {} nodes here", limits_.nodes),
         {raise(&Limits::nodes, 2 * limits_.nodes)});
  }
  if (static_cast<double>(out_.store.nodes.size()) >= made_nodes_) {
    fail("E0312", from.span, fmt::format("functions and loops make more than {} nodes", made_nodes_),
         {raise(&Limits::made_nodes, 4 * made_nodes_)});
  }
  Value made = blank(Type::Node, from.span);
  made.node = &out_.store.nodes.emplace_back(std::move(from));
  return made;
}

FormulaId Evaluator::formula_of(const Value& value) {
  return value.is(Type::Formula) ? value.formula : out_.store.formulas.constant(value.number, value.span);
}

// True for a node, and for a list of nodes, which stands for their union.
bool Evaluator::is_node(const Value& value) {
  return value.is(Type::Node) ||
         (value.is(Type::List) && !value.list->of.empty() && is_node(value.list->of.front()));
}

const Node* Evaluator::node_of(const Value& value, const char* what) {
  if (value.is(Type::Node)) return value.node;
  if (!value.is(Type::List)) {
    fail("E0807", value.span, fmt::format("{} takes a node, not {}", what, describe(value)),
         {value.is(Type::Number) && what[0] == '`' && what[1] >= 'a'
              ? "such as sphere(1); a number that belongs to the call is named, as t = 0.5"
              : "such as sphere(1)"});
  }
  if (value.list->of.empty()) {
    fail("E0107", value.span, fmt::format("{} takes a node, and this list has none", what), {});
  }
  Node made;
  made.spec = find_node("union");
  made.span = made.word_span = value.span;
  for (const Value& part : value.list->of) {
    take_step(value.span);
    made.of.push_back(node_of(part, what));
  }
  return node(std::move(made)).node;
}

double Evaluator::constant(const Value& value, const char* what) {
  freeze(value, value.span);
  if (value.is(Type::Number)) return value.number;
  if (value.is(Type::Formula)) {
    fail("E0405", value.span, fmt::format("{} cannot vary with x, y and z", what),
         {"x, y and z are known only in the formula of a node, and in those of materials that may vary"});
  }
  fail("E0807", value.span, fmt::format("{} must be a number, not {}", what, describe(value)));
}

void Evaluator::fail(const char* code, Span span, std::string message, std::vector<std::string> help,
                     std::string label) {
  std::erase(help, "");
  if (span.trace == 0) span = here(span);
  diagnostics_.error(code, span, std::move(message), std::move(label), std::move(help));
  throw Failure();
}

}  // namespace fathom::compiler::text
