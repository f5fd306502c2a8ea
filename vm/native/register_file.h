// Registers and stack slots of straight-line code. A value that gives its register up is the one whose next use is
// farthest, which is optimal for a straight line (Belady, "A Study of Replacement Algorithms for a Virtual-Storage
// Computer", 1966), except that values with a copy in memory go first at equal distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vm/native/operation_graph.h"

namespace fathom::vm {

class RegisterFile {
 public:
  static constexpr int kNone = -1;

  // `registers`: number of registers that may hold values.
  RegisterFile(const OperationGraph& graph, int registers);

  // Register that holds the node's value, or kNone.
  int register_of(std::uint32_t node) const { return values_[node].reg; }
  // Stack slot that holds the node's value, or kNone.
  int slot_of(std::uint32_t node) const { return values_[node].slot; }
  int slots() const { return slots_; }

  // A register, and the value that must be written from it to a slot before.
  struct Taken {
    int reg;
    bool spills = false;
    int spilled_reg = kNone, slot = kNone;
  };
  // Takes a register for `node`. Registers of `pinned` nodes stay.
  Taken take(std::uint32_t node, const std::vector<std::uint32_t>& pinned);
  // Returns registers and slots of the nodes whose last use is at position `at`. The slots are free only from the
  // next call on, because the operation at `at` still reads them, after what take() spills.
  void end_uses(const std::vector<std::uint32_t>& nodes, std::uint32_t at);

  // Nodes that the operation at `at` reads from registers or memory: its operands, those of a mask in its place.
  static std::vector<std::uint32_t> reads_of(const OperationGraph& graph, std::uint32_t at);

 private:
  struct Value {
    int reg = kNone, slot = kNone;
    bool in_memory = false;           // an input or a constant, which needs no slot
    std::vector<std::uint32_t> uses;  // positions, last first
  };

  std::vector<Value> values_;
  std::vector<int> free_registers_, free_slots_, released_slots_;
  std::vector<std::uint32_t> holders_;  // [register] node
  int slots_ = 0;
};

}  // namespace fathom::vm
