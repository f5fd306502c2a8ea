// What a front end makes of a scene file: the scene as written, with a span for everything, and nothing resolved.
// Independent of JSON, so that another notation can produce the same.
//
// A record is a bag of properties with values; which properties exist and what they must be is elaborate.cpp's
// business, by the tables. Nodes are records too: {"type": "sphere", "radius": 1, "translate": [0, 1, 0]} has the
// properties type, radius and translate; `{"use": "ball"}` has the property use.
#pragma once

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

// A formula that a front end has read itself; one of a JSON scene is a string until someone wants a formula there.
using ReadFormula = std::shared_ptr<const Formula>;

struct Value {
  Span span;
  std::variant<std::monostate, bool, double, std::string, List, Record, ReadFormula> data;  // monostate: null
};

// The whole file: one record with the properties camera, film, objects, ...
struct File {
  Value root;
};

}  // namespace fathom::compiler::syntax

namespace fathom::compiler {

// "a number", "a string", "a list of 2", ...
std::string describe(const syntax::Value& value);

// The three numbers (or one, three times) of a list; nullopt when the value is anything else.
std::optional<glm::dvec3> three_numbers(const syntax::Value& value);

// The bracket that opens a record or list.
inline Span opening(Span span) { return {span.begin, span.begin + 1}; }

// Whether the value is a formula, as a string or read already.
inline bool is_formula_text(const syntax::Value& value) {
  return std::holds_alternative<std::string>(value.data) || std::holds_alternative<syntax::ReadFormula>(value.data);
}

}  // namespace fathom::compiler
