// Settling choices: which operands of a program's choices stay, in sixteen boxes at once (vm/prune/specialise.h).
// Tested by: tests/vm/prune/specialise_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/range/choice_bounds.h"

namespace fathom::vm {

// What a choice does with operands that are far enough apart.
enum class ChoiceRule : std::uint8_t { Keep, Least, Greatest };

// A choice and the choices whose values its operands are, if they are any's.
struct ChoiceLink {
  struct Operand {
    std::uint32_t choice;  // or kNone
    float less;            // than that choice's the value is, by so much
  };
  ChoiceRule rule;
  bool opposite;  // b counts with its sign changed
  bool always;    // what is no choice uses it: it is of interest everywhere
  float width;    // operands further apart than this do not mix
  Operand a, b;
};

// Values beyond these do not matter but for being beyond. [box]
struct Interest {
  alignas(64) float lo[kEnclosedBoxes];
  alignas(64) float hi[kEnclosedBoxes];
};

// The operands of a choice that stay, a bit for each box; neither where the choice itself is not needed.
struct KeptOperands {
  std::uint16_t a, b;
};

inline constexpr std::uint32_t kNone = 0xffffffff;

// Settles choices [0, count), users after what they use. `root` is the choice whose value is the program's, of
// interest within [least, most]. interest[choice] is scratch; kept[choice] the result. Above 0 an operand only loses
// by more than `error`, and by more than kSettleShare of both values: what f32 may be off by.
void settle_choices(const ChoiceLink* links, const ChoiceBounds* bounds, std::size_t count, ChoiceLink::Operand root,
                    float least, float most, float error, Interest* interest, KeptOperands* kept);

inline constexpr float kSettleShare = 0x1p-18f;

// The same of one box, a choice by itself: an operand goes that loses to the other one. Results are bit 0.
void settle_pairs(const ChoiceLink* links, const ChoiceRange* ranges, std::size_t count, KeptOperands* kept);

}  // namespace fathom::vm
