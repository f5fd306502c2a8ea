#include <algorithm>
#include <memory>
#include <utility>

#include "compiler/frontend/syntax/make_syntax.h"
#include "compiler/frontend/text/evaluate/evaluator.h"

namespace fathom::compiler::text {

Evaluated Evaluator::run(const std::vector<std::uint32_t>& order) {
  out_.values.resize(tree_.statements.size());
  out_.parameters = Scope(limits_);
  scopes_.assign(tree_.modules.size(), Scope(limits_));
  objects_.resize(tree_.modules.size());
  const auto own_parameter = [&](const Statement& statement) {
    return statement.kind == Statement::Kind::Param && statement.module == 0;
  };
  for (std::uint32_t i = 0; i < tree_.modules[0].end; ++i) {
    if (own_parameter(tree_.statements[i])) run_statement(i);
  }
  check_definitions(definitions_, out_.parameters, diagnostics_);
  for (const std::uint32_t number : order) {
    const Statement& statement = tree_.statements[number];
    const bool done = own_parameter(statement) || statement.kind == Statement::Kind::Def;
    if (!done && !diagnostics_.full()) run_statement(number);
  }
  return std::move(out_);
}

void Evaluator::run_statement(std::uint32_t number) {
  const Statement& statement = tree_.statements[number];
  locals_.assign(statement.slots, {});
  base_ = 0, depth_ = 0, trace_ = 0;
  try {
    Value value = statement.kind == Statement::Kind::Param    ? run_parameter(statement)
                  : statement.kind == Statement::Kind::Import ? run_import(statement)
                                                              : evaluate(*statement.value);
    if (statement.kind == Statement::Kind::Let) {
      if (value.is(Type::Node) && statement.value->kind == Expr::Kind::Name) value = another_name(*value.node);
      bind(value, statement.name);
    }
    out_.values[number] = statement.kind == Statement::Kind::Object ? object(statement, value) : value;
  } catch (const Failure&) {
    // Already reported. Statements that use the name fail silently.
  }
}

// Returns a new node that stands for the same node under another name.
Value Evaluator::another_name(const Node& of) {
  Node made;
  made.span = of.span, made.word_span = of.word_span;
  made.of = {&of};
  return node(std::move(made));
}

// Returns a node, or a list of nodes if each of them is an object.
Value Evaluator::object(const Statement& statement, const Value& value) {
  const auto as_node = [&](const Value& one) {
    Value made = blank(Type::Node, one.span);
    made.node = node_of(one, "an object");
    return made;
  };
  if (!statement.is_spread) return as_node(value);
  std::vector<Value> nodes;
  for (const Value& one : list_of(value, "`...`").of) nodes.push_back(as_node(one));
  return list(std::move(nodes), value.span);
}

// Returns a record of the values that an import gives for the parameters of its file.
Value Evaluator::run_import(const Statement& statement) {
  text::Record made;
  made.span = statement.span;
  for (const Argument& argument : statement.fields) made.fields.push_back(field_of(argument));
  return record(std::move(made));
}

// Returns the value that the import gives for the parameter, or null without one.
const Value* Evaluator::given_value(const Statement& parameter) {
  const Module& module = tree_.modules[parameter.module];
  if (!module.has_values) return nullptr;
  const std::optional<Value>& values = out_.values[module.values];
  if (!values) throw Failure();
  const std::vector<Field>& fields = values->record->fields;
  const auto found = std::ranges::find(fields, parameter.name, &Field::name);
  return found == fields.end() ? nullptr : &found->value;
}

// Reads a parameter like a parameter of a JSON scene. The command line overrides the value of the file's own
// parameters, and the import overrides the value in an imported file.
Value Evaluator::run_parameter(const Statement& statement) {
  const auto known_value = [&](const Value& value) {
    if (value.is(Type::Text)) return make_value(value.span, *value.text);
    if (value.is(Type::Record)) {
      fail("E0807", value.span, "a parameter must be a number, not a record",
           {fmt::format("limits stand before the value: param {}(min = 0, max = 2) = 1", statement.name)});
    }
    const std::size_t frozen = out_.frozen.size();
    const double known = constant(value, "a parameter");
    out_.frozen.resize(frozen);  // the parameter itself keeps its formula
    return make_value(value.span, known);
  };
  const auto constant_value = [&](const Expr& expr) { return known_value(evaluate(expr)); };
  const Value* given = given_value(statement);
  syntax::Property property{statement.label.empty() ? std::string(statement.name) : statement.label,
                            statement.name_span, nullptr};
  RecordMaker record(statement.name_span);
  record.add("default", given ? known_value(*given) : constant_value(*statement.value));
  const Value own = given ? *given : keep_formulas_ ? evaluate(*statement.value) : Value{};
  for (const Argument& field : statement.fields) record.add(field.name, constant_value(*field.value));
  property.value = std::make_unique<syntax::Value>(record.take());
  if (given) property.value->span = given->span;  // place of a range error
  const bool own_file = statement.module == 0;
  const Definitions none;
  const Scope::Entry& entry = read_parameter(property, own_file ? definitions_ : none,
                                             own_file ? out_.parameters : scopes_[statement.module], diagnostics_);
  if (entry.state != Scope::State::Known) throw Failure();
  Value value = number(entry.parameter.value, statement.value->span);
  value.spelling = own.spelling;
  return value;
}

// Returns all objects of a file as one node.
Value Evaluator::objects_of(std::uint32_t number, Span span) {
  if (objects_[number]) return *objects_[number];
  const Module& module = tree_.modules[number];
  Node all;
  all.spec = find_word("union")->node;
  all.span = all.word_span = here(span);
  for (std::uint32_t i = module.begin; i < module.end; ++i) {
    const Statement& statement = tree_.statements[i];
    if (statement.kind != Statement::Kind::Object) continue;
    if (!out_.values[i]) throw Failure();
    const Value& value = *out_.values[i];
    const Values nodes = value.is(Type::List) ? Values(value.list->of) : Values(&value, 1);
    for (const Value& one : nodes) {
      all.of.push_back(one.node);
      if (statement.label.empty()) continue;
      Node named;
      named.span = named.word_span = one.node->span;
      named.of = {one.node};
      named.fields.push_back({"name", statement.name_span, text(statement.label, statement.name_span)});
      all.of.back() = node(std::move(named)).node;
    }
  }
  if (all.of.empty()) fail("E0107", span, "the file has no object", {"its functions are called by name"});
  objects_[number] = node(std::move(all));
  return *objects_[number];
}

}  // namespace fathom::compiler::text
