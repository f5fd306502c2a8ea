#include "compiler/source/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vm/number/decimal.h"
#include "vm/program/verify.h"

namespace fathom::compiler {

std::string raise(double Limits::*value, double needed) {
  const LimitRow& row = limit_row(value);
  if (needed > row.largest) return fmt::format("{} {} are the most that can be: {}", row.largest, row.unit, row.why);
  // Rounds up to two significant digits, which are easy to read.
  const double step = vm::real::power_of_ten(std::max(0, vm::real::decimal_exponent(needed) - 1));
  const double enough = std::min(row.largest, std::ceil(needed / step) * step);
  return fmt::format("`--limit {}={}` allows more", row.name, enough);
}

vm::Limits largest_machine() {
  vm::Limits machine;
  machine.stack = static_cast<std::uint32_t>(limit_row(&Limits::stack).largest);
  machine.locals = static_cast<std::uint32_t>(limit_row(&Limits::locals).largest);
  machine.words = static_cast<std::uint32_t>(16 * limit_row(&Limits::instructions).largest);
  return machine;
}

std::optional<Excess> excess_of(const vm::VerifiedProgram& program, const Limits& limits) {
  const struct {
    double Limits::*limit;
    double needed;
    const char* sentence;
  } sizes[] = {
      {&Limits::instructions, static_cast<double>(program.instructions()), "the program has {} instructions"},
      {&Limits::stack, static_cast<double>(std::max(program.max_values(), program.max_points())),
       "the program needs a stack of {} values"},
      {&Limits::locals, static_cast<double>(program.program().locals), "the program remembers {} values"},
  };
  for (const auto& [limit, needed, sentence] : sizes) {
    if (needed <= limits.*limit) continue;
    return Excess{fmt::format("{}, and {} are allowed", fmt::format(fmt::runtime(sentence), needed), limits.*limit),
                  raise(limit, needed)};
  }
  return std::nullopt;
}

std::optional<Excess> excess_of(double nodes, const Limits& limits) {
  if (limits.memory > 0 && kBytesPerNode * nodes > limits.memory) {
    return Excess{fmt::format("the scene's {} nodes up to here take more than {:.15g} bytes of memory, {} per node",
                              nodes, limits.memory, kBytesPerNode),
                  raise(&Limits::memory, 2 * limits.memory)};
  }
  if (nodes <= limits.nodes) return std::nullopt;
  return Excess{fmt::format("the scene has more than {} nodes here", limits.nodes),
                raise(&Limits::nodes, 2 * limits.nodes)};
}

}  // namespace fathom::compiler
