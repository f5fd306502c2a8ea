// One line of a formula: the parser behind read_formula().
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

// What the lines of a formula share.
struct FormulaContext {
  const Scope& scope;
  std::vector<FormulaFunction> functions;
  bool has_point;  // whether there are x, y and z
  Diagnostics& diagnostics;
  FormulaBuilder builder = {};
  std::unordered_map<std::string, FormulaId, NameHash, std::equal_to<>> definitions = {};
  bool may_have_point = false;  // whether x, y and z could have been used
  bool good = true;             // whether the result can be used
};

// Where a line's characters are in the scene's text.
struct FormulaText {
  std::string_view text;
  Span span;  // of the string with its quotes

  // An empty part is given the character after it, the closing quote at the text's end.
  Span span_of(std::string_view part) const;
};

class FormulaParser {
 public:
  FormulaParser(const FormulaText& text, FormulaContext& context);

  // "name =" at the line's begin; nullopt, after a report, when there is none.
  std::optional<Token> definition();

  // The rest of the line; nullopt after an error that ended the reading. Unknown names and calls do not: they are
  // reported, spoil the context's `good`, and something stands in for them.
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

// Reports that x, y or z is used where there is no point.
void report_no_point(std::string_view axis, Span span, Diagnostics& diagnostics);

// The value of a constant of formulas, such as pi; nullopt when the name is none.
std::optional<double> formula_constant(std::string_view name);

// What is wrong with giving this name to a parameter or a definition where formulas have these functions
// (compiler/frontend/formula/formula_functions.h); empty when nothing is.
std::string misfit_name(std::string_view name, std::span<const FormulaFunction> functions);

}  // namespace fathom::compiler
