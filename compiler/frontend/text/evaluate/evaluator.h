// Class of the evaluator. Its parts are in statements.cpp, evaluate.cpp (expressions), arithmetic.cpp (operators),
// calls.cpp (functions), values.cpp and spelling.cpp. An error ends the current statement with an exception, which
// does not leave evaluate().
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compiler/frontend/records/parameters.h"
#include "compiler/frontend/text/evaluate/evaluated.h"
#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler::text {

// Thrown after reporting an error.
struct Failure {};

class Evaluator {
 public:
  Evaluator(const Tree& tree, const Definitions& definitions, const Limits& limits, bool keep_formulas,
            Diagnostics& diagnostics);
  Evaluated run(const std::vector<std::uint32_t>& order);

 private:
  using Type = Value::Type;
  using Values = std::span<const Value>;

  // statements.cpp
  void run_statement(std::uint32_t number);
  Value run_parameter(const Statement& statement);
  Value run_import(const Statement& statement);
  const Value* given_value(const Statement& parameter);
  Value objects_of(std::uint32_t module, Span span);
  Value another_name(const Node& of);
  Value object(const Statement& statement, const Value& value);

  // evaluate.cpp
  Value evaluate(const Expr& expr);
  Value evaluate_name(const Expr& expr);
  Value evaluate_if(const Expr& expr);
  Value evaluate_let(const Expr& expr);
  Value evaluate_fold(const Expr& expr);
  Value evaluate_list(const Expr& expr);
  void add_items(const Expr& item, std::vector<Value>& to);
  void add_each(const Expr& loop, std::vector<Value>& to);
  Value evaluate_index(const Expr& expr);
  Value evaluate_member(const Expr& expr);
  Value evaluate_record(const Expr& expr);
  Field field_of(const Argument& argument);
  Value evaluate_range(const Expr& expr);
  const List& list_of(const Value& value, const char* what);
  void take_step(Span span);
  void enter(const Expr& by, Span name, const Value* element);
  Value& local(std::uint32_t slot) { return locals_[base_ + slot]; }
  void bind(const Value& value, std::string_view name);

  // arithmetic.cpp
  Value evaluate_row(const Expr& expr);
  Value evaluate_numbers(const Expr& expr, const Value& first);
  Value evaluate_nodes(const Expr& expr, const Value& first);
  void combine(const Joint& joint, const std::vector<Field>& blend, Node& made);
  Value negate(const Value& value, Span span);
  Value power(const Value& base, const Value& exponent, Span span);
  Value compare(const Expr& expr);
  Value operate(char mark, const Value& a, const Value& b, Span span);
  Value formula_of_pair(char mark, const Value& a, const Value& b, Span span);
  Value elementwise(char mark, const Value& a, const Value& b, Span span);
  bool condition(const Expr& expr);

  // calls.cpp
  Value call(const Expr& expr);
  Value call_definition(const Expr& expr, const Statement& definition);
  Value call_formula(const Expr& expr, Values arguments);
  Value apply_function(const FormulaFunction& function, Values arguments, Span span);
  Value call_builtin(const Expr& expr, Values arguments);
  Value call_random(const Expr& expr, Values arguments);
  Value call_require(const Expr& expr);
  Value call_record(const Expr& expr);
  Value make_node(const Expr& expr, Values arguments);
  void add_operands(const Expr& expr, Values arguments, Node& node);
  static bool is_spread_vector(const NodeSpec& node, Values arguments);
  void add_positional(const Expr& expr, Values arguments, Node& node);
  void add_field(const Argument& argument, const Value& value, Node& node);
  Value place(const Expr& expr, Values arguments);
  Value rotation(const Expr& expr);
  std::vector<Value> positional_arguments(const Expr& expr);

  // spelling.cpp
  void spell_name(Value& value, std::string_view name, bool parametric);
  void spell_number(Value& value, std::string_view text);
  void spell_sign(Value& value, const Value& operand);
  void spell_pair(Value& value, char mark, const Value& a, const Value& b);
  void spell_call(Value& value, std::string_view function, Values arguments);
  void spell_group(Value& value);
  void spell_line(Value& value, std::string_view name);
  void keep_lines(Value& value, Values bindings);
  void freeze(const Value& value, Span span);
  const Spelling* spelling_of(const Value& value);
  void spell(Value& value, Spelling made);
  void note_frozen(Span span);

  // values.cpp
  Span here(Span span) const { return {span.begin, span.end, trace_}; }
  Value number(double value, Span span) const;
  Value truth(bool value, Span span) const;
  Value formula(FormulaId id, Span span);
  Value text(const std::string& value, Span span);
  Value list(std::vector<Value> of, Span span);
  Value record(Record made);
  Value node(Node made);
  FormulaId formula_of(const Value& value);
  static bool is_number(const Value& value) { return value.is(Type::Number) || value.is(Type::Formula); }
  static bool is_node(const Value& value);
  const Node* node_of(const Value& value, const char* what);
  double constant(const Value& value, const char* what);
  void check_depth(std::uint32_t depth, Span span);

  [[noreturn]] void fail(const char* code, Span span, std::string message, std::vector<std::string> help = {},
                         std::string label = "");

  const Tree& tree_;
  const Definitions& definitions_;
  const Limits& limits_;
  const double made_nodes_;  // a text of many words is known to be large
  const bool keep_formulas_;
  Diagnostics& diagnostics_;
  Evaluated out_;
  std::vector<Scope> scopes_;                  // [module] parameters of imports
  std::vector<std::optional<Value>> objects_;  // [module] union of the objects, computed on demand
  std::vector<Value> locals_;                  // of all active calls
  std::size_t base_ = 0;                       // index of the innermost call's locals
  double steps_ = 0, depth_ = 0;
  std::uint32_t trace_ = 0;  // the innermost call or loop, among the traces of the diagnostics
};

}  // namespace fathom::compiler::text
