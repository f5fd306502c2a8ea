// What the names of a scene's parameters stand for, and the limits of what is written with them.
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
    Later,     // its own value is not read yet
    Unusable,  // what is wrong with it has been reported
    Known,
  };
  struct Entry {
    Parameter parameter;
    Span span;  // of its name
    State state = State::Later;
    bool used = false;
  };

  // Adds a name whose value is still to come; names are unique.
  void declare(std::string name, Span span);
  Entry& at(std::size_t number) { return entries_[number]; }
  const std::vector<Entry>& entries() const { return entries_; }  // in file order

  // nullptr when there is no such name. It counts as used from now on, which changes nothing but a warning: that is
  // why a scope that is only read can do it.
  const Entry* use(std::string_view name) const;

  std::vector<std::string_view> known_names() const;

 private:
  Limits limits_;
  mutable std::vector<Entry> entries_;
  std::map<std::string, std::size_t, std::less<>> numbers_;
};

}  // namespace fathom::compiler
