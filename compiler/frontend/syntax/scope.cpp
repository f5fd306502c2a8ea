#include "compiler/frontend/syntax/scope.h"

#include <utility>

namespace fathom::compiler {

void Scope::declare(std::string name, Span span) {
  numbers_.emplace(name, entries_.size());
  Entry& entry = entries_.emplace_back();
  entry.parameter.name = std::move(name);
  entry.span = span;
}

const Scope::Entry* Scope::use(std::string_view name) const {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) return nullptr;
  Entry& entry = entries_[found->second];
  entry.used = true;
  return &entry;
}

std::vector<std::string_view> Scope::known_names() const {
  std::vector<std::string_view> names;
  for (const Entry& entry : entries_) {
    if (entry.state == State::Known) names.push_back(entry.parameter.name);
  }
  return names;
}

}  // namespace fathom::compiler
