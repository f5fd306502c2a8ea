#include "vm/program/program.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "vm/program/check.h"

namespace fathom::vm {

void Program::append(Opcode opcode, std::uint32_t operand, const std::vector<double>& immediates, DebugEntry entry) {
  const OpcodeInfo& row = info(opcode);
  const std::size_t group = static_cast<std::size_t>(row.immediates);
  if (row.form == Form::Outline) {
    CHECK(operand == 0 && immediates.size() % group == 0, "an outline has whole groups, which make its operand");
    operand = static_cast<std::uint32_t>(std::min<std::size_t>(immediates.size() / group, kMaxOperand + 1));
  }
  CHECK(operand <= kMaxOperand, "an operand fits 24 bits");
  const std::uint32_t word = opcode_word(opcode, operand);
  CHECK(1 + immediates.size() == instruction_length(word), "an instruction has the immediates its row names");
  entry.offset = static_cast<std::uint32_t>(words.size());
  words.push_back(word);
  doubles.push_back(0.0);
  const auto leading = static_cast<std::size_t>(leading_immediates(word));
  for (std::size_t i = 0; i < immediates.size(); ++i) {
    const double value = immediates[i] + 0.0;  // -0 becomes 0
    const bool integer = i >= leading && is_integer_immediate(row, static_cast<int>((i - leading) % group));
    words.push_back(integer ? static_cast<std::uint32_t>(value)
                            : std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    doubles.push_back(integer ? 0.0 : value);
  }
  debug.push_back(std::move(entry));
}

}  // namespace fathom::vm
