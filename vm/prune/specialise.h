// Specialising: the part of a program that can matter in a box.
//
// Where one operand of a choice (min, max and their smooth kin) is proved to lose all over the box, it and the choice
// go: a thousand blended balls are three of them nearly everywhere. Beside that a caller may name limits, beyond
// which it does not matter what the value is. For every f32 point of the box the part then gives
//
//     the f32 machine's own bits of the whole program, where its value is within the limits, ends included;
//     a value beyond the same limit, where the whole program's is.
//
// (A zero may change its sign.) The same holds of gradients and surfaces. Bounds on the operands are vm/range/enclose.h's.
//
//     Specialiser specialiser;
//     specialiser.look(code, boxes, workspace);      // kEnclosedBoxes boxes at once
//     specialiser.decide(least, most);
//     specialiser.part(3, part);                     // of the fourth box; itself a Code, to be specialised further
//
// Sources: Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive solid
// geometry", 1992; Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces", 2020; Barbier et
// al., "Lipschitz Pruning: Hierarchical Simplification of Primitive-Based SDFs", 2025. Tested by:
// tests/vm/prune/specialise_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vm/prune/expression.h"
#include "vm/prune/part.h"
#include "vm/prune/settle.h"
#include "vm/range/enclose.h"
#include "vm/range/slope.h"

namespace fathom::vm {

class Specialiser {
 public:
  // Encloses the program over the boxes; keeps a reference to it until the next look(). False when the program is not
  // an expression (vm/prune/expression.h) and cannot be cut.
  bool look(const Part& program, const Boxes& boxes, Workspace& workspace);
  // The same over one box, which is number 0, for the exact function as well: a part for limits of -infinity and
  // infinity equals the whole, exactly and in f32, wherever every operation of the whole is defined, so that what
  // holds of the one holds of the other. The program is an expression; returned is what it does in the box. Operands
  // are cut that lose to the other one: that others lie beyond what matters further down would make the part shorter,
  // but it may be what narrows a range, and the bounds of parts are to be as good as the whole's.
  SlopeBound look(const Part& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace);

  // What the value can be in box i.
  float lo(std::size_t box) const { return lo_[box]; }
  float hi(std::size_t box) const { return hi_[box]; }

  // Settles the choices for the limits of all boxes; -infinity and infinity ask for the value everywhere, 0 and 0 for
  // its sign. With an `error` above 0 parts hold in double, too, of the unrounded constants: it is how far f32 may be
  // from that in the boxes, beside kSettleShare of the values.
  void decide(float least, float most, float error = 0);
  // Instructions of the part for `box`, roughly: the choices that stay, and one.
  std::uint32_t choices_left(std::size_t box) const;
  void part(std::size_t box, Part& out);

 private:
  // What is still to be written, in the order of a stack.
  struct Task {
    std::uint32_t node;
    // Its value; the value of the local that it, a tee, defines; or the instruction alone.
    enum What : std::uint8_t { Value, Local, Instruction } what;
  };
  // What uses a tee's local.
  struct Uses {
    std::array<std::uint32_t, kEnclosedBoxes> count;  // [box] the tee's own place on the stack counts, too
    std::uint32_t boxes;                              // a bit for each in which it is used elsewhere
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
  bool keeps_a(std::uint32_t choice) const { return kept_[choice].a >> box_ & 1; }
  bool keeps_b(std::uint32_t choice) const { return kept_[choice].b >> box_ & 1; }
  std::uint32_t resolve(std::uint32_t id) const;
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
  void emit_operator(std::uint32_t id, const ExpressionNode& node, std::uint32_t word, const OpcodeRow& row);
  void emit_lone(std::uint32_t id, bool first);
  Source take(Source source, std::uint32_t operand, std::uint32_t& local);
  void use_local(std::uint32_t tee);
  void define_local(std::uint32_t tee);
  std::uint32_t number_of(Local& local);

  const Part* program_ = nullptr;
  Expression expression_;
  bool is_read_ = false;                    // the expression and the links are those of the program
  bool pairwise_ = false;                   // no choice's limits are those of what uses it
  std::vector<ChoiceBounds> bounds_;        // [choice]
  std::vector<ChoiceRange> ranges_;         // [choice] in their place where choices are settled by pairs
  std::vector<ChoiceLink::Operand> under_;  // [node] the choice whose value it hands on, if it does
  std::vector<ChoiceLink> links_;           // [choice]
  std::vector<Interest> interest_;          // [choice]
  std::vector<KeptOperands> kept_;          // [choice]
  struct HandsOn {
    bool a, b;  // as they are, from the stack
  };
  std::vector<HandsOn> hands_on_;  // [choice] which operand's value is its own where only that one is kept
  alignas(64) std::array<float, kEnclosedBoxes> lo_{}, hi_{};

  // Counted once for the parts of all boxes, which differ in what they need.
  bool is_counted_ = false;
  std::vector<std::uint32_t> number_;  // [node] of a tee, its number among them
  std::vector<std::uint16_t> needed_;  // [node] a bit for each box
  std::vector<Uses> uses_;             // [tee]

  // While a part is made: from the root down, so that the code comes out backwards.
  std::uint32_t box_ = 0;
  std::vector<Task> tasks_;
  std::size_t waiting_ = 0;
  std::vector<Local> local_;  // [tee]
  std::uint32_t locals_ = 0;
  PartWriter writer_;
};

}  // namespace fathom::vm
