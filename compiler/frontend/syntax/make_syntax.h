// Builders for syntax trees, used by the front ends that read other formats. Spans refer to the text that was read.
//
//     RecordMaker(span).add("type", "sphere").add("radius", 1.0).take()
//
// Tested by: tests/compiler/frontend/formats/expression_list_test.cpp, tests/compiler/frontend/formats/nested_nodes_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "compiler/frontend/syntax/syntax.h"

namespace fathom::compiler {

inline syntax::Value make_value(Span span, double number) { return {span, number}; }
inline syntax::Value make_value(Span span, std::string_view text) { return {span, std::string(text)}; }
inline syntax::Value make_value(Span span, const glm::dvec3& v) {
  syntax::List list;
  for (int i = 0; i < 3; ++i) list.push_back({span, v[i] + 0.0});  // + 0.0 turns -0 into 0
  return {span, std::move(list)};
}

class RecordMaker {
 public:
  explicit RecordMaker(Span span) : span_(span) {}
  // Continues an existing record.
  explicit RecordMaker(syntax::Value record)
      : span_(record.span), record_(std::get<syntax::Record>(std::move(record.data))) {}

  // Gives the value the record's span.
  template <class T>
  RecordMaker& add(std::string_view name, const T& value) {
    return add(name, make_value(span_, value));
  }
  RecordMaker& add(std::string_view name, syntax::Value value) {
    const Span span = value.span;
    return add(name, span, std::move(value));
  }
  RecordMaker& add(std::string_view name, Span span, syntax::Value value) {
    record_.properties.push_back({std::string(name), span, std::make_unique<syntax::Value>(std::move(value))});
    return *this;
  }
  bool empty() const { return record_.properties.empty(); }

  syntax::Value take() { return {span_, std::move(record_)}; }

 private:
  Span span_;
  syntax::Record record_;
};

}  // namespace fathom::compiler
