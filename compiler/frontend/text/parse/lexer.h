// A scene's text as tokens (docs/LANGUAGE.md).
// Tested by: tests/compiler/text_parser_test.cpp
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

// Words that begin a statement, where one can begin.
inline constexpr std::string_view kStatementWords[] = {"import", "param",  "let",  "def",    "object",
                                                       "light",  "camera", "film", "render", "background"};
// Words of expressions, which no name can be.
inline constexpr std::string_view kReservedWords[] = {"let", "in",   "if",   "then", "else",
                                                      "for", "fold", "true", "false"};

struct Token {
  enum class Kind : std::uint8_t { Name, Number, Text, Mark, End };
  Kind kind;
  bool first_on_line;
  std::uint32_t column;  // 0-based, bytes
  Span span;
  std::string_view text;  // as written; of a Text with its quotes
  double value = 0;       // of a Number; infinite when it is too large

  bool is(std::string_view mark) const { return kind == Kind::Mark && text == mark; }
  bool is_word(std::string_view word) const { return kind == Kind::Name && text == word; }
};

// A comment with its marks, and between which tokens it stands.
struct Comment {
  Span span;
  std::size_t before;  // the number of the token it stands before
  bool first_on_line;
};

struct Tokens {
  std::vector<Token> tokens;  // the last is of Kind::End
  std::vector<Comment> comments;
};

// All tokens of the text; what is no token is reported and left out. The tokens' texts are parts of the source's.
Tokens read_tokens(const Source& source, Diagnostics& diagnostics);

// Whether there are no more tokens than `limits` allow, before any is kept; reports it.
bool check_tokens(const Source& source, const Limits& limits, Diagnostics& diagnostics);

// The name that the text begins with, after blanks and comments; empty when it begins with something else.
std::string_view first_word(std::string_view text);

// What a Text token says, its escapes resolved; reports those that are none, and control characters.
std::string unquoted(const Token& token, Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
