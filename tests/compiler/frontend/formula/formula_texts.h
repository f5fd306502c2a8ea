// Formulas as scene files contain them, for the tests of formula readers.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"

namespace fathom::test {

// Returns the text as a value whose span begins at the start of a file, including quotes.
inline compiler::syntax::Value in_quotes(const std::string& text) {
  return {{0, static_cast<std::uint32_t>(text.size() + 2)}, text};
}

inline compiler::Scope scope_of(std::initializer_list<std::pair<const char*, double>> parameters) {
  compiler::Scope scope;
  for (const auto& [name, value] : parameters) {
    scope.declare(name, {});
    compiler::Scope::Entry& entry = scope.at(scope.entries().size() - 1);
    entry.parameter.value = value;
    entry.state = compiler::Scope::State::Known;
  }
  return scope;
}

inline const compiler::Scope& some_scope() {
  static const compiler::Scope scope = scope_of({{"r", 0.5}, {"n", 3}});
  return scope;
}

}  // namespace fathom::test
