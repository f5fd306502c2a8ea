// Resolves choices: finds the operands of a program's choices that pruning keeps, in sixteen boxes at once
// (vm/prune/specialise.h).
// Tested by: tests/vm/prune/specialise_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/range/choice_bounds.h"

namespace fathom::vm {

// Operand that wins when the operands of a choice are far enough apart; Keep never removes an operand.
enum class ChoiceRule : std::uint8_t { Keep, Least, Greatest };

// A choice, and the choices whose values are its operands.
struct ChoiceLink {
  struct Operand {
    std::uint32_t choice;  // kNone if the operand is not the value of a choice
    float less;            // the operand is the choice's value minus `less`
  };
  ChoiceRule rule;
  bool opposite;  // true if b enters with its sign changed
  bool always;    // true if an instruction that is not a choice uses the value, so that all values are of interest
  float width;    // operands further apart than this do not blend
  Operand a, b;
};

// Demanded range of a choice's value. A value outside matters only by being outside, above or below. [box]
struct DemandedRange {
  alignas(64) float lo[kEnclosedBoxes];
  alignas(64) float hi[kEnclosedBoxes];
};

// Operands of a choice that stay, one bit per box. Neither bit is set in boxes where the choice itself is not needed.
struct LiveOperands {
  std::uint16_t a, b;
};

inline constexpr std::uint32_t kNone = 0xffffffff;

// Resolves choices [0, count), in which users come after the choices they use. `root` is the choice whose value is
// the program's result, of interest within [least, most]. interest[choice] is scratch, kept[choice] the result. If
// `error` is above 0, an operand only loses by more than `error` plus kResolveShare of both values, the maximum error
// of f32.
void resolve_choices(const ChoiceLink* links, const ChoiceBounds* bounds, std::size_t count, ChoiceLink::Operand root,
                     float least, float most, float error, DemandedRange* demanded, LiveOperands* kept);

inline constexpr float kResolveShare = 0x1p-18f;

// Resolves each choice by itself, in one box: removes an operand if it loses to the other one. Results are in bit 0.
void resolve_pairs(const ChoiceLink* links, const ChoiceRange* ranges, std::size_t count, LiveOperands* kept);

}  // namespace fathom::vm
