// Checks a record of a scene file against its row in records.h and hands out the values.
// Where the table wants numbers a record may have formulas of the scene's parameters; they are evaluated here, and
// who reads the values sees numbers only.
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
  // Reports every unknown, missing and unfit property. A missing one is reported at `place`; `range_code` is the code
  // of numbers that break their rule.
  RecordReader(const RecordSpec& spec, const syntax::Record& record, Span place, const Scope& scope,
               Diagnostics& diagnostics, const char* range_code = "E0104");

  // Whether every value can be used; what is wrong with the others has been reported.
  bool good() const { return good_; }

  // The value as given under this name or an alias of it, but with numbers for formulas, when it is given and fit;
  // else nullptr. What varies over space (frontend/elaborate/textures.h) is as it was written. Lives as long as the reader and
  // the record.
  const syntax::Value* value(std::string_view name) const;

  // The number(s) given, or the table's default when absent, unfit or not constant; a required one that is absent
  // reads as zeros.
  std::vector<double> numbers(std::string_view name) const;
  double number(std::string_view name) const { return numbers(name)[0]; }
  glm::dvec3 vec3(std::string_view name) const;
  // The place among the table's choices of the word given, or 0 when it is absent or unfit.
  std::size_t choice(std::string_view name) const;

  // A Boolean; `fallback` when absent or unfit.
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
  std::vector<std::unique_ptr<const syntax::Value>> evaluated_;  // values that had formulas in them
};

}  // namespace fathom::compiler
