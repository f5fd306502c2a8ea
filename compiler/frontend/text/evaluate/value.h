// Values of expressions in a text: numbers, texts, lists, records and nodes. Values are small and refer to data owned
// by the Store. That data is immutable after construction.
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

// A number as a formula of a JSON scene, kept for scenes that retain their parameters (`fathom convert`).
struct Spelling {
  struct Line {
    std::string_view name;
    std::string text;
    std::size_t number;  // in order of creation
  };
  std::string text;
  std::string inlined;              // the text with the names of `lines` replaced by their formulas
  int precedence = 0;               // of the outermost operator, as in spelling.cpp
  bool is_literal = false;          // a plain number
  bool is_parametric = false;       // depends on parameters
  std::vector<const Line*> lines;   // definitions that `text` needs, in order
};

// Size of a list or a record.
struct Extent {
  std::uint32_t depth = 0;  // nesting depth of lists and records
  double values = 1;        // number of values in converted form, where a shared list counts once per occurrence
};

struct Value {
  enum class Type : std::uint8_t { Truth, Number, Formula, Text, List, Record, Node };
  Type type;
  Span span;
  const Spelling* spelling = nullptr;  // of a number, if kept
  std::uint64_t integer = 0;           // of a number, as in syntax::Value
  union {
    bool truth = false;
    double number;
    FormulaId formula;  // a number that depends on x, y or z
    const std::string* text;
    const List* list;
    const Record* record;
    const Node* node;
  };

  bool is(Type t) const { return type == t; }
};

Extent extent_of(const Value& value);

// Returns a value whose content is not set yet.
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

// A record: (a = 1, b = 2), or diffuse(color = 0.5), whose `word` is diffuse.
struct Record {
  const Word* word = nullptr;
  Span span;
  Span word_span;
  std::vector<Field> fields;
  Extent extent = {};
  mutable std::string_view name = {};  // first name given to the record; empty without one
};

// A node of a type, or a wrapper without `spec` around one operand. The wrapper has one field (scale, rotate,
// translate, material or name), or none if the wrapper is only another name.
struct Node {
  const NodeSpec* spec = nullptr;
  Span span;
  Span word_span;
  std::vector<Field> fields;
  std::vector<const Node*> of;
  mutable std::string_view name = {};
  mutable std::uint32_t number = 0;  // index + 1 in emit.cpp; 0 before conversion
};

struct Store {
  std::deque<List> lists;
  std::deque<Record> records;
  std::deque<Node> nodes;
  std::deque<Spelling> spellings;
  std::size_t spelled = 0;  // length of all of them in characters
  std::deque<Spelling::Line> lines;
  FormulaBuilder formulas;
};

// Describes a value in messages: "a number", "a node", "a list of 3", ...
std::string describe(const Value& value);

}  // namespace fathom::compiler::text
