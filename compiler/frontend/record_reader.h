// Checks a record of a scene file against its row in records.h and hands out the values.
// Tested by: tests/golden/diagnostics (E01xx, E0301), tests/compiler/elaborate_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics.h"
#include "compiler/frontend/records.h"
#include "compiler/frontend/syntax.h"

namespace fathom::compiler {

class RecordReader {
 public:
  // Reports every unknown, missing and unfit property. A missing one is reported at `place`; `range_code` is the code
  // of numbers that break their rule.
  RecordReader(const RecordSpec& spec, const syntax::Record& record, Span place, Diagnostics& diagnostics,
               const char* range_code = "E0104");

  // Whether nothing was reported.
  bool good() const { return good_; }

  // The value as given, when it is given and fit; else nullptr.
  const syntax::Value* value(std::string_view name) const;

  // The number(s) given, or the table's default when absent or unfit; a required one that is absent reads as zeros.
  std::vector<double> numbers(std::string_view name) const;
  double number(std::string_view name) const { return numbers(name)[0]; }
  glm::dvec3 vec3(std::string_view name) const;

 private:
  void check(const syntax::Property& property);

  const RecordSpec& spec_;
  Diagnostics& diagnostics_;
  const char* range_code_;
  bool good_ = true;
  std::vector<const syntax::Property*> fit_;
};

// "a number", "a string", "a list of 2", ...
std::string describe(const syntax::Value& value);

// The three numbers (or one, three times) of a list; nullopt when the value is anything else.
std::optional<glm::dvec3> three_numbers(const syntax::Value& value);

// The bracket that opens a record or list.
inline Span opening(Span span) { return {span.begin, span.begin + 1}; }

}  // namespace fathom::compiler
