// Syntax tree of a text before evaluation: statements, and the expressions in them.
//
//     let tooth = box([1, 2, 1]).rotate([0, 30, 0])
//
// is a Statement::Let named tooth, whose value is a Call of rotate with two arguments, the first of which is a Call
// of box.
// docs/reference/language.md has the grammar. Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler::text {

struct Expr;
struct Word;  // a function of the language (compiler/frontend/text/parse/vocabulary.h)

// Argument of a call or field of a record. An argument without a name is positional.
struct Argument {
  std::string_view name;
  Span name_span;
  Expr* value;
};

// Operator in front of an operand of a row.
struct Joint {
  char mark;                    // + - & * /
  Span span;                    // of the operator and its blend
  // Blend of +{...}, a Record. A field without a name is the blend width.
  Expr* blend = nullptr;
};

// Target of a name, found before evaluation (compiler/frontend/text/parse/names.h).
struct Reference {
  enum class Kind : std::uint8_t { None, Local, Global, Coordinate, Constant, Definition, Objects };
  Kind kind = Kind::None;
  // Slot of a Local, statement of a Global or Definition, axis of a Coordinate, or module of Objects.
  std::uint32_t number = 0;
  double value = 0;          // for Constant
};

struct Expr {
  enum class Kind : std::uint8_t {
    Number,   // number; name is its spelling
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
    Spread,  // ...of[0]; also allowed as an argument
  };
  Kind kind;
  std::uint16_t groups = 0;  // number of parentheses around the expression
  std::uint32_t depth = 1;  // levels of nested expressions, including this one
  Span span;
  Span name_span;
  std::string_view name;  // points into the source's text
  double number = 0;
  std::string text;
  std::vector<Expr*> of;
  std::vector<Argument> arguments;
  std::vector<Joint> joints;
  // Target of the name, or slot of the variables that For, Fold and Let declare. Let uses consecutive slots, one per
  // argument, starting here. Fold uses this slot for the result and the next for the element.
  Reference reference;
  const Word* word = nullptr;  // of a Call without a Definition
};

struct Statement {
  // In the order of kStatementWords in lexer.h.
  enum class Kind : std::uint8_t { Import, Param, Let, Def, Object, Light, Camera, Film, Render, Background };
  Kind kind;
  bool is_spread = false;        // object ...[a, b]: each element is an object
  bool has_fields = false;       // param a(...) = 1, even with empty parentheses
  Span span;                     // of the keyword
  std::string_view name;         // of Import, Param, Let and Def
  Span name_span;                // of the name, or of the label if there is no name
  std::string label;             // string in quotes; the path for Import; empty without one
  std::vector<Argument> fields;  // Def: parameters and their defaults. Param: min, max and doc. Import: values.
  Expr* value = nullptr;
  std::uint32_t slots = 0;   // number of locals during evaluation
  std::uint32_t module = 0;  // the statement's module
  std::uint32_t target = 0;  // Import: the imported module; 0 without one
};

// A parsed file. Expressions live as long as the ParsedFile.
struct ParsedFile {
  std::vector<Statement> statements;
  std::deque<Expr> expressions;
  std::size_t tokens = 0;
};

// Module of an imported file: one module for all imports without parameter values, and one for each import with
// values.
struct Module {
  const Source* file;
  std::uint32_t begin = 0, end = 0;  // range of its statements
  std::uint32_t values = 0;          // import statement with the parameter values
  bool has_values = false;
  bool again = false;  // an earlier module has the same file, so its errors are already reported
  std::size_t tokens = 0;
};

// Modules of a scene: module 0 is the scene's file, and the others are imported.
struct Tree {
  std::vector<Statement> statements;
  std::vector<Module> modules;
  std::vector<std::deque<Expr>> expressions;  // [module]
};

}  // namespace fathom::compiler::text
