#include "compiler/frontend/text/expression_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace fathom::compiler::text {

struct Operator {
  std::string_view mark;
  int precedence;
  Expr::Kind kind;
};

namespace {

// Levels beside those of a formula: of a statement and of the call that the formula is an argument of.
constexpr double kRoom = 8;
constexpr int kLoosest = 1, kRow = 5;  // precedences

constexpr Operator kOperators[] = {
    {"||", 1, Expr::Kind::Or},      {"&&", 2, Expr::Kind::And},     {"<", 3, Expr::Kind::Compare},
    {"<=", 3, Expr::Kind::Compare}, {">", 3, Expr::Kind::Compare},  {">=", 3, Expr::Kind::Compare},
    {"==", 3, Expr::Kind::Compare}, {"!=", 3, Expr::Kind::Compare}, {"..", 4, Expr::Kind::Range},
    {"+", 5, Expr::Kind::Row},      {"-", 5, Expr::Kind::Row},      {"&", 5, Expr::Kind::Row},
    {"*", 6, Expr::Kind::Row},      {"/", 6, Expr::Kind::Row},
};

const Operator* find_operator(const Token& token) {
  if (token.kind != Token::Kind::Mark) return nullptr;
  for (const Operator& row : kOperators) {
    if (row.mark == token.text) return &row;
  }
  return nullptr;
}

}  // namespace

Expr* ExpressionParser::make(Expr::Kind kind, Span span, std::vector<Expr*> of) {
  Expr& made = expressions_.emplace_back();
  made.kind = kind, made.span = span, made.of = std::move(of);
  for (const Expr* part : made.of) made.depth = std::max(made.depth, part->depth + 1);
  return &made;
}
Span ExpressionParser::join(Span a, Span b) { return {a.begin, std::max(a.end, b.end)}; }

// Deeper than that neither this nor what walks the tree could go.
Expr* ExpressionParser::bounded(Expr* made) {
  if (made == nullptr || made->depth <= limits_.formula_nesting + kRoom) return made;
  return too_deep(made->span);
}
std::nullptr_t ExpressionParser::too_deep(Span span) {
  diagnostics_.error("E0406", span,
                     fmt::format("the expression is nested more than {} deep", limits_.formula_nesting), "",
                     {"give inner parts names of their own with `let`"});
  return nullptr;
}

// Every recursion comes through here, inner_sign() or item().
Expr* ExpressionParser::expression() {
  if (depth_ > limits_.formula_nesting + kRoom) return too_deep(peek().span);
  ++depth_;
  Expr* made = peek().is_word("if")     ? choice()
                     : peek().is_word("let")  ? bindings()
                     : peek().is_word("fold") ? fold()
                                              : bounded(operation(kLoosest));
  --depth_;
  return made;
}

// if expr then expr else expr; those in a row of else are one level of this.
Expr* ExpressionParser::choice() {
  const Span begin = take().span;
  Expr* condition = expression();
  return condition ? choice(begin, condition) : nullptr;
}
Expr* ExpressionParser::choice(Span begin, Expr* condition) {
  if (!expect_word("then", "after the condition of `if`")) return nullptr;
  Expr* yes = expression();
  if (yes == nullptr || !expect_word("else", "for when the condition is false")) return nullptr;
  Expr* no = expression();
  if (no == nullptr) return nullptr;
  return bounded(make(Expr::Kind::If, join(begin, no->span), {condition, yes, no}));
}

// Between a name and its value.
bool ExpressionParser::equals_sign() {
  if (!peek().is("(")) return expect("=", "after the name");
  unexpected("`=` is missing after the name", {"functions are statements of their own: def name(a, b) = ..."});
  return false;
}

// let NAME = expr { let NAME = expr } in expr
Expr* ExpressionParser::bindings() {
  const Span begin = peek().span;
  std::vector<Argument> names;
  std::uint32_t depth = 0;
  while (peek().is_word("let")) {
    take();
    Argument binding{};
    if (!name(binding.name, binding.name_span, "a name")) return nullptr;
    if (!equals_sign()) return nullptr;
    if ((binding.value = expression()) == nullptr) return nullptr;
    depth = std::max(depth, binding.value->depth);
    names.push_back(binding);
  }
  if (!expect_word("in", "after `let name = ...` within an expression")) return nullptr;
  Expr* value = expression();
  if (value == nullptr) return nullptr;
  Expr* made = make(Expr::Kind::Let, join(begin, value->span), {value});
  made->arguments = std::move(names);
  made->depth = std::max(made->depth, depth + 1);
  return bounded(made);
}

// fold NAME = expr for NAME in expr : expr
Expr* ExpressionParser::fold() {
  const Span begin = take().span;
  std::string_view result;
  Span result_span;
  Argument element{};
  if (!name(result, result_span, "a name") || !expect("=", "after the name")) return nullptr;
  Expr* first = expression();
  if (first == nullptr || !expect_word("for", "after the first value of `fold`")) return nullptr;
  if (!name(element.name, element.name_span, "a name") || !expect_word("in", "after the name")) return nullptr;
  Expr* over = expression();
  if (over == nullptr || !expect(":", "before what is done each time")) return nullptr;
  Expr* each = expression();
  if (each == nullptr) return nullptr;
  Expr* made = make(Expr::Kind::Fold, join(begin, each->span), {first, over, each});
  made->name = result, made->name_span = result_span;
  made->arguments.push_back(element);
  return bounded(made);
}

// Operators that bind as tightly as `least` or tighter.
Expr* ExpressionParser::operation(int least) {
  Expr* left = sign();
  while (left != nullptr) {
    const Operator* row = find_operator(peek());
    if (row == nullptr || row->precedence < least) {
      if (begins_value(peek())) return missing_operator(left);
      return left;
    }
    left = row->precedence >= kRow ? gather(left, row->precedence) : pair(left, *row);
  }
  return nullptr;
}

Expr* ExpressionParser::missing_operator(Expr* left) {
  const Token& token = peek();
  const bool unit = token.is_word("deg") || token.is_word("rad");
  const bool product = left->kind == Expr::Kind::Number;
  return unexpected(
      "an operator is missing before it",
      {unit ? "units are not written: angles of a scene are in degrees, those of sin, cos and tan in radians"
       : product ? "for a product write a*b"
                 : "a statement begins on a line of its own"});
}

Expr* ExpressionParser::pair(Expr* left, const Operator& row) {
  const Token& mark = take();
  Expr* right = operation(row.precedence + 1);
  if (right == nullptr) return nullptr;
  Expr* made = make(row.kind, join(left->span, right->span), {left, right});
  made->name = mark.text, made->name_span = mark.span;
  const Operator* next = find_operator(peek());
  if (next && next->precedence == row.precedence && (row.kind == Expr::Kind::Compare || row.kind == Expr::Kind::Range)) {
    return unexpected("only two values can be compared", {"write a < b && b < c"});
  }
  return made;
}

// a + b - c: one row, however long it is.
Expr* ExpressionParser::gather(Expr* first, int precedence) {
  std::vector<Expr*> of = {first};
  std::vector<Joint> joints;
  while (const Operator* row = find_operator(peek())) {
    if (row->precedence != precedence) break;
    const Token& mark = take();
    Joint joint{mark.text[0], mark.span};
    if (precedence == kRow && peek().is("{")) {
      if ((joint.blend = blend()) == nullptr) return nullptr;
      joint.span.end = before().end;
    }
    Expr* next = operation(precedence + 1);
    if (next == nullptr) return nullptr;
    joints.push_back(joint), of.push_back(next);
  }
  if (!is_clear(joints)) return nullptr;
  const Span span = join(first->span, of.back()->span);
  Expr* made = make(Expr::Kind::Row, span, std::move(of));
  made->joints = std::move(joints);
  return made;
}

// `a + b & c` would be read in two ways.
bool ExpressionParser::is_clear(const std::vector<Joint>& joints) {
  const auto meets = [](const Joint& joint) { return joint.mark == '&'; };
  const auto both = std::ranges::find_if(joints, [&](const Joint& j) { return meets(j) != meets(joints[0]); });
  if (both == joints.end()) return true;
  diagnostics_.error("E0813", both->span, fmt::format("`{}` beside `{}`", both->mark, joints[0].mark), "",
                     {"say which comes first: (a + b) & c or a + (b & c)"});
  return false;
}

// { expr } or { NAME = expr, ... }
Expr* ExpressionParser::blend() {
  Expr* made = make(Expr::Kind::Record, take().span);
  do {
    Argument field{};
    if (peek().kind == Token::Kind::Name && after().is("=")) {
      field.name = peek().text, field.name_span = peek().span;
      at_ += 2;
    }
    if (!add(*made, field)) return nullptr;
  } while (take_if(","));
  return close(*made, "}") ? made : nullptr;
}

bool ExpressionParser::add(Expr& to, Argument argument) {
  argument.value = expression();
  if (argument.value == nullptr) return false;
  to.depth = std::max(to.depth, argument.value->depth + 1);
  to.arguments.push_back(argument);
  return true;
}

// `made` begins with the bracket.
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

Expr* ExpressionParser::sign() {
  if (peek().is("-") || peek().is("!")) {
    const Token& mark = take();
    Expr* operand = inner_sign();
    if (operand == nullptr) return nullptr;
    return make(mark.is("-") ? Expr::Kind::Negate : Expr::Kind::Not, join(mark.span, operand->span), {operand});
  }
  Expr* base = postfix();
  if (base == nullptr || !take_if("^")) return base;
  Expr* exponent = inner_sign();
  return exponent ? make(Expr::Kind::Power, join(base->span, exponent->span), {base, exponent}) : nullptr;
}

// A sign or a power within one.
Expr* ExpressionParser::inner_sign() {
  if (depth_ > limits_.formula_nesting + kRoom) return too_deep(peek().span);
  ++depth_;
  Expr* made = sign();
  --depth_;
  return made;
}

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

// .NAME or .NAME(arguments)
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

// The arguments and the bracket after them.
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
      if (token.is("(")) return after().is(")") || (after().kind == Token::Kind::Name && is_field()) ? record() : group();
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

// ( [ NAME = expr { , NAME = expr } ] )
Expr* ExpressionParser::record() {
  Expr* made = make(Expr::Kind::Record, take().span);
  while (!peek().is(")")) {
    Argument field{};
    if (!name(field.name, field.name_span, "a field's name") || !expect("=", "after the field's name")) return nullptr;
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

// for NAME in expr : item, if expr : item, ...expr or expr
Expr* ExpressionParser::item() {
  if (depth_ > limits_.formula_nesting + kRoom) return too_deep(peek().span);
  ++depth_;
  Expr* made = peek().is_word("for")  ? loop()
                     : peek().is_word("if") ? guard()
                     : peek().is("...")     ? spread()
                                            : expression();
  --depth_;
  return bounded(made);
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

// `if a: item`, or `if a then b else c`, which is an expression.
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
