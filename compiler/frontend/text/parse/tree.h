// What a scene's text says, before anything in it has a value: statements, and the expressions in them.
//
//     let tooth = box([1, 2, 1]).rotate([0, 30, 0])
//
// is a Statement::Let named tooth, of a Call of rotate with two arguments, the first of which is a Call of box.
// docs/LANGUAGE.md has the grammar. Tested by: tests/compiler/text_parser_test.cpp
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler::text {

struct Expr;
struct Word;  // a function of the language (frontend/text/parse/vocabulary.h)

// An argument of a call or a field of a record; those without a name are positional.
struct Argument {
  std::string_view name;
  Span name_span;
  Expr* value;
};

// What joins an operand of a row to those before it.
struct Joint {
  char mark;                    // + - & * /
  Span span;                    // of the mark and its blend
  Expr* blend = nullptr;  // of +{...}: a Record; one field without a name is the width
};

// What a name stands for, found before anything is evaluated (frontend/text/parse/names.h).
struct Reference {
  enum class Kind : std::uint8_t { None, Local, Global, Coordinate, Constant, Definition, Objects };
  Kind kind = Kind::None;
  // A Local's slot, a Global's or Definition's statement, a Coordinate's axis, the module whose Objects it is.
  std::uint32_t number = 0;
  double value = 0;          // of a Constant
};

struct Expr {
  enum class Kind : std::uint8_t {
    Number,   // number; the name is how it is written
    Text,     // text
    Truth,    // number: 1 or 0
    Name,     // name
    List,     // of
    Record,   // arguments
    Call,     // name(arguments)
    Index,    // of[0][of[1]]
    Member,   // of[0].name
    Row,      // of[0] joints[0] of[1] joints[1] of[2] ...
    Negate,   // -of[0]
    Not,      // !of[0]
    Power,    // of[0]^of[1]
    Compare,  // of[0] name of[1]
    And,      // of[0] && of[1]
    Or,       // of[0] || of[1]
    Range,    // of[0]..of[1]
    If,       // if of[0] then of[1] else of[2]
    Let,      // let arguments in of[0]
    Fold,     // fold name = of[0] for arguments[0].name in of[1]: of[2]
    // In lists only:
    For,     // for name in of[0]: of[1]
    Guard,   // if of[0]: of[1]
    Spread,  // ...of[0]; an argument, too
  };
  Kind kind;
  std::uint16_t groups = 0;  // parentheses round it
  std::uint32_t depth = 1;  // levels of expressions in it
  Span span;
  Span name_span;
  std::string_view name;  // part of the source's text
  double number = 0;
  std::string text;
  std::vector<Expr*> of;
  std::vector<Argument> arguments;
  std::vector<Joint> joints;
  // Of the name, and of the slot of what For, Fold and Let declare: of Let the first of as many as it has arguments, of
  // Fold the result's, followed by the element's.
  Reference reference;
  const Word* word = nullptr;  // of a Call that is of no definition
};

struct Statement {
  // As kStatementWords of lexer.h.
  enum class Kind : std::uint8_t { Import, Param, Let, Def, Object, Light, Camera, Film, Render, Background };
  Kind kind;
  bool is_spread = false;        // object ...[a, b]: an object each
  bool has_fields = false;       // param a(...) = 1, with or without any
  Span span;                     // of its keyword
  std::string_view name;         // of Import, Param, Let and Def
  Span name_span;                // of the name, or of the label when there is no name
  std::string label;             // in quotes, of Import the path; empty when there is none
  std::vector<Argument>
      fields;  // of Def its parameters and their defaults, of Param min, max and doc, of Import values
  Expr* value = nullptr;
  std::uint32_t slots = 0;   // of locals, when it is evaluated
  std::uint32_t module = 0;  // that it stands in
  std::uint32_t target = 0;  // of Import: the module that it names; 0 when there is none
};

// A file by itself. Expressions live as long as it does.
struct ParsedFile {
  std::vector<Statement> statements;
  std::deque<Expr> expressions;
  std::size_t tokens = 0;
};

// A file as it is imported: once for all imports without values for its parameters, and once for each with some.
struct Module {
  const Source* file;
  std::uint32_t begin = 0, end = 0;  // its statements
  std::uint32_t values = 0;          // the import statement that has its parameters' values
  bool has_values = false;
  bool again = false;  // another module is of the same file: what is wrong in it was said
  std::size_t tokens = 0;
};

// A file, module 0, and those that it imports.
struct Tree {
  std::vector<Statement> statements;
  std::vector<Module> modules;
  std::vector<std::deque<Expr>> expressions;  // [module]
};

}  // namespace fathom::compiler::text
