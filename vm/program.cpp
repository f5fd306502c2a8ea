#include "vm/program.h"

#include <bit>
#include <utility>

#include "vm/check.h"

namespace fathom::vm {

void Program::append(Opcode opcode, std::uint32_t operand, const std::vector<double>& immediates, DebugEntry entry) {
  const OpcodeInfo& row = info(opcode);
  CHECK(static_cast<int>(immediates.size()) == row.immediates, "an instruction has the immediates its row names");
  CHECK(operand <= kMaxOperand, "an operand fits 24 bits");
  entry.offset = static_cast<std::uint32_t>(words.size());
  words.push_back(opcode_word(opcode, operand));
  wide.push_back(0.0);
  for (int i = 0; i < row.immediates; ++i) {
    const double value = immediates[static_cast<std::size_t>(i)] + 0.0;  // -0 becomes 0
    const bool integer = is_integer_immediate(row, i);
    words.push_back(integer ? static_cast<std::uint32_t>(value)
                            : std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    wide.push_back(integer ? 0.0 : value);
  }
  debug.push_back(std::move(entry));
}

}  // namespace fathom::vm
