// The tokens of a text, one after the other, as its parser takes them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontend/text/parse/lexer.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

// Words that no name can be.
bool is_reserved(std::string_view word);

class TokenCursor {
 public:
  TokenCursor(const Source& source, Diagnostics& diagnostics);

 protected:
  // The next token; an End where a line begins that the statement does not reach to.
  const Token& peek() const;
  const Token& after() const;  // the one behind it
  const Token& take();
  bool take_if(std::string_view mark);
  Span before() const;
  // Whether the statement ends before the next token.
  bool is_over() const;

  // Take what must come, or report that it is missing.
  bool expect(std::string_view mark, const char* where);
  bool expect_word(std::string_view word, const char* where);
  bool name(std::string_view& text, Span& span, const char* what);
  // Reports the next token.
  std::nullptr_t unexpected(std::string label, std::vector<std::string> help = {});
  static bool begins_value(const Token& token);

  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::uint32_t column_ = 0;  // of the statement's first word
  bool inside_ = false;       // of a statement

 private:
  mutable Token stop_{};
};

}  // namespace fathom::compiler::text
