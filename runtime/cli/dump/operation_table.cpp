#include "runtime/cli/dump/operation_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

namespace fathom::cli {
namespace {

struct OperationCount {
  const vm::OpcodeInfo* operation;
  std::size_t count;
  std::size_t cost;  // total over all occurrences
};

std::vector<OperationCount> count_operations(const vm::Program& program) {
  std::vector<std::size_t> counts(vm::kOpcodeCount), costs(vm::kOpcodeCount);
  for (std::size_t at = 0; at < program.words.size();) {
    const vm::OpcodeInfo& operation = *vm::find_opcode(program.words[at] & 0xff);
    ++counts[static_cast<std::size_t>(operation.opcode)];
    costs[static_cast<std::size_t>(operation.opcode)] += vm::instruction_cost(program.words[at]);
    at += vm::instruction_length(program.words[at]);
  }
  std::vector<OperationCount> found;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) found.push_back({vm::find_opcode(static_cast<std::uint32_t>(i)), counts[i], costs[i]});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const OperationCount& a, const OperationCount& b) { return a.cost > b.cost; });
  return found;
}

struct NodeCost {
  const vm::DebugEntry* node;
  std::size_t instructions = 0, cost = 0;
};

std::vector<NodeCost> count_nodes(const vm::Program& program) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::string_view>, NodeCost> by_node;
  for (const vm::DebugEntry& entry : program.debug) {
    NodeCost& row = by_node.try_emplace({entry.line, entry.column, entry.symbol}, NodeCost{&entry}).first->second;
    ++row.instructions;
    row.cost += vm::instruction_cost(program.words[entry.offset]);
  }
  std::vector<NodeCost> rows;
  for (const auto& [key, row] : by_node) rows.push_back(row);
  std::stable_sort(rows.begin(), rows.end(), [](const NodeCost& a, const NodeCost& b) { return a.cost > b.cost; });
  return rows;
}

double percent(std::size_t cost, const vm::VerifiedProgram& program) {
  return 100 * static_cast<double>(cost) / std::max(1.0, static_cast<double>(program.cost()));
}

}  // namespace

std::string operation_table(const vm::VerifiedProgram& program) {
  std::string table = "operation             count      cost   share\n";
  for (const OperationCount& row : count_operations(program.program())) {
    table += fmt::format("{:20}{:>7}{:>10}{:>7.1f}%\n", row.operation->mnemonic, row.count, row.cost,
                         percent(row.cost, program));
  }
  table += fmt::format("{:20}{:>7}{:>10}\n", "total", program.instructions(), program.cost());
  return table;
}

std::string cost_by_node(const vm::VerifiedProgram& program) {
  const std::vector<NodeCost> rows = count_nodes(program.program());
  std::vector<std::string> places;
  std::size_t width = 5;  // width of the heading "place"
  for (const NodeCost& row : rows) {
    const bool known = row.node->line > 0;
    places.push_back(known ? fmt::format("{}:{}", row.node->line, row.node->column) : "-");
    width = std::max(width, places.back().size());
  }
  std::string table = fmt::format("{:<{}}    ops      cost   share  node\n", "place", width);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    table += fmt::format("{:<{}}{:>7}{:>10}{:>7.1f}%  {}\n", places[i], width, rows[i].instructions, rows[i].cost,
                         percent(rows[i].cost, program), rows[i].node->symbol);
  }
  table += fmt::format("{:<{}}{:>7}{:>10}\n", "total", width, program.instructions(), program.cost());
  return table;
}

}  // namespace fathom::cli
