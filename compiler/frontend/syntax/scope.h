// Parameter names of a scene with their values, and the limits that apply to formulas of the parameters.
// Tested by: tests/compiler/frontend/records/scene_numbers_test.cpp
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "compiler/source/limits.h"
#include "compiler/source/source.h"

namespace fathom::compiler {

class Scope {
 public:
  explicit Scope(const Limits& limits = {}) : limits_(limits) {}
  const Limits& limits() const { return limits_; }

  enum class State {
    Later,     // declared, value not read yet
    Unusable,  // value invalid, error already reported
    Known,
  };
  struct Entry {
    Parameter parameter;
    Span span;  // of the name
    State state = State::Later;
    bool used = false;
  };

  // Adds a name without a value. Names are unique.
  void declare(std::string name, Span span);
  Entry& at(std::size_t number) { return entries_[number]; }
  const std::vector<Entry>& entries() const { return entries_; }  // in file order

  // Returns nullptr if the name is unknown. Marks the name as used, which affects only a warning: that is why use()
  // is const.
  const Entry* use(std::string_view name) const;

  std::vector<std::string_view> known_names() const;

 private:
  Limits limits_;
  mutable std::vector<Entry> entries_;
  std::map<std::string, std::size_t, std::less<>> numbers_;
};

}  // namespace fathom::compiler
