// Parser for operands: numbers, words, calls, members, records and lists.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/frontend/text/parse/expression_parser.h"

namespace fathom::compiler::text {

Expr* ExpressionParser::postfix() {
  Expr* made = primary();
  while (made != nullptr) {
    if (peek().is("[")) {
      Expr* index = make(Expr::Kind::Index, take().span);
      Expr* number = expression();
      if (number == nullptr || !close(*index, "]")) return nullptr;
      index->of = {made, number};
      index->depth = std::max(made->depth, number->depth) + 1;
      index->span = join(made->span, index->span);
      made = index;
    } else if (peek().is(".")) {
      made = member(made);
    } else {
      return bounded(made);
    }
  }
  return nullptr;
}

// Grammar: .NAME or .NAME(arguments)
Expr* ExpressionParser::member(Expr* of) {
  take();
  std::string_view text;
  Span span;
  if (!name(text, span, "a name after `.`")) return nullptr;
  Expr* made = make(Expr::Kind::Member, join(of->span, span), {of});
  made->name = text, made->name_span = span;
  if (!peek().is("(")) return made;
  made->kind = Expr::Kind::Call;
  made->arguments.push_back({{}, {}, of});
  made->of.clear();
  return call(*made) ? made : nullptr;
}

// Parses the arguments and the closing bracket.
bool ExpressionParser::call(Expr& made) {
  const Span begin = made.span;
  made.span = take().span;
  bool named = false;
  while (!peek().is(")")) {
    Argument argument{};
    if (peek().kind == Token::Kind::Name && after().is("=")) {
      argument.name = peek().text, argument.name_span = peek().span;
      at_ += 2;
      named = true;
    } else if (named) {
      unexpected("arguments with a name come after those without");
      return false;
    }
    if (peek().is("...") && argument.name.empty()) {
      const Span mark = take().span;
      Expr* list = expression();
      if (list == nullptr) return false;
      argument.value = make(Expr::Kind::Spread, join(mark, list->span), {list});
      made.depth = std::max(made.depth, argument.value->depth + 1);
      made.arguments.push_back(argument);
    } else if (!add(made, argument)) {
      return false;
    }
    if (!take_if(",")) break;
  }
  const bool closed = close(made, ")");
  made.span = join(begin, made.span);
  return closed;
}

Expr* ExpressionParser::primary() {
  const Token& token = peek();
  switch (token.kind) {
    case Token::Kind::Number:
      return number();
    case Token::Kind::Text: {
      take();
      Expr* made = make(Expr::Kind::Text, token.span);
      made->text = unquoted(token, diagnostics_);
      return made;
    }
    case Token::Kind::Name:
      return word();
    case Token::Kind::Mark:
      if (token.is("[")) return list();
      if (token.is("("))
        return after().is(")") || (after().kind == Token::Kind::Name && is_field()) ? record() : group();
      break;
    case Token::Kind::End:
      break;
  }
  return unexpected("a value is missing");
}

bool ExpressionParser::is_field() const { return at_ + 2 < tokens_.size() && tokens_[at_ + 2].is("="); }

Expr* ExpressionParser::number() {
  const Token& token = take();
  if (!std::isfinite(token.value)) {
    diagnostics_.error("E0009", token.span, fmt::format("the number `{}` is too large", token.text));
    return nullptr;
  }
  Expr* made = make(Expr::Kind::Number, token.span);
  made->number = token.value, made->name = token.text;
  return made;
}

Expr* ExpressionParser::word() {
  const Token& token = peek();
  if (token.is_word("true") || token.is_word("false")) {
    Expr* made = make(Expr::Kind::Truth, take().span);
    made->number = token.is_word("true");
    return made;
  }
  if (token.is_word("if") || token.is_word("let") || token.is_word("fold")) {
    return unexpected("this goes into parentheses within an expression", {"write (if a then b else c)"});
  }
  if (is_reserved(token.text)) return unexpected("a value is missing");
  take();
  Expr* made = make(Expr::Kind::Name, token.span);
  made->name = token.text, made->name_span = token.span;
  if (!peek().is("(")) return made;
  made->kind = Expr::Kind::Call;
  return call(*made) ? made : nullptr;
}

Expr* ExpressionParser::group() {
  Expr* made = make(Expr::Kind::Record, take().span);
  Expr* inner = expression();
  if (inner == nullptr || !close(*made, ")")) return nullptr;
  ++inner->groups;
  return inner;
}

// Parses the value of `argument` and appends the argument to `to`.
bool ExpressionParser::add(Expr& to, Argument argument) {
  argument.value = expression();
  if (argument.value == nullptr) return false;
  to.depth = std::max(to.depth, argument.value->depth + 1);
  to.arguments.push_back(argument);
  return true;
}

// Expects the closing bracket. The span of `made` begins with the opening bracket.
bool ExpressionParser::close(Expr& made, std::string_view bracket) {
  if (take_if(bracket)) {
    made.span.end = before().end;
    return true;
  }
  const Token& token = peek();
  if (token.kind == Token::Kind::End) {
    diagnostics_.error("E0002", made.span, fmt::format("the bracket is never closed: `{}` is missing", bracket));
  } else if (begins_value(token)) {
    unexpected("`,` or an operator is missing before it");
  } else {
    unexpected(fmt::format("`{}` or `,` is missing before it", bracket));
  }
  return false;
}

// Grammar: ( [ NAME = expr { , NAME = expr } ] )
Expr* ExpressionParser::record() {
  Expr* made = make(Expr::Kind::Record, take().span);
  while (!peek().is(")")) {
    Argument field{};
    if (!name(field.name, field.name_span, "a field's name") || !expect("=", "after the field's name"))
      return nullptr;
    if (!add(*made, field)) return nullptr;
    if (!take_if(",")) break;
  }
  return close(*made, ")") ? made : nullptr;
}

Expr* ExpressionParser::list() {
  Expr* made = make(Expr::Kind::List, take().span);
  while (!peek().is("]")) {
    Expr* part = item();
    if (part == nullptr) return nullptr;
    made->of.push_back(part);
    made->depth = std::max(made->depth, part->depth + 1);
    if (!take_if(",")) break;
  }
  return close(*made, "]") ? made : nullptr;
}

// Grammar: for NAME in expr : item, if expr : item, ...expr or expr
Expr* ExpressionParser::item() { return bounded(nested(&ExpressionParser::any_item)); }
Expr* ExpressionParser::any_item() {
  if (peek().is_word("for")) return loop();
  if (peek().is_word("if")) return guard();
  if (peek().is("...")) return spread();
  return expression();
}

Expr* ExpressionParser::spread() {
  const Span begin = take().span;
  Expr* list = expression();
  return list ? make(Expr::Kind::Spread, join(begin, list->span), {list}) : nullptr;
}

Expr* ExpressionParser::loop() {
  const Span begin = take().span;
  std::string_view text;
  Span span;
  if (!name(text, span, "a name") || !expect_word("in", "after the name")) return nullptr;
  Expr* over = expression();
  if (over == nullptr || !expect(":", "before what is made each time")) return nullptr;
  Expr* each = item();
  if (each == nullptr) return nullptr;
  Expr* made = make(Expr::Kind::For, join(begin, each->span), {over, each});
  made->name = text, made->name_span = span;
  return made;
}

// Parses `if a: item`, or the expression `if a then b else c`.
Expr* ExpressionParser::guard() {
  const Span begin = take().span;
  Expr* condition = expression();
  if (condition == nullptr) return nullptr;
  if (peek().is_word("then")) return choice(begin, condition);
  if (!expect(":", "after the condition of an element")) return nullptr;
  Expr* each = item();
  return each ? make(Expr::Kind::Guard, join(begin, each->span), {condition, each}) : nullptr;
}

}  // namespace fathom::compiler::text
