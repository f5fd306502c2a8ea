#include "compiler/frontend/text/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "compiler/frontend/suggest.h"
#include "compiler/frontend/text/lexer.h"

namespace fathom::compiler::text {
namespace {

struct Keyword {
  std::string_view word;
  Statement::Kind kind;
};
constexpr Keyword kKeywords[] = {
    {"param", Statement::Kind::Param},   {"let", Statement::Kind::Let},
    {"def", Statement::Kind::Def},       {"object", Statement::Kind::Object},
    {"light", Statement::Kind::Light},   {"camera", Statement::Kind::Camera},
    {"film", Statement::Kind::Film},     {"render", Statement::Kind::Render},
    {"background", Statement::Kind::Background},
};
constexpr std::string_view kReserved[] = {"let", "in", "if", "then", "else", "for", "fold", "true", "false"};

bool is_reserved(std::string_view word) { return std::ranges::find(kReserved, word) != std::end(kReserved); }

// Levels beside those of a formula: of a statement and of the call that the formula is an argument of.
constexpr double kRoom = 8;
constexpr int kLoosest = 1, kRow = 5;  // precedences
struct Operator {
  std::string_view mark;
  int precedence;
  Expr::Kind kind;
};
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

class TextParser {
 public:
  TextParser(const Source& source, Diagnostics& diagnostics, const Limits& limits)
      : diagnostics_(diagnostics), limits_(limits), tokens_(read_tokens(source, diagnostics).tokens) {
    stop_.kind = Token::Kind::End;
  }

  Tree run() {
    header();
    while (tokens_[at_].kind != Token::Kind::End && !diagnostics_.full()) {
      column_ = tokens_[at_].column;
      inside_ = false;
      const Token& first = tokens_[at_];
      std::optional<Statement> made = statement();
      const bool good = made.has_value();
      if (good) tree_.statements.push_back(*std::move(made));
      if (is_over()) continue;
      if (good) report_rest(first);
      recover();
    }
    return std::move(tree_);
  }

 private:
  void header() {
    if (tokens_[at_].is_word("fathom")) ++at_;
    const Token& version = tokens_[at_];
    if (version.kind == Token::Kind::Number && version.value == kTextVersion) {
      ++at_;
      return;
    }
    const bool other = version.kind == Token::Kind::Number;
    diagnostics_.error("E0105", version.span,
                       other ? fmt::format("unknown version of the scene format {}", version.text)
                             : "the version of the scene format is missing",
                       "",
                       {fmt::format("this program reads `fathom {}`; a listing is for `fathom asm`", kTextVersion)});
    if (other) ++at_;
  }

  // Whether the statement ends before the next token.
  bool is_over() const {
    const Token& next = tokens_[at_];
    return next.kind == Token::Kind::End ||
           (next.kind == Token::Kind::Name && next.first_on_line && next.column <= column_);
  }

  // To the next line that can begin a statement.
  void recover() {
    while (tokens_[at_].kind != Token::Kind::End) {
      ++at_;
      if (tokens_[at_].first_on_line && tokens_[at_].column <= column_) return;
    }
  }

  // After a whole statement.
  void report_rest(const Token& first) {
    const Token& rest = tokens_[at_];
    if (!rest.first_on_line || rest.column > column_) {
      unexpected("the statement ends before it");
      return;
    }
    diagnostics_.error("E0812", rest.span, fmt::format("a line that begins with `{}` and is not indented", rest.text),
                       "", {fmt::format("indent it further than `{}` to go on with that statement", first.text)});
  }

  // The next token; an End where a line begins that the statement does not reach to.
  const Token& peek() const {
    const Token& token = tokens_[at_];
    if (!inside_ || !token.first_on_line || token.column > column_) return token;
    const bool closes = token.is(")") || token.is("]") || token.is("}");
    if (closes) return token;
    stop_.span = at_ > 0 ? Span{tokens_[at_ - 1].span.end, tokens_[at_ - 1].span.end} : token.span;
    return stop_;
  }
  const Token& after() const { return tokens_[std::min(at_ + 1, tokens_.size() - 1)]; }
  const Token& take() {
    const Token& token = peek();
    if (token.kind != Token::Kind::End) ++at_;
    return token;
  }
  bool take_if(std::string_view mark) {
    if (!peek().is(mark)) return false;
    ++at_;
    return true;
  }
  Span before() const { return tokens_[at_ - 1].span; }

  bool expect(std::string_view mark, const char* where) {
    if (take_if(mark)) return true;
    unexpected(fmt::format("`{}` is missing {}", mark, where));
    return false;
  }
  bool expect_word(std::string_view word, const char* where) {
    if (peek().is_word(word)) return take(), true;
    unexpected(fmt::format("`{}` is missing {}", word, where));
    return false;
  }

  std::nullptr_t unexpected(std::string label, std::vector<std::string> help = {}) {
    const Token& token = peek();
    const std::string what = token.kind != Token::Kind::End ? fmt::format("`{}` is not expected here", token.text)
                             : &token == &stop_             ? "the statement ends too early"
                                                            : "the file ends too early";
    diagnostics_.error(token.kind == Token::Kind::End ? "E0002" : "E0001", token.span, what, std::move(label),
                       std::move(help));
    return nullptr;
  }

  std::optional<Statement> statement() {
    const Token& first = take();
    const auto* row = std::ranges::find_if(kKeywords, [&](const Keyword& k) { return first.is_word(k.word); });
    if (row == std::end(kKeywords)) {
      report_no_statement(first);
      return std::nullopt;
    }
    inside_ = true;
    Statement out{};
    out.kind = row->kind, out.span = first.span;
    using enum Statement::Kind;
    const bool good = row->kind == Param || row->kind == Let ? named(out)
                      : row->kind == Def                     ? definition(out)
                                                             : part(out);
    return good ? std::optional(std::move(out)) : std::nullopt;
  }

  void report_no_statement(const Token& first) {
    std::vector<std::string_view> words;
    for (const Keyword& row : kKeywords) words.push_back(row.word);
    std::vector<std::string> help;
    if (first.kind == Token::Kind::Name && peek().is("=")) {
      help = {fmt::format("a name is given by `let {} = ...`", first.text)};
    } else if (first.kind == Token::Kind::Name && peek().is("(") && suggest(first.text, words).empty()) {
      help = {fmt::format("what is to be seen is an object: `object {}(...)`", first.text)};
    } else {
      help = {did_you_mean(first.text, words)};
    }
    diagnostics_.error("E0801", first.span, fmt::format("`{}` begins no statement", first.text), "", std::move(help));
  }

  bool name(std::string_view& text, Span& span, const char* what) {
    const Token& token = peek();
    if (token.kind != Token::Kind::Name || is_reserved(token.text)) {
      const bool reserved = token.kind == Token::Kind::Name;
      unexpected(fmt::format("{} is missing", what),
                 reserved ? std::vector{fmt::format("`{}` is a word of the language", token.text)}
                          : std::vector<std::string>{});
      return false;
    }
    text = token.text, span = token.span;
    ++at_;
    return true;
  }

  void label(Statement& out) {
    if (peek().kind != Token::Kind::Text) return;
    const Token& token = take();
    if (out.name.empty()) out.name_span = token.span;
    out.label = unquoted(token, diagnostics_);
  }

  // param NAME [ STRING ] [ record ] = expr, let NAME [ STRING ] = expr
  bool named(Statement& out) {
    if (!name(out.name, out.name_span, "a name")) return false;
    label(out);
    if (out.kind == Statement::Kind::Param && peek().is("(")) {
      Expr* options = record();
      if (options == nullptr) return false;
      out.fields = options->arguments, out.has_fields = true;
    }
    if (!expect("=", "after the name")) return false;
    return (out.value = expression()) != nullptr;
  }

  // def NAME ( [ NAME [ = expr ] { , NAME [ = expr ] } ] ) = expr
  bool definition(Statement& out) {
    if (!name(out.name, out.name_span, "a name") || !expect("(", "after the name")) return false;
    while (!peek().is(")")) {
      Argument parameter{};
      if (!name(parameter.name, parameter.name_span, "a parameter's name")) return false;
      if (take_if("=") && (parameter.value = expression()) == nullptr) return false;
      out.fields.push_back(parameter);
      if (!take_if(",")) break;
    }
    if (!expect(")", "after the parameters") || !expect("=", "before what the function is")) return false;
    return (out.value = expression()) != nullptr;
  }

  // object [ STRING ] [ ... ] expr, camera expr
  bool part(Statement& out) {
    const bool labelled = out.kind == Statement::Kind::Object || out.kind == Statement::Kind::Light;
    if (labelled) {
      label(out);
      out.is_spread = take_if("...");
    }
    return (out.value = expression()) != nullptr;
  }

  Expr* make(Expr::Kind kind, Span span, std::vector<Expr*> of = {}) {
    Expr& made = tree_.expressions.emplace_back();
    made.kind = kind, made.span = span, made.of = std::move(of);
    for (const Expr* part : made.of) made.depth = std::max(made.depth, part->depth + 1);
    return &made;
  }
  static Span join(Span a, Span b) { return {a.begin, std::max(a.end, b.end)}; }

  // Deeper than that neither this nor what walks the tree could go.
  Expr* bounded(Expr* made) {
    if (made == nullptr || made->depth <= limits_.formula_nesting + kRoom) return made;
    return too_deep(made->span);
  }
  std::nullptr_t too_deep(Span span) {
    diagnostics_.error("E0406", span,
                       fmt::format("the expression is nested more than {} deep", limits_.formula_nesting), "",
                       {"give inner parts names of their own with `let`"});
    return nullptr;
  }

  // Every recursion comes through here, inner_sign() or item().
  Expr* expression() {
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
  Expr* choice() {
    const Span begin = take().span;
    Expr* condition = expression();
    return condition ? choice(begin, condition) : nullptr;
  }
  Expr* choice(Span begin, Expr* condition) {
    if (!expect_word("then", "after the condition of `if`")) return nullptr;
    Expr* yes = expression();
    if (yes == nullptr || !expect_word("else", "for when the condition is false")) return nullptr;
    Expr* no = expression();
    if (no == nullptr) return nullptr;
    return bounded(make(Expr::Kind::If, join(begin, no->span), {condition, yes, no}));
  }

  // let NAME = expr { let NAME = expr } in expr
  Expr* bindings() {
    const Span begin = peek().span;
    std::vector<Argument> names;
    std::uint32_t depth = 0;
    while (peek().is_word("let")) {
      take();
      Argument binding{};
      if (!name(binding.name, binding.name_span, "a name") || !expect("=", "after the name")) return nullptr;
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
  Expr* fold() {
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
  Expr* operation(int least) {
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

  bool begins_value(const Token& token) const {
    return token.kind == Token::Kind::Number || token.kind == Token::Kind::Text ||
           (token.kind == Token::Kind::Name && !is_reserved(token.text));
  }

  Expr* missing_operator(Expr* left) {
    const Token& token = peek();
    const bool unit = token.is_word("deg") || token.is_word("rad");
    const bool product = left->kind == Expr::Kind::Number;
    return unexpected(
        "an operator is missing before it",
        {unit ? "units are not written: angles of a scene are in degrees, those of sin, cos and tan in radians"
         : product ? "for a product write a*b"
                   : "a statement begins on a line of its own"});
  }

  Expr* pair(Expr* left, const Operator& row) {
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
  Expr* gather(Expr* first, int precedence) {
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
  bool is_clear(const std::vector<Joint>& joints) {
    const auto meets = [](const Joint& joint) { return joint.mark == '&'; };
    const auto both = std::ranges::find_if(joints, [&](const Joint& j) { return meets(j) != meets(joints[0]); });
    if (both == joints.end()) return true;
    diagnostics_.error("E0813", both->span, fmt::format("`{}` beside `{}`", both->mark, joints[0].mark), "",
                       {"say which comes first: (a + b) & c or a + (b & c)"});
    return false;
  }

  // { expr } or { NAME = expr, ... }
  Expr* blend() {
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

  bool add(Expr& to, Argument argument) {
    argument.value = expression();
    if (argument.value == nullptr) return false;
    to.depth = std::max(to.depth, argument.value->depth + 1);
    to.arguments.push_back(argument);
    return true;
  }

  // `made` begins with the bracket.
  bool close(Expr& made, std::string_view bracket) {
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

  Expr* sign() {
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
  Expr* inner_sign() {
    if (depth_ > limits_.formula_nesting + kRoom) return too_deep(peek().span);
    ++depth_;
    Expr* made = sign();
    --depth_;
    return made;
  }

  Expr* postfix() {
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
  Expr* member(Expr* of) {
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
  bool call(Expr& made) {
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

  Expr* primary() {
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

  bool is_field() const { return at_ + 2 < tokens_.size() && tokens_[at_ + 2].is("="); }

  Expr* number() {
    const Token& token = take();
    if (!std::isfinite(token.value)) {
      diagnostics_.error("E0009", token.span, fmt::format("the number `{}` is too large", token.text));
      return nullptr;
    }
    Expr* made = make(Expr::Kind::Number, token.span);
    made->number = token.value, made->name = token.text;
    return made;
  }

  Expr* word() {
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

  Expr* group() {
    Expr* made = make(Expr::Kind::Record, take().span);
    Expr* inner = expression();
    if (inner == nullptr || !close(*made, ")")) return nullptr;
    ++inner->groups;
    return inner;
  }

  // ( [ NAME = expr { , NAME = expr } ] )
  Expr* record() {
    Expr* made = make(Expr::Kind::Record, take().span);
    while (!peek().is(")")) {
      Argument field{};
      if (!name(field.name, field.name_span, "a field's name") || !expect("=", "after the field's name")) return nullptr;
      if (!add(*made, field)) return nullptr;
      if (!take_if(",")) break;
    }
    return close(*made, ")") ? made : nullptr;
  }

  Expr* list() {
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
  Expr* item() {
    if (depth_ > limits_.formula_nesting + kRoom) return too_deep(peek().span);
    ++depth_;
    Expr* made = peek().is_word("for")  ? loop()
                       : peek().is_word("if") ? guard()
                       : peek().is("...")     ? spread()
                                              : expression();
    --depth_;
    return bounded(made);
  }

  Expr* spread() {
    const Span begin = take().span;
    Expr* list = expression();
    return list ? make(Expr::Kind::Spread, join(begin, list->span), {list}) : nullptr;
  }

  Expr* loop() {
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
  Expr* guard() {
    const Span begin = take().span;
    Expr* condition = expression();
    if (condition == nullptr) return nullptr;
    if (peek().is_word("then")) return choice(begin, condition);
    if (!expect(":", "after the condition of an element")) return nullptr;
    Expr* each = item();
    return each ? make(Expr::Kind::Guard, join(begin, each->span), {condition, each}) : nullptr;
  }

  Diagnostics& diagnostics_;
  const Limits& limits_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::uint32_t column_ = 0;  // of the statement's first word
  bool inside_ = false;       // of a statement
  double depth_ = 0;
  mutable Token stop_{};
  Tree tree_;
};

}  // namespace

bool is_text_scene(std::string_view text) { return first_word(text) == "fathom"; }

Tree parse(const Source& source, Diagnostics& diagnostics, const Limits& limits) {
  return TextParser(source, diagnostics, limits).run();
}

}  // namespace fathom::compiler::text
