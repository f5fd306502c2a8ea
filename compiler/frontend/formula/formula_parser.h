// Parser for one line of a formula, used by read_formula().
// Tested by: tests/compiler/frontend/formula/formula_test.cpp, formula_errors_test.cpp, tests/golden/diagnostics (E04xx)
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/frontend/formula/formula_builder.h"
#include "compiler/frontend/formula/formula_functions.h"
#include "compiler/frontend/formula/formula_lexer.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

struct NameHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view name) const { return std::hash<std::string_view>()(name); }
};

// State shared by the lines of a formula.
struct FormulaContext {
  const Scope& scope;
  std::vector<FormulaFunction> functions;
  bool has_point;  // true if x, y and z are defined
  Diagnostics& diagnostics;
  FormulaBuilder builder = {};
  std::unordered_map<std::string, FormulaId, NameHash, std::equal_to<>> definitions = {};
  bool may_have_point = false;  // true if the property could also vary over space, with x, y and z
  bool good = true;             // false after an error: the result cannot be used
};

// A line of a formula, and its place in the scene's source.
struct FormulaText {
  std::string_view text;
  Span span;  // of the string, including its quotes

  // Returns the span of a slice of `text`. An empty slice gets the span of the next character, which is the closing
  // quote at the end of the text.
  Span span_of(std::string_view part) const;
};

class FormulaParser {
 public:
  FormulaParser(const FormulaText& text, FormulaContext& context);

  // Parses "name =" at the beginning of the line. Returns nullopt after a report if there is no definition.
  std::optional<Token> definition();

  // Parses the rest of the line. Returns nullopt after an error that ended parsing. Unknown names and invalid calls
  // do not end parsing: the parser reports them, clears `good` of the context and inserts a placeholder.
  std::optional<FormulaId> expression_to_end();

 private:
  using Result = std::optional<FormulaId>;

  Result expression();
  Result term();
  Result factor();
  Result power();
  Result primary();
  Result parenthesis();
  Result name();
  Result call(const Token& name);
  FormulaId resolve(const Token& name);
  FormulaId stand_in(const Token& name);

  Token take();
  Span span(const Token& token) const { return text_.span_of(token.text); }
  Span join(Span from, Span to) const;
  Result operation(std::string_view function, FormulaId a, FormulaId b);

  Result too_deep();
  Result too_long();
  Result too_large(const Token& number);
  FormulaId unknown_function(const Token& name);
  FormulaId wrong_count(const Token& name, Span place, const FormulaFunction& function, std::size_t count);
  Result bare_function(const Token& name);
  Result no_value();
  Result not_closed(const Token& open);
  void report_rest();
  void report(const char* code, Span span, std::string message, std::string label = "",
              std::vector<std::string> help = {});

  FormulaText text_;
  FormulaContext& context_;
  FormulaLexer lexer_;
  Token next_;
  int depth_ = 0;
};

// Reports that x, y or z is used where no point is defined.
void report_no_point(std::string_view axis, Span span, Diagnostics& diagnostics);

// Returns the value of a named constant such as pi, or nullopt if the name is not a constant.
std::optional<double> formula_constant(std::string_view name);

// Returns the reason why a parameter or definition cannot have this name where formulas have these functions
// (compiler/frontend/formula/formula_functions.h), or "" if the name is valid.
std::string misfit_name(std::string_view name, std::span<const FormulaFunction> functions);

}  // namespace fathom::compiler
