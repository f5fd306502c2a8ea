#include "vm/program/convexity.h"

#include "vm/program/opcode_rows.h"

namespace fathom::vm {

double convex_share(const Code& program) {
  std::uint64_t affine = 1, convex = 0, total = 0;  // affine: as Cursor::affine in vm/interpret/interpret-inl.h
  for (std::size_t at = 0; at < program.size; at += instruction_length(program.words[at])) {
    const std::uint32_t word = program.words[at];
    const Opcode opcode = static_cast<Opcode>(word & 0xff);
    if (info(opcode).form == Form::Point) affine = affine << 1 | (affine & (has(opcode, Fact::Affine) ? 1 : 0));
    if (opcode == Opcode::Drop) affine >>= 1;
    const std::uint64_t cost = instruction_cost(word);
    total += cost;
    if (has(opcode, Fact::Convex) && affine & 1) convex += cost;
  }
  return total == 0 ? 0 : static_cast<double>(convex) / static_cast<double>(total);
}

}  // namespace fathom::vm
