// Formulas as they stand in scene files, for the tests of what reads them.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"

namespace fathom::test {

// As if the text stood at the begin of a file, in quotes.
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
