#include "compiler/frontend/text/format.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "compiler/frontend/text/parse/lexer.h"

namespace fathom::compiler::text {
namespace {

constexpr std::size_t kIndentation = 2;  // columns

// Token or comment, in the order of the text.
struct Item {
  const Token* token;  // nullptr for a comment
  Span span;
  std::string_view text;
  std::size_t lines;   // line breaks between the previous item and this one
  std::uint32_t column;

  bool is(std::string_view mark) const { return token && token->is(mark); }
  bool opens() const { return is("(") || is("[") || is("{"); }
  bool closes() const { return is(")") || is("]") || is("}"); }
};

class Formatter {
 public:
  explicit Formatter(const Source& source) : text_(source.text()) {
    Diagnostics none;
    tokens_ = read_tokens(source, none);
    collect();
  }

  std::string run() {
    for (std::size_t i = 0; i < items_.size(); ++i) {
      if (i > 0 && items_[i].lines == 0) {
        out_ += blank(i);
      } else {
        begin_line(i);
      }
      out_ += items_[i].text;
      if (items_[i].token) before_last_ = last_, last_ = items_[i].token;
    }
    return out_.empty() ? out_ : out_ + '\n';
  }

 private:
  void collect() {
    std::size_t next = 0;
    for (std::size_t i = 0; i < tokens_.tokens.size(); ++i) {
      for (; next < tokens_.comments.size() && tokens_.comments[next].before <= i; ++next) {
        add(nullptr, tokens_.comments[next].span);
      }
      if (tokens_.tokens[i].kind != Token::Kind::End) add(&tokens_.tokens[i], tokens_.tokens[i].span);
    }
    leaders_.resize(items_.size());
    const Item* leader = nullptr;
    for (std::size_t i = items_.size(); i-- > 0; leaders_[i] = leader) {
      if (items_[i].token) leader = &items_[i];
    }
  }

  void add(const Token* token, Span span) {
    const std::size_t from = items_.empty() ? 0 : items_.back().span.end;
    const std::string_view between = text_.substr(from, span.begin - from);
    const auto lines = static_cast<std::size_t>(std::ranges::count(between, '\n'));
    if (lines > 0) line_start_ = from + between.rfind('\n') + 1;
    const std::string_view text = text_.substr(span.begin, span.end - span.begin);
    items_.push_back({token, span, text, lines, static_cast<std::uint32_t>(span.begin - line_start_)});
    if (const std::size_t last = text.rfind('\n'); last != text.npos) line_start_ = span.begin + last + 1;
  }

  void begin_line(std::size_t i) {
    if (!out_.empty()) out_ += items_[i].lines > 1 ? "\n\n" : "\n";
    const Item* by = leaders_[i];
    if (by == nullptr) return;
    // A comment before a token on the same line determines the indentation of that line.
    const std::uint32_t column = by == &items_[i] || by->lines > 0 || i == 0 ? by->column : items_[i].column;
    const bool starts = levels_.empty() || (!by->closes() && column <= levels_.front());
    if (starts) {
      levels_.assign(1, column);  // of `= {column}` g++ 14 warns
      begins_statement_ = by->token;
    } else {
      while (levels_.size() > 1 && levels_.back() > column) levels_.pop_back();
      if (levels_.back() < column) levels_.push_back(column);
    }
    out_.append(kIndentation * (levels_.size() - 1), ' ');
  }

  // Returns the blanks between an item and the previous item on its line.
  std::string_view blank(std::size_t i) const {
    const Item &item = items_[i], &before = items_[i - 1];
    if (!item.token) return item.text.starts_with("//") ? "  " : " ";
    if (!before.token) return " ";
    if (before.opens() || item.closes() || item.is(",") || item.is(":")) return "";
    if (item.is(".") || before.is(".") || item.is("..") || before.is("..") || before.is("...")) return "";
    if (is_tight(item) || is_tight(before)) return "";
    if (is_sign(*before.token, before_last_)) return "";
    if (item.is("{") && (before.is("+") || before.is("-") || before.is("&"))) return "";
    const bool called = before.token->kind == Token::Kind::Name || before.token->kind == Token::Kind::Mark;
    if ((item.is("(") || item.is("[")) && called && ends_value(*before.token)) return "";
    return " ";
  }

  static bool is_tight(const Item& item) { return item.is("*") || item.is("/") || item.is("^"); }

  // True if the token is a `-` or `!` in prefix position.
  bool is_sign(const Token& token, const Token* before) const {
    if (token.is("!")) return true;
    return token.is("-") && (before == nullptr || !ends_value(*before));
  }

  // True if an operator, an index or arguments may follow the token. False after the } of +{0.1}, where an operand
  // follows.
  bool ends_value(const Token& token) const {
    if (token.kind == Token::Kind::Mark) return token.is(")") || token.is("]");
    if (token.kind != Token::Kind::Name) return true;
    const bool value = token.text == "true" || token.text == "false";
    const bool word = !value && std::ranges::find(kReservedWords, token.text) != std::end(kReservedWords);
    const bool opener =
        &token == begins_statement_ && std::ranges::find(kStatementWords, token.text) != std::end(kStatementWords);
    return !word && !opener;
  }

  std::string_view text_;
  Tokens tokens_;
  std::vector<Item> items_;
  std::size_t line_start_ = 0;
  // [item] the item that decides the indentation of a line: its first token, or for a comment the first token after the
  // comment; null if there is none.
  std::vector<const Item*> leaders_;
  std::vector<std::uint32_t> levels_;  // columns in the source; the first is the statement's
  const Token* begins_statement_ = nullptr;
  const Token *last_ = nullptr, *before_last_ = nullptr;
  std::string out_;
};

}  // namespace

std::string format_text(const Source& source) { return Formatter(source).run(); }

}  // namespace fathom::compiler::text
