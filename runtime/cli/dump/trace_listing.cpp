#include "runtime/cli/dump/trace_listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "vm/encoding/disassemble.h"
#include "vm/interpret/trace.h"
#include "vm/program/opcode.h"

namespace fathom::cli {
namespace {

constexpr std::size_t kShown = 4;  // entries shown per stack, from the top

std::string text_of(float value) { return std::isnan(value) ? "nan" : fmt::format("{}", value); }
std::string text_of(glm::vec3 p) { return fmt::format("({} {} {})", text_of(p.x), text_of(p.y), text_of(p.z)); }

// Formats a stack, its top last.
template <typename Entry>
std::string text_of(const char* name, const std::vector<Entry>& stack) {
  if (stack.empty()) return "";
  std::string text = fmt::format("   {}", name);
  const std::size_t hidden = stack.size() > kShown ? stack.size() - kShown : 0;
  if (hidden > 0) text += fmt::format(" [{} more]", hidden);
  for (std::size_t i = hidden; i < stack.size(); ++i) text += " " + text_of(stack[i]);
  return text;
}

// Returns the non-finite number on top of a stack, if any. Deeper entries were reported by earlier steps.
std::optional<float> not_finite(const vm::TraceStep& step) {
  const glm::vec3 p = step.points.back();
  for (const float number : {step.values.empty() ? 0.0f : step.values.back(), p.x, p.y, p.z}) {
    if (!std::isfinite(number)) return number;
  }
  return std::nullopt;
}

}  // namespace

double trace_work(const vm::VerifiedProgram& program) {
  constexpr double kDispatch = 8;  // cost of dispatching an instruction, in multiply-adds
  const std::vector<std::uint32_t>& words = program.program().words;
  double prefix = 0, work = 0;
  for (std::size_t at = 0; at < words.size(); at += vm::instruction_length(words[at])) {
    const vm::OpcodeInfo& row = *vm::find_opcode(words[at] & 0xff);
    double rounds = 1;  // iterations of loops within the shape
    for (int i = 0; row.form != vm::Form::Outline && i < row.immediates; ++i) {
      const std::size_t own = at + 1 + static_cast<std::size_t>(vm::leading_immediates(words[at]));
      if (vm::is_integer_immediate(row, i))
        rounds = std::max(rounds, static_cast<double>(words[own + static_cast<std::size_t>(i)]));
    }
    prefix += kDispatch + static_cast<double>(vm::instruction_cost(words[at])) * rounds;
    work += prefix;
  }
  return work;
}

std::string trace_listing(const vm::VerifiedProgram& program, glm::dvec3 point) {
  const std::string listing = vm::disassemble(program, {.unrolled = true});
  std::string text = fmt::format("; at {} {} {}\n", point.x, point.y, point.z), first;
  std::size_t at = 0;
  const auto next_line = [&] {
    const std::size_t end = listing.find('\n', at) + 1;
    const std::string line = listing.substr(at, end - at);
    at = end;
    return line;
  };
  while (listing[at] != ' ') text += next_line();  // the listing's head
  vm::trace(program, point, [&](const vm::TraceStep& step) {
    const std::string line = next_line();
    text += line + ";" + text_of("points", step.points) + text_of("values", step.values) + "\n";
    const std::optional<float> bad = first.empty() ? not_finite(step) : std::nullopt;
    if (bad)
      first = fmt::format("; the first number that is not finite, {}, is left by{}", text_of(*bad), line.substr(1));
  });
  return text + first;
}

}  // namespace fathom::cli
