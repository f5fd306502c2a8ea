// The def-use graph of a program: each instruction with the instructions that make its operands. Stack code is easy
// to run but hard to prune, so vm/prune/specialise.h prunes this form.
// Tested by: tests/vm/prune/specialise_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "vm/program/verify.h"
#include "vm/prune/resolve_choices.h"

namespace fathom::vm {

// An instruction and the nodes of its operands. A node has the number of its instruction.
struct DefUseNode {
  std::uint32_t at;  // offset of the opcode word
  // Nodes of the operands: a of a Unary, a and b of a Binary, all of a Ternary, a of a joined Shape (b is the shape
  // itself), a of drop, tee, load and tag. kNone for a coordinate or a constant. A local's node is its tee.
  std::uint32_t a = kNone, b = kNone, c = kNone;
  std::uint32_t point = kNone;   // for a drop: node of the Point instruction whose point is dropped
  std::uint32_t choice = kNone;  // for a choice: its number, in program order
};

class DefUseGraph {
 public:
  // Reads `code`, replacing the code read before. Returns false if the code has no def-use graph: a value computed at
  // one point is used at another, or a point at which nothing was computed is dropped.
  bool read(const Code& code);

  const std::vector<DefUseNode>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& choices() const { return choices_; }  // [choice] node
  const std::vector<std::uint32_t>& tees() const { return tees_; }        // nodes, in program order
  std::uint32_t root() const { return static_cast<std::uint32_t>(nodes_.size() - 1); }
  std::uint32_t locals() const { return locals_; }

 private:
  struct Value {
    std::uint32_t node, place;
  };
  void begin(const Code& code);
  bool read_instruction(const Code& code, std::uint32_t at, std::uint32_t self);
  void enter_choice(DefUseNode& node, std::uint32_t self);
  bool take(std::uint32_t& operand);
  bool use_local(std::uint32_t local, std::uint32_t& operand);
  std::uint32_t place_after(const Code& code, std::uint32_t at);

  std::vector<DefUseNode> nodes_;
  std::vector<std::uint32_t> choices_, tees_;
  std::uint32_t locals_ = 0;
  // State while reading. A place is the chain of Point instructions that makes a point; equal chains are one place.
  std::vector<Value> values_;
  std::size_t height_ = 0;  // of values_
  struct Point {
    std::uint32_t node, place;
  };
  std::vector<Point> points_;
  std::vector<std::uint32_t> defined_;   // [local] node of its latest tee
  std::vector<std::uint32_t> place_of_;  // [node]
  struct PointChain {
    std::uint32_t before, at;  // place before the last Point instruction of the chain; offset of that instruction
  };
  std::vector<PointChain> places_;
  // Hash table of places with linear probing. Slots filled by an earlier reading are free.
  struct Slot {
    std::uint32_t reading = 0, place = 0;
  };
  std::vector<Slot> slots_;
  std::uint32_t reading_ = 0;
  std::size_t slot_of(const Code& code, const PointChain& place) const;
  void grow_slots(const Code& code);
};

}  // namespace fathom::vm
