// A formula's text as tokens.
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
    Foreign,  // what other languages have and formulas do not: ==, %, ...
    End,
  };
  Kind kind;
  std::string_view text;       // a part of the formula; empty at its end
  double value = 0;            // of a number; infinite when it is too large
  std::string_view help = {};  // of a foreign one: what to write in its place; may be empty

  bool is(char mark) const { return kind == Kind::Mark && text[0] == mark; }
};

class FormulaLexer {
 public:
  explicit FormulaLexer(std::string_view text) : text_(text) {}
  Token next();  // End again and again at the end

 private:
  Token take(Token::Kind kind, std::size_t length);
  Token number();
  Token foreign();

  std::string_view text_;
  std::size_t at_ = 0;
};

// Whether the text is one name: a letter or underscore, then letters, digits and underscores.
bool is_formula_name(std::string_view text);

}  // namespace fathom::compiler
