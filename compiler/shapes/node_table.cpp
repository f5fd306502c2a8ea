#include "compiler/shapes/node_table.h"

#include <iterator>
#include <unordered_map>

#include "compiler/shapes/rows.h"
#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

std::vector<NodeSpec> make_table() {
  std::vector<NodeSpec> table;
  for (auto rows : {solid_rows, polyhedron_rows, fractal_rows, composed_rows, outline_rows, round_outline_rows,
                    alteration_rows, domain_rows, repetition_rows, combinator_rows, function_rows}) {
    std::vector<NodeSpec> some = rows();
    table.insert(table.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  }
  return table;
}

using SpecsByName = std::unordered_map<std::string_view, const NodeSpec*>;

// Returns the rows by name: those of functions, or those of nodes of scenes.
SpecsByName make_names(bool functions) {
  SpecsByName names;
  for (const NodeSpec& row : node_table()) {
    if (row.category != Category::Internal && (row.category == Category::Function) == functions) {
      names.emplace(row.name, &row);
    }
  }
  return names;
}

const NodeSpec* find(const SpecsByName& names, std::string_view name) {
  const auto found = names.find(name);
  return found == names.end() ? nullptr : found->second;
}

}  // namespace

const std::vector<NodeSpec>& node_table() {
  static const std::vector<NodeSpec> table = make_table();
  return table;
}

const NodeSpec& spec(Kind kind) {
  static const std::vector<const NodeSpec*> by_kind = [] {
    std::vector<const NodeSpec*> rows(kKindCount, nullptr);
    for (const NodeSpec& row : node_table()) rows[static_cast<std::size_t>(row.kind)] = &row;
    return rows;
  }();
  const NodeSpec* row = by_kind[static_cast<std::size_t>(kind)];
  CHECK(row != nullptr, "every kind has a row");
  return *row;
}

const NodeSpec* find_node(std::string_view name) {
  static const SpecsByName names = make_names(false);
  return find(names, name);
}

const NodeSpec* find_function(std::string_view name) {
  static const SpecsByName names = make_names(true);
  return find(names, name);
}

}  // namespace fathom::compiler
