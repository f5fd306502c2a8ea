// Lexer for scenes in text notation (docs/reference/language.md).
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"
#include "compiler/source/source.h"

namespace fathom::compiler::text {

// Words that begin a statement, in a position where a statement can begin.
inline constexpr std::string_view kStatementWords[] = {"import", "param",  "let",  "def",    "object",
                                                       "light",  "camera", "film", "render", "background"};
// Words of expressions, which cannot be names.
inline constexpr std::string_view kReservedWords[] = {"let", "in",   "if",   "then", "else",
                                                      "for", "fold", "true", "false"};

struct Token {
  enum class Kind : std::uint8_t { Name, Number, Text, Mark, End };
  Kind kind;
  bool first_on_line;
  std::uint32_t column;  // 0-based, bytes
  Span span;
  std::string_view text;  // as written; Text includes its quotes
  double value = 0;       // for Number; infinite if the number is too large for a double

  bool is(std::string_view mark) const { return kind == Kind::Mark && text == mark; }
  bool is_word(std::string_view word) const { return kind == Kind::Name && text == word; }
};

// A comment with its marks, and its position among the tokens.
struct Comment {
  Span span;
  std::size_t before;  // index of the token after the comment
  bool first_on_line;
};

struct Tokens {
  std::vector<Token> tokens;  // the last token has Kind::End
  std::vector<Comment> comments;
};

// Returns all tokens of the text. Reports and skips invalid characters. Token texts point into the source.
Tokens read_tokens(const Source& source, Diagnostics& diagnostics);

// True if the text has at most as many tokens as `limits` allow. Reports an excess. Does not store the tokens.
bool check_tokens(const Source& source, const Limits& limits, Diagnostics& diagnostics);

// Returns the name at the beginning of the text, after blanks and comments, or "" if the text begins with another
// token.
std::string_view first_word(std::string_view text);

// Returns the string of a Text token with escapes resolved. Reports invalid escapes and control characters.
std::string unquoted(const Token& token, Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
