#include "compiler/frontend/text/parse/token_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fathom::compiler::text {

bool is_reserved(std::string_view word) {
  return std::ranges::find(kReservedWords, word) != std::end(kReservedWords);
}

TokenCursor::TokenCursor(const Source& source, Diagnostics& diagnostics)
    : diagnostics_(diagnostics), tokens_(read_tokens(source, diagnostics).tokens) {
  stop_.kind = Token::Kind::End;
}

bool TokenCursor::is_over() const {
  const Token& next = tokens_[at_];
  return next.kind == Token::Kind::End ||
         (next.kind == Token::Kind::Name && next.first_on_line && next.column <= column_);
}

const Token& TokenCursor::peek() const {
  const Token& token = tokens_[at_];
  if (!inside_ || !token.first_on_line || token.column > column_) return token;
  const bool closes = token.is(")") || token.is("]") || token.is("}");
  if (closes) return token;
  stop_.span = at_ > 0 ? Span{tokens_[at_ - 1].span.end, tokens_[at_ - 1].span.end} : token.span;
  return stop_;
}
const Token& TokenCursor::after() const { return tokens_[std::min(at_ + 1, tokens_.size() - 1)]; }
const Token& TokenCursor::take() {
  const Token& token = peek();
  if (token.kind != Token::Kind::End) ++at_;
  return token;
}
bool TokenCursor::take_if(std::string_view mark) {
  if (!peek().is(mark)) return false;
  ++at_;
  return true;
}
Span TokenCursor::before() const { return tokens_[at_ - 1].span; }

bool TokenCursor::expect(std::string_view mark, const char* where) {
  if (take_if(mark)) return true;
  unexpected(fmt::format("`{}` is missing {}", mark, where));
  return false;
}
bool TokenCursor::expect_word(std::string_view word, const char* where) {
  if (peek().is_word(word)) return take(), true;
  unexpected(fmt::format("`{}` is missing {}", word, where));
  return false;
}

std::nullptr_t TokenCursor::unexpected(std::string label, std::vector<std::string> help) {
  const Token& token = peek();
  const std::string what = token.kind != Token::Kind::End ? fmt::format("`{}` is not expected here", token.text)
                           : &token == &stop_             ? "the statement ends too early"
                                                          : "the file ends too early";
  diagnostics_.error(token.kind == Token::Kind::End ? "E0002" : "E0001", token.span, what, std::move(label),
                     std::move(help));
  return nullptr;
}

bool TokenCursor::name(std::string_view& text, Span& span, const char* what) {
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

bool TokenCursor::begins_value(const Token& token) {
  return token.kind == Token::Kind::Number || token.kind == Token::Kind::Text ||
         (token.kind == Token::Kind::Name && !is_reserved(token.text));
}

}  // namespace fathom::compiler::text
