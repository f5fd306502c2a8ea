// Recursive descent parser for the expressions of a text (compiler/frontend/text/parse/parser.h).
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "compiler/frontend/text/parse/token_cursor.h"
#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/limits.h"

namespace fathom::compiler::text {

struct Operator;

// Functions return nullptr after reporting an error.
class ExpressionParser : public TokenCursor {
 public:
  ExpressionParser(const Source& source, Diagnostics& diagnostics, const Limits& limits)
      : TokenCursor(source, diagnostics), limits_(limits) {}

 protected:
  Expr* expression();
  Expr* record();
  bool equals_sign();

  std::deque<Expr> expressions_;

 private:
  Expr* make(Expr::Kind kind, Span span, std::vector<Expr*> of = {});
  static Span join(Span a, Span b);
  Expr* bounded(Expr* made);
  std::nullptr_t too_deep(Span span);
  using Reader = Expr* (ExpressionParser::*)();
  Expr* nested(Reader read);
  Expr* any();
  Expr* choice();
  Expr* choice(Span begin, Expr* condition);
  Expr* bindings();
  Expr* fold();
  Expr* operation(int least);
  Expr* missing_operator(Expr* left, int least);
  Expr* pair(Expr* left, const Operator& row);
  Expr* gather(Expr* first, int precedence);
  bool is_clear(const std::vector<Joint>& joints);
  Expr* blend();
  bool add(Expr& to, Argument argument);
  bool close(Expr& made, std::string_view bracket);
  Expr* sign();
  Expr* postfix();
  Expr* member(Expr* of);
  bool call(Expr& made);
  Expr* primary();
  bool is_field() const;
  Expr* number();
  Expr* word();
  Expr* group();
  Expr* list();
  Expr* item();
  Expr* any_item();
  Expr* spread();
  Expr* loop();
  Expr* guard();

  const Limits& limits_;
  double depth_ = 0;  // current recursion depth
};

}  // namespace fathom::compiler::text
