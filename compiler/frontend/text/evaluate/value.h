// What an expression of a scene's text is worth: numbers, texts, lists, records and nodes. Values are small and
// refer to what the Store owns; nothing in them changes once it is made.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontend/formula/formula_builder.h"
#include "compiler/frontend/text/parse/tree.h"
#include "compiler/frontend/text/parse/vocabulary.h"

namespace fathom::compiler::text {

struct List;
struct Record;
struct Node;

// A number as a formula of a JSON scene, for those who want a scene that keeps its parameters (`fathom convert`).
struct Spelling {
  struct Line {
    std::string_view name;
    std::string text;
    std::size_t number;  // in the order they were made
  };
  std::string text;
  std::string inlined;              // without the names of `lines`
  int precedence = 0;               // of the operator that is outermost, as in spelling.cpp
  bool is_literal = false;          // a number as it is
  bool is_parametric = false;       // parameters are in it
  std::vector<const Line*> lines;   // definitions that the text needs, in order
};

// How far a list or a record goes.
struct Extent {
  std::uint32_t depth = 0;  // levels of lists and records within each other
  double values = 1;        // written out, where the same list may stand many times
};

struct Value {
  enum class Type : std::uint8_t { Truth, Number, Formula, Text, List, Record, Node };
  Type type;
  Span span;
  const Spelling* spelling = nullptr;  // of a number, where they are kept
  union {
    bool truth = false;
    double number;
    FormulaId formula;  // a number that contains x, y or z
    const std::string* text;
    const List* list;
    const Record* record;
    const Node* node;
  };

  bool is(Type t) const { return type == t; }
};

Extent extent_of(const Value& value);

// A value whose content is still to be set.
inline Value blank(Value::Type type, Span span) {
  Value value{};
  value.type = type, value.span = span;
  return value;
}

struct List {
  std::vector<Value> of;
  Extent extent = {};
};

struct Field {
  std::string_view name;
  Span name_span;
  Value value;
};

// (a = 1, b = 2), or diffuse(color = 0.5), which has a word.
struct Record {
  const Word* word = nullptr;
  Span span;
  Span word_span;
  std::vector<Field> fields;
  Extent extent = {};
  mutable std::string_view name = {};  // the first that it was given; empty when there is none
};

// A node, or one placed: scaled, turned, moved, painted or named, which has no word but one field and one operand; no
// field when it is but another name.
struct Node {
  const NodeSpec* spec = nullptr;
  Span span;
  Span word_span;
  std::vector<Field> fields;
  std::vector<const Node*> of;
  mutable std::string_view name = {};
  mutable std::uint32_t number = 0;  // in frontend/text/evaluate/emit.cpp
};

struct Store {
  std::deque<List> lists;
  std::deque<Record> records;
  std::deque<Node> nodes;
  std::deque<Spelling> spellings;
  std::deque<Spelling::Line> lines;
  FormulaBuilder formulas;
};

// "a number", "a node", "a list of 3", ... as messages say it.
std::string describe(const Value& value);

}  // namespace fathom::compiler::text
