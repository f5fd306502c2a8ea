// Specialises a program to a box: finds the part of the program that can matter there.
//
// If interval bounds prove that one operand of a choice (min, max and their smooth variants) loses all over the box,
// the Specialiser removes that operand and the choice. So a thousand blended balls become three nearly everywhere. In
// addition, a caller may give limits beyond which values need not be exact. For every f32 point of the box the part
// then returns
//
//     the same bits as the whole program in f32, where the whole program's value is within the limits, ends included;
//     a value beyond the same limit, where the whole program's value is beyond a limit.
//
// (A zero may change its sign.) The same holds for gradients and surfaces. The bounds on operands are those of
// vm/range/enclose.h.
//
//     Specialiser specialiser;
//     specialiser.enclose_choices(code, boxes, workspace);      // kEnclosedBoxes boxes at once
//     specialiser.resolve(least, most);
//     specialiser.prune(3, part);                     // for the fourth box; can be specialised further
//
// Sources: Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive solid
// geometry", 1992; Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces", 2020; Barbier et
// al., "Lipschitz Pruning: Hierarchical Simplification of Primitive-Based SDFs", 2025.
// Tested by: tests/vm/prune/specialise_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vm/prune/def_use_graph.h"
#include "vm/prune/pruned_program.h"
#include "vm/prune/resolve_choices.h"
#include "vm/range/enclose.h"
#include "vm/range/slope.h"

namespace fathom::vm {

class Specialiser {
 public:
  // Encloses the program over the boxes, and keeps a reference to the program until the next enclose_choices().
  // Returns false if the program has no def-use graph (vm/prune/def_use_graph.h) and cannot be pruned.
  bool enclose_choices(const PrunedProgram& program, const Boxes& boxes, Workspace& workspace);
  // Encloses the program over one box, number 0, so that parts are valid for the exact function as well. With limits
  // of -infinity and infinity, a part equals the whole program, exactly and in f32, wherever every operation of the
  // whole program is defined. So bounds of one hold for the other. The program must have a def-use graph. Returns the
  // program's bounds in the box. Pruning only removes operands that lose to the other operand of their choice.
  // Removing operands because of choices further down would make the part shorter, but such operands may narrow a
  // range, and the bounds of parts must be as good as those of the whole program.
  SlopeBound enclose_choices(const PrunedProgram& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace);

  // Bounds of the program's value in a box.
  float lo(std::size_t box) const { return lo_[box]; }
  float hi(std::size_t box) const { return hi_[box]; }

  // Resolves the choices of all boxes for the limits `least` and `most`. Limits of -infinity and infinity preserve
  // the value everywhere, limits of 0 and 0 its sign. With an `error` above 0, parts are also valid in double with
  // unrounded constants: `error`, plus kResolveShare of the values, is the maximum difference of f32 from double in
  // the boxes.
  void resolve(float least, float most, float error = 0);
  // Returns the number of choices that keep both operands in `box`. The part has roughly one instruction more.
  std::uint32_t choices_left(std::size_t box) const;
  void prune(std::size_t box, PrunedProgram& out);

 private:
  // Entry of the stack of nodes that are still to be written.
  struct Task {
    std::uint32_t node;
    // Part of the node to write: its value, the value of the local that a tee defines, or the instruction alone.
    enum What : std::uint8_t { Value, Local, Instruction } what;
  };
  // Uses of a tee's local.
  struct Uses {
    std::array<std::uint32_t, kEnclosedBoxes> count;  // [box] including the tee's own place on the stack
    std::uint32_t boxes;                              // one bit per box in which the local is used elsewhere
  };
  struct Local {
    std::uint32_t left;  // uses not yet written
    bool shared;
    std::uint32_t number;
  };

  bool read();
  void link_choices();
  void link_pairs();
  ChoiceLink& link_choice(std::uint32_t id);
  bool keeps_a(std::uint32_t choice) const { return live_[choice].a >> box_ & 1; }
  bool keeps_b(std::uint32_t choice) const { return live_[choice].b >> box_ & 1; }
  std::uint32_t forward_of(std::uint32_t id) const;
  void count_uses();
  void need(std::uint32_t node, std::uint32_t boxes);
  void need_operand(Source source, std::uint32_t node, std::uint32_t boxes);
  static void count_use(Uses& uses, std::uint32_t boxes);
  void begin_locals();
  void push(std::uint32_t node, Task::What what) {
    if (waiting_ == tasks_.size()) tasks_.resize(2 * waiting_ + 64);
    tasks_[waiting_++] = {node, what};
  }
  void emit(std::uint32_t id);
  void emit_whole(std::uint32_t id);
  void emit_operator(std::uint32_t id, const DefUseNode& node, std::uint32_t word, const OpcodeRow& row);
  void emit_lone(std::uint32_t id, bool first);
  Source take(Source source, std::uint32_t operand, std::uint32_t& local);
  void use_local(std::uint32_t tee);
  void define_local(std::uint32_t tee);
  std::uint32_t number_of(Local& local);

  const PrunedProgram* program_ = nullptr;
  DefUseGraph graph_;
  bool is_read_ = false;                    // true if graph_ and links_ are those of program_
  bool independent_ = false;                // true if each choice is resolved by itself, without limits of its users
  std::vector<ChoiceBounds> bounds_;        // [choice]
  std::vector<ChoiceRange> ranges_;         // [choice] replaces bounds_ if independent_
  std::vector<ChoiceLink::Operand> producer_choice_;  // [node] the choice whose value the node returns, or kNone
  std::vector<ChoiceLink> links_;           // [choice]
  std::vector<DemandedRange> demanded_;     // [choice]
  std::vector<LiveOperands> live_;          // [choice]
  struct ForwardsOperand {
    bool a, b;  // true if the operand comes from the stack and keeps its sign
  };
  std::vector<ForwardsOperand>
      forwards_operand_;  // [choice] operands that the choice returns unchanged if kept alone
  alignas(64) std::array<float, kEnclosedBoxes> lo_{}, hi_{};

  // Uses of nodes and locals, counted once for the parts of all boxes.
  bool is_counted_ = false;
  std::vector<std::uint32_t> number_;  // [node] for a tee: its number among all tees
  std::vector<std::uint16_t> needed_;  // [node] one bit per box in which the value is needed on the stack
  std::vector<Uses> uses_;             // [tee]

  // State of prune(), which visits the nodes from the root down and writes the code backwards.
  std::uint32_t box_ = 0;
  std::vector<Task> tasks_;
  std::size_t waiting_ = 0;
  std::vector<Local> local_;  // [tee]
  std::uint32_t locals_ = 0;
  PrunedProgramWriter writer_;
};

}  // namespace fathom::vm
