// Lexer for formulas.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <cstddef>
#include <string_view>

namespace fathom::compiler {

struct Token {
  enum class Kind {
    Number,
    Name,
    Mark,     // one of + - * / ^ ( ) , =
    Foreign,  // a mark of other languages that formulas lack: ==, %, ...
    End,
  };
  Kind kind;
  std::string_view text;       // slice of the formula; empty at its end
  double value = 0;            // for Number; infinite if the number is too large for a double
  std::string_view help = {};  // for Foreign: what to write instead; may be empty

  bool is(char mark) const { return kind == Kind::Mark && text[0] == mark; }
};

class FormulaLexer {
 public:
  explicit FormulaLexer(std::string_view text) : text_(text) {}
  Token next();  // returns End repeatedly at the end

 private:
  Token take(Token::Kind kind, std::size_t length);
  Token number();
  Token foreign();

  std::string_view text_;
  std::size_t at_ = 0;
};

// True if the text is one name: a letter or underscore, then letters, digits and underscores.
bool is_formula_name(std::string_view text);

}  // namespace fathom::compiler
