// A program read as an expression: which instruction made each operand. Stack code is easy to run and awkward to cut;
// this is the same code with its operands found, for what cuts it (vm/prune/specialise.h).
// Tested by: tests/vm/prune/specialise_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "vm/program/verify.h"
#include "vm/prune/settle.h"

namespace fathom::vm {

// An instruction and where its operands come from; nodes are numbered as the instructions are.
struct ExpressionNode {
  std::uint32_t at;  // of the opcode word
  // The instructions whose values are its operands: of a Unary a, of a Binary a and b, of a Ternary all, of a joined
  // Shape a (b is the shape itself), of drop, tee, load and tag a; kNone for a coordinate or a constant. A local's
  // value is its tee's.
  std::uint32_t a = kNone, b = kNone, c = kNone;
  std::uint32_t point = kNone;   // of drop: the Point instruction whose point it forgets
  std::uint32_t choice = kNone;  // its number, in program order, when it is a choice
};

class Expression {
 public:
  // Reads `code` anew; false when it is not an expression: a value computed at one point is used at another, or a
  // point is dropped at which nothing was computed.
  bool read(const Code& code);

  const std::vector<ExpressionNode>& nodes() const { return nodes_; }
  const std::vector<std::uint32_t>& choices() const { return choices_; }  // [choice] its node
  const std::vector<std::uint32_t>& tees() const { return tees_; }        // nodes, in program order
  std::uint32_t root() const { return static_cast<std::uint32_t>(nodes_.size() - 1); }
  std::uint32_t locals() const { return locals_; }

 private:
  struct Value {
    std::uint32_t node, place;
  };
  void begin(const Code& code);
  bool read_instruction(const Code& code, std::uint32_t at, std::uint32_t self);
  void enter_choice(ExpressionNode& node, std::uint32_t self);
  bool take(std::uint32_t& operand);
  bool use_local(std::uint32_t local, std::uint32_t& operand);
  std::uint32_t place_after(const Code& code, std::uint32_t at);

  std::vector<ExpressionNode> nodes_;
  std::vector<std::uint32_t> choices_, tees_;
  std::uint32_t locals_ = 0;
  // While reading. A place is a point as a chain of Point instructions makes it; equal chains are one place.
  std::vector<Value> values_;
  std::size_t height_ = 0;  // of values_
  struct Point {
    std::uint32_t node, place;
  };
  std::vector<Point> points_;
  std::vector<std::uint32_t> defined_;   // [local] its latest tee
  std::vector<std::uint32_t> place_of_;  // [node]
  struct Place {
    std::uint32_t before, at;  // the place it is made of, and the instruction
  };
  std::vector<Place> places_;
  // Places by hash, at the first free slot from theirs; a slot of another reading is free.
  struct Slot {
    std::uint32_t reading = 0, place = 0;
  };
  std::vector<Slot> slots_;
  std::uint32_t reading_ = 0;
  std::size_t slot_of(const Code& code, const Place& place) const;
  void grow_slots(const Code& code);
};

}  // namespace fathom::vm
