#include "runtime/cli/operation_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace fathom::cli {
namespace {

struct OperationCount {
  const vm::OpcodeInfo* operation;
  std::size_t count;
  std::size_t cost;  // of all of them
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

}  // namespace

std::string operation_table(const vm::VerifiedProgram& program) {
  const double total = std::max(1.0, static_cast<double>(program.cost()));
  std::string table = "operation             count  cost each      cost   share\n";
  for (const OperationCount& row : count_operations(program.program())) {
    table += fmt::format("{:20}{:>7}{:>11}{:>10}{:>7.1f}%\n", row.operation->mnemonic, row.count, row.operation->cost,
                         row.cost, 100 * static_cast<double>(row.cost) / total);
  }
  table += fmt::format("{:20}{:>7}{:>11}{:>10}\n", "total", program.instructions(), "", program.cost());
  return table;
}

}  // namespace fathom::cli
