// Cursor over the tokens of a text, base class of the parsers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontend/text/parse/lexer.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

// True for words that cannot be names.
bool is_reserved(std::string_view word);

class TokenCursor {
 public:
  TokenCursor(const Source& source, Diagnostics& diagnostics);

 protected:
  // Returns the next token, or an End token if the next line no longer belongs to the statement.
  const Token& peek() const;
  const Token& after() const;  // the token after peek()
  const Token& take();
  bool take_if(std::string_view mark);
  Span before() const;
  // True if the statement ends before the next token.
  bool is_over() const;

  // Consume an expected token, or report that it is missing.
  bool expect(std::string_view mark, const char* where);
  bool expect_word(std::string_view word, const char* where);
  bool name(std::string_view& text, Span& span, const char* what);
  // Reports the next token as unexpected.
  std::nullptr_t unexpected(std::string label, std::vector<std::string> help = {});
  static bool begins_value(const Token& token);

  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::uint32_t column_ = 0;  // of the current statement's first word
  bool inside_ = false;       // true while parsing a statement

 private:
  mutable Token stop_{};
};

}  // namespace fathom::compiler::text
