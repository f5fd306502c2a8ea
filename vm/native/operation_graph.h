// A recorded program as a graph of machine operations: functions made of others are expanded, equal operations are
// one node, operations on constants are computed, and nodes without a use are gone.
// Tested by: tests/vm/native/native_program_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "vm/record/recorded_function.h"

namespace fathom::vm {

struct OperationNode {
  enum class Kind : std::uint8_t { Input, Constant, Operation };
  Kind kind;
  Operation operation{};
  // Earlier nodes. [0] of an Input: the number of a coordinate, or 3 plus that of a constant in a row.
  std::array<std::uint32_t, 3> operands{};
  float constant = 0;

  std::size_t count() const { return kind == Kind::Operation ? info(operation).operands : 0; }
  bool is_mask() const { return kind == Kind::Operation && info(operation).result == ResultType::Mask; }
};

struct OperationGraph {
  std::vector<OperationNode> nodes;    // operands precede their users
  std::vector<std::uint32_t> results;  // nodes
};

// Returns nothing for a function with a loop, which would run all its passes in every lane, and for one of more than
// `max_nodes` nodes.
std::optional<OperationGraph> make_operation_graph(const RecordedFunction& function, std::size_t max_nodes);

}  // namespace fathom::vm
