// Checker for a record of a scene file against its row in records.h. Returns the values by name. Records may give
// formulas of the scene's parameters for numbers. The reader evaluates the formulas, so callers see numbers only.
//
// Tested by: tests/golden/diagnostics (E01xx, E0301), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

class RecordReader {
 public:
  // Reports every unknown, missing and invalid property. `place` is the span for missing properties. `range_code` is
  // the error code for numbers out of range.
  RecordReader(const RecordSpec& spec, const syntax::Record& record, Span place, const Scope& scope,
               Diagnostics& diagnostics, const char* range_code = "E0104");

  // True if every value is valid. The reader has reported the invalid values.
  bool good() const { return good_; }

  // Returns the value given under this name or an alias, with formulas replaced by numbers. Returns nullptr if the
  // value is absent or invalid. A value that varies over space (compiler/frontend/elaborate/textures.h) stays as
  // written. The pointer is valid as long as the reader and the record.
  const syntax::Value* value(std::string_view name) const;

  // Returns the given number or numbers, or the table's default if the value is absent, invalid or not constant. An
  // absent required property reads as zeros.
  std::vector<double> numbers(std::string_view name) const;
  double number(std::string_view name) const { return numbers(name)[0]; }
  glm::dvec3 vec3(std::string_view name) const;
  // Returns the given seed, or 0 if the value is absent or invalid.
  std::uint64_t seed(std::string_view name) const;
  // Returns the index of the given word among the table's choices, or 0 if the value is absent or invalid.
  std::size_t choice(std::string_view name) const;

  // Returns a Boolean, or `fallback` if the value is absent or invalid.
  bool flag(std::string_view name, bool fallback) const;

 private:
  struct Fit {
    std::string_view name;
    const syntax::Value* value;
  };

  void check(const syntax::Property& property);
  void check_aliases(const syntax::Record& record);
  void check_color_text(const syntax::Value& value, const PropertySpec& row);
  void check_value(const syntax::Value& value, const syntax::Value& written, const PropertySpec& row);

  const RecordSpec& spec_;
  const Scope& scope_;
  Diagnostics& diagnostics_;
  const char* range_code_;
  bool good_ = true;
  std::vector<Fit> fit_;
  std::vector<std::unique_ptr<const syntax::Value>> evaluated_;  // values that contained formulas
};

}  // namespace fathom::compiler
