#include "compiler/frontend/text/parse/expression_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "compiler/frontend/text/parse/vocabulary.h"

namespace fathom::compiler::text {

struct Operator {
  std::string_view mark;
  int precedence;
  Expr::Kind kind;
};

namespace {

// Levels in addition to those of a formula: the statement, and the call that the formula is an argument of.
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

// Limits the depth of an expression. Deeper expressions would overflow the stack here or in code that walks the tree.
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

// Every recursion passes through here.
Expr* ExpressionParser::nested(Reader read) {
  if (depth_ > limits_.formula_nesting + kRoom) return too_deep(peek().span);
  ++depth_;
  Expr* made = (this->*read)();
  --depth_;
  return made;
}

Expr* ExpressionParser::expression() { return nested(&ExpressionParser::any); }
Expr* ExpressionParser::any() {
  if (peek().is_word("if")) return choice();
  if (peek().is_word("let")) return bindings();
  if (peek().is_word("fold")) return fold();
  return bounded(operation(kLoosest));
}

// Grammar: if expr then expr else expr. Each `else if` is one level of recursion.
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

// Expects the `=` between a name and its value.
bool ExpressionParser::equals_sign() {
  if (!peek().is("(")) return expect("=", "after the name");
  unexpected("`=` is missing after the name", {"functions are statements of their own: def name(a, b) = ..."});
  return false;
}

// Grammar: let NAME = expr { let NAME = expr } in expr
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

// Grammar: fold NAME = expr for NAME in expr : expr
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

// Parses operators of precedence `least` or higher.
Expr* ExpressionParser::operation(int least) {
  Expr* left = sign();
  while (left != nullptr) {
    const Operator* row = find_operator(peek());
    if (row == nullptr || row->precedence < least) {
      if (begins_value(peek())) return missing_operator(left, least);
      return left;
    }
    left = row->precedence >= kRow ? gather(left, row->precedence) : pair(left, *row);
  }
  return nullptr;
}

Expr* ExpressionParser::missing_operator(Expr* left, int least) {
  const Token& token = peek();
  const bool unit = token.is_word("deg") || token.is_word("rad");
  const bool product = left->kind == Expr::Kind::Number, named = left->kind == Expr::Kind::Name;
  // Probably the end of a range.
  if (least == kRow && product) {
    return unexpected("`:` or an operator is missing before it", {"such as [for i in 0..3: sphere(i)]"});
  }
  return unexpected(
      "an operator is missing before it",
      {unit      ? "units are not written: angles of a scene are in degrees, those of sin, cos and tan in radians"
       : product ? "for a product write a*b"
       : named && find_word(left->name)             ? "a call has parentheses: sphere(1)"
       : named && token.kind == Token::Kind::Number ? "an argument by name is written name = value"
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

// Parses a chain of operators such as a + b - c. A chain of any length is one row.
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

// False, after a report, for a mixture such as `a + b & c`, which readers would parse in two ways.
bool ExpressionParser::is_clear(const std::vector<Joint>& joints) {
  const auto meets = [](const Joint& joint) { return joint.mark == '&'; };
  const auto both = std::ranges::find_if(joints, [&](const Joint& j) { return meets(j) != meets(joints[0]); });
  if (both == joints.end()) return true;
  diagnostics_.error("E0813", both->span, fmt::format("`{}` beside `{}`", both->mark, joints[0].mark), "",
                     {"say which comes first: (a + b) & c or a + (b & c)"});
  return false;
}

// Grammar: { expr } or { NAME = expr, ... }
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

Expr* ExpressionParser::sign() {
  if (peek().is("-") || peek().is("!")) {
    const Token& mark = take();
    Expr* operand = nested(&ExpressionParser::sign);
    if (operand == nullptr) return nullptr;
    return make(mark.is("-") ? Expr::Kind::Negate : Expr::Kind::Not, join(mark.span, operand->span), {operand});
  }
  Expr* base = postfix();
  if (base == nullptr || !take_if("^")) return base;
  Expr* exponent = nested(&ExpressionParser::sign);
  return exponent ? make(Expr::Kind::Power, join(base->span, exponent->span), {base, exponent}) : nullptr;
}

}  // namespace fathom::compiler::text
