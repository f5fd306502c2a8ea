#include "compiler/lower/fuse.h"

#include <optional>
#include <utility>
#include <vector>

namespace fathom::compiler {
namespace {

using vm::Form;
using vm::Opcode;

struct Step {
  Opcode opcode;
  std::uint32_t operand;
  std::vector<double> immediates;
  vm::DebugEntry entry;

  Form form() const { return vm::info(opcode).form; }
};

std::vector<Step> steps_of(vm::Program& program) {
  std::vector<Step> steps;
  steps.reserve(program.debug.size());
  for (std::size_t at = 0; at < program.words.size();) {
    const std::uint32_t word = program.words[at];
    const std::size_t end = at + vm::instruction_length(word);
    const vm::OpcodeInfo& row = *vm::find_opcode(word & 0xff);
    const std::size_t own = at + 1 + static_cast<std::size_t>(vm::leading_immediates(word));
    Step step{row.opcode, vm::operand_of(word), {}, std::move(program.debug[steps.size()])};
    for (std::size_t i = at + 1; i < end; ++i) {
      const bool integer = i >= own && vm::is_integer_immediate(row, static_cast<int>(i - own));
      step.immediates.push_back(integer ? program.words[i] : program.doubles[i]);
    }
    if (row.form == Form::Outline) step.operand = 0;  // append() counts the groups
    steps.push_back(std::move(step));
    at = end;
  }
  return steps;
}

// Returns the operand source that can replace the value that the step pushes, or Stack if none can.
vm::Source source_of(const Step& step) {
  switch (step.opcode) {
    case Opcode::X:
    case Opcode::Y:
    case Opcode::Z:
      return step.operand == 0 ? static_cast<vm::Source>(static_cast<int>(step.opcode) - static_cast<int>(Opcode::X) + 1)
                               : vm::Source::Stack;
    case Opcode::Constant:
      return step.operand == 0 ? vm::Source::Constant : vm::Source::Stack;
    case Opcode::Load:
      return step.operand <= vm::kMaxLocalSource ? vm::Source::Local : vm::Source::Stack;
    default:
      return vm::Source::Stack;
  }
}

class Fusing {
 public:
  explicit Fusing(std::size_t steps) { out_.reserve(steps); }

  void add(Step step) {
    if (step.opcode == Opcode::Drop && move_shape()) return;
    const bool plain = step.operand == 0;
    if (step.opcode == Opcode::Min && plain && join_shape()) return;
    if ((step.form() == Form::Unary || step.form() == Form::Binary) && plain) take_operands(step);
    out_.push_back(std::move(step));
  }

  std::vector<Step> take() { return std::move(out_); }

 private:
  bool is_shape(std::size_t from_end, std::uint32_t without) const {
    if (out_.size() < from_end) return false;
    const Step& step = out_[out_.size() - from_end];
    return step.form() == Form::Shape && (step.operand & without) == 0;
  }

  // Fuses translate, shape, drop into a moved shape.
  bool move_shape() {
    if (!is_shape(1, vm::kFusedTranslate | vm::kFusedMin) || out_.size() < 2) return false;
    if (out_[out_.size() - 2].opcode != Opcode::Translate) return false;
    Step shape = std::move(out_.back());
    out_.pop_back();
    const std::vector<double> by = std::move(out_.back().immediates);
    shape.immediates.insert(shape.immediates.begin(), by.begin(), by.end());
    shape.operand |= vm::kFusedTranslate;
    out_.back() = std::move(shape);
    return true;
  }

  // Fuses shape, min into a joined shape.
  bool join_shape() {
    if (!is_shape(1, vm::kFusedMin) || source_of(out_.back()) != vm::Source::Stack) return false;
    out_.back().operand |= vm::kFusedMin;
    return true;
  }

  void take_operands(Step& step) {
    vm::Sources sources;
    if (step.form() == Form::Binary) sources.b = take_operand(step, sources);
    if (step.form() == Form::Unary || sources.b != vm::Source::Stack) sources.a = take_operand(step, sources);
    step.operand = vm::operand_of(sources);
  }

  // Removes the last step from the program if another source can replace the operand that the step pushes. Returns
  // the operand's source.
  vm::Source take_operand(Step& step, vm::Sources& sources) {
    if (out_.empty()) return vm::Source::Stack;
    const Step& last = out_.back();
    const vm::Source source = source_of(last);
    if (source == vm::Source::Stack) return source;
    if (source == vm::Source::Local) {
      // an instruction has room for one local
      if (sources.b == vm::Source::Local && sources.local != last.operand) return vm::Source::Stack;
      sources.local = last.operand;
    }
    step.immediates.insert(step.immediates.begin(), last.immediates.begin(), last.immediates.end());
    out_.pop_back();
    return source;
  }

  std::vector<Step> out_;
};

}  // namespace

vm::Program fuse(vm::Program program) {
  std::vector<Step> steps = steps_of(program);
  Fusing fusing(steps.size());
  for (Step& step : steps) fusing.add(std::move(step));
  vm::Program fused;
  fused.locals = program.locals;
  fused.source_name = program.source_name;
  for (Step& step : fusing.take()) {
    fused.append(step.opcode, step.operand, step.immediates, std::move(step.entry));
  }
  return fused;
}

}  // namespace fathom::compiler
