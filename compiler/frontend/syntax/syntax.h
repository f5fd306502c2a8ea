// Syntax tree of a scene file: the scene as written, with a span for every value, and no names resolved. Independent
// of JSON, so that other notations can produce the same tree.
//
// A record is a list of properties with values. elaborate.cpp checks, against the tables, which properties exist and
// what their values must be. Nodes are records too: {"type": "sphere", "radius": 1, "translate": [0, 1, 0]} has the
// properties type, radius and translate; `{"use": "ball"}` has the property use.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler {
struct Formula;
}

namespace fathom::compiler::syntax {

struct Value;

struct Property {
  std::string name;
  Span name_span;
  std::unique_ptr<Value> value;
};

struct Record {
  std::vector<Property> properties;  // in file order, names unique
  const Property* find(std::string_view name) const;
};

using List = std::vector<Value>;

// Formula already parsed by a front end. Formulas of JSON scenes stay strings until a property needs a formula.
using ReadFormula = std::shared_ptr<const Formula>;

struct Value {
  Span span;
  std::variant<std::monostate, bool, double, std::string, List, Record, ReadFormula> data;  // monostate: null
  std::uint64_t integer = 0;  // a number that is written in digits alone, which `data` may round; otherwise 0
};

// Whole file: one record with the properties camera, film, objects, ...
struct File {
  Value root;
};

}  // namespace fathom::compiler::syntax

namespace fathom::compiler {

// Describes a value in messages: "a number", "a string", "a list of 2", ...
std::string describe(const syntax::Value& value);

// Returns the integer that the text is, or 0 if the text is not digits alone or takes more than 64 bits.
std::uint64_t integer_of(std::string_view text);

// Prints a number with all of its digits. Digits alone are an `integer`, from 2^53 on.
std::string number_text(const syntax::Value& number);

// Returns the three numbers of a list, or a single number three times. Returns nullopt for any other value.
std::optional<glm::dvec3> three_numbers(const syntax::Value& value);

// Returns the span of the bracket that opens a record or list.
inline Span opening(Span span) { return {span.begin, span.begin + 1}; }

// True if the value is a formula, either a string or already parsed.
inline bool is_formula_text(const syntax::Value& value) {
  return std::holds_alternative<std::string>(value.data) || std::holds_alternative<syntax::ReadFormula>(value.data);
}

}  // namespace fathom::compiler
