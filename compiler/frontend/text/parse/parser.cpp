#include "compiler/frontend/text/parse/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/frontend/syntax/suggest.h"
#include "compiler/frontend/text/parse/expression_parser.h"

namespace fathom::compiler::text {
namespace {

class StatementParser : public ExpressionParser {
 public:
  using ExpressionParser::ExpressionParser;

  ParsedFile run() {
    ParsedFile file;
    file.tokens = tokens_.size();
    header();
    while (tokens_[at_].kind != Token::Kind::End && !diagnostics_.full()) {
      column_ = tokens_[at_].column;
      inside_ = false;
      const Token& first = tokens_[at_];
      std::optional<Statement> made = statement();
      const bool good = made.has_value();
      if (good) file.statements.push_back(*std::move(made));
      if (is_over()) continue;
      if (good) report_rest(first);
      recover();
    }
    file.expressions = std::move(expressions_);
    return file;
  }

 private:
  void header() {
    if (!tokens_[at_].is_word("fathom")) {
      diagnostics_.error("E0105", tokens_[at_].span, "the version of the scene format is missing", "",
                         {fmt::format("a text begins with the line `fathom {}`", kTextVersion)});
      return;
    }
    const Token& version = tokens_[++at_];
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

  // Skips to the next line that can begin a statement.
  void recover() {
    while (tokens_[at_].kind != Token::Kind::End) {
      ++at_;
      if (tokens_[at_].first_on_line && tokens_[at_].column <= column_) return;
    }
  }

  // Returns how to write what other languages write with `=` or braces after a statement's first word.
  static std::vector<std::string> help_with_rest(std::string_view word, const Token& rest) {
    if (!rest.is("=") && !rest.is("{")) return {};
    if (word != "object") return {fmt::format("properties are in parentheses: {}(name = value)", word)};
    if (rest.is("{")) return {"operands are in parentheses: object union(a, b)"};
    return {"`let` gives a value a name; the name of an object is a text without `=`: object \"ball\" sphere(1)"};
  }

  // Reports tokens after the end of a statement.
  void report_rest(const Token& first) {
    const Token& rest = tokens_[at_];
    if (!rest.first_on_line || rest.column > column_) {
      unexpected("the statement ends before it", help_with_rest(first.text, rest));
      return;
    }
    diagnostics_.error("E0812", rest.span, fmt::format("a line that begins with `{}` and is not indented", rest.text),
                       "", {fmt::format("indent it further than `{}` to go on with that statement", first.text)});
  }

  std::optional<Statement> statement() {
    const Token& first = take();
    const auto* word = std::ranges::find_if(kStatementWords, [&](std::string_view w) { return first.is_word(w); });
    if (word == std::end(kStatementWords)) {
      report_no_statement(first);
      return std::nullopt;
    }
    inside_ = true;
    Statement out{};
    out.kind = static_cast<Statement::Kind>(word - std::begin(kStatementWords)), out.span = first.span;
    using enum Statement::Kind;
    const bool good = out.kind == Import                     ? import(out)
                      : out.kind == Param || out.kind == Let ? named(out)
                      : out.kind == Def                      ? definition(out)
                                                             : part(out);
    return good ? std::optional(std::move(out)) : std::nullopt;
  }

  void report_no_statement(const Token& first) {
    const std::vector<std::string_view> words(std::begin(kStatementWords), std::end(kStatementWords));
    std::vector<std::string> help;
    if (first.is_word("for") || first.is_word("if")) {
      help = {fmt::format("it stands in a list: object [{}: sphere(1)]",
                          first.is_word("for") ? "for i in 0..3" : "if n > 1")};
    } else if (first.kind == Token::Kind::Name && peek().is("=")) {
      help = {fmt::format("a name is given by `let {} = ...`", first.text)};
    } else if (suggest(first.text, words).empty() && peek().kind == Token::Kind::Name && tokens_[at_ + 1].is("=")) {
      help = {fmt::format("a name is given by `let {} = ...`", peek().text)};
    } else if (first.kind == Token::Kind::Name && suggest(first.text, words).empty() &&
               (peek().is("(") || find_word(first.text))) {
      help = {fmt::format("what is to be seen is an object: `object {}(...)`", first.text)};
    } else if (first.kind == Token::Kind::Name && peek().is(".")) {
      help = {fmt::format("what is to be seen is an object: `object {}...`", first.text)};
    } else {
      help = {did_you_mean(first.text, words)};
    }
    diagnostics_.error("E0801", first.span, fmt::format("`{}` begins no statement", first.text), "", std::move(help));
  }

  void label(Statement& out) {
    if (peek().kind != Token::Kind::Text) return;
    const Token& token = take();
    if (out.name.empty()) out.name_span = token.span;
    out.label = unquoted(token, diagnostics_);
  }

  // Grammar: import STRING [ record ] as NAME
  bool import(Statement& out) {
    if (peek().kind != Token::Kind::Text) {
      unexpected("the path of a file is missing", {"such as: import \"lib/gears.fathom\" as gears"});
      return false;
    }
    const Token& path = take();
    out.label = unquoted(path, diagnostics_), out.span = path.span;
    if (peek().is("(")) {
      Expr* values = record();
      if (values == nullptr) return false;
      out.fields = values->arguments, out.has_fields = true;
    }
    return expect_word("as", "after the path") && name(out.name, out.name_span, "a name");
  }

  // Grammar: param NAME [ STRING ] [ record ] = expr, let NAME [ STRING ] = expr
  bool named(Statement& out) {
    if (!name(out.name, out.name_span, "a name")) return false;
    label(out);
    if (out.kind == Statement::Kind::Param && peek().is("(")) {
      Expr* options = record();
      if (options == nullptr) return false;
      out.fields = options->arguments, out.has_fields = true;
    }
    return equals_sign() && (out.value = expression()) != nullptr;
  }

  // Grammar: def NAME ( [ NAME [ = expr ] { , NAME [ = expr ] } ] ) = expr
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

  // Grammar: object [ STRING ] [ ... ] expr, camera expr
  bool part(Statement& out) {
    const bool labelled = out.kind == Statement::Kind::Object || out.kind == Statement::Kind::Light;
    if (labelled) {
      label(out);
      out.is_spread = take_if("...");
    }
    if (peek().is("=") || peek().is("{")) {
      unexpected("a value is missing", help_with_rest(kStatementWords[static_cast<std::size_t>(out.kind)], peek()));
      return false;
    }
    return (out.value = expression()) != nullptr;
  }
};

}  // namespace

ParsedFile parse(const Source& source, Diagnostics& diagnostics, const Limits& limits) {
  return StatementParser(source, diagnostics, limits).run();
}

}  // namespace fathom::compiler::text
