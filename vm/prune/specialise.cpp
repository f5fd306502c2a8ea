#include "vm/prune/specialise.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "vm/program/check.h"
#include "vm/program/opcode_rows.h"

namespace fathom::vm {
namespace {

static_assert(kEnclosedBoxes == 16);

// Returns the link of the choice at word `at`, without the operands.
ChoiceLink link_of(const Code& code, std::uint32_t at) {
  const std::uint32_t word = code.words[at];
  const OpcodeRow& row = row_of(is_joined(word) ? opcode_word(Opcode::Min) : word);
  const std::size_t own = at + 1 + static_cast<std::size_t>(leading_immediates(word));
  ChoiceRule rule = ChoiceRule::Keep;
  if (has(row.facts, Fact::Hard | Fact::Smooth)) {
    rule = row.choice == Choice::Lesser ? ChoiceRule::Least : ChoiceRule::Greatest;
  }
  const float width = has(row.facts, Fact::Smooth) ? std::bit_cast<float>(code.words[own]) : 0;
  return {rule, row.choice == Choice::Carve, false, width, {kNone, 0}, {kNone, 0}};
}

}  // namespace

bool Specialiser::enclose_choices(const PrunedProgram& program, const Boxes& boxes, Workspace& workspace) {
  program_ = &program;
  independent_ = false;
  if (!read()) return false;
  enclose(program, boxes, lo_.data(), hi_.data(), bounds_, workspace);
  return true;
}

SlopeBound Specialiser::enclose_choices(const PrunedProgram& program, glm::dvec3 lo, glm::dvec3 hi,
                                        Workspace& workspace) {
  program_ = &program;
  independent_ = true;
  is_read_ = false;  // resolve() calls read(), because most callers want only the bound
  return enclose_slope(program, lo, hi, ranges_, workspace);
}

bool Specialiser::read() {
  is_read_ = graph_.read(*program_);
  if (!is_read_) return false;
  links_.clear(), forwards_operand_.clear();
  if (independent_) {
    link_pairs();
  } else {
    link_choices();
  }
  const std::vector<std::uint32_t>& tees = graph_.tees();
  if (!tees.empty()) number_.resize(graph_.nodes().size());
  for (std::uint32_t i = 0; i < tees.size(); ++i) number_[tees[i]] = i;
  return true;
}

void Specialiser::link_pairs() {
  for (const std::uint32_t id : graph_.choices()) link_choice(id);
}

// Adds the link of the choice at node `id`, without the choices of its operands.
ChoiceLink& Specialiser::link_choice(std::uint32_t id) {
  const std::uint32_t at = graph_.nodes()[id].at, word = program_->words[at];
  const Sources sources = is_joined(word) ? Sources{Source::Stack, Source::Local} : sources_of(word);
  ChoiceLink& link = links_.emplace_back(link_of(*program_, at));
  forwards_operand_.push_back({sources.a == Source::Stack, sources.b == Source::Stack && !link.opposite});
  return link;
}

void Specialiser::link_choices() {
  const auto& nodes = graph_.nodes();
  producer_choice_.assign(nodes.size(), {kNone, 0});
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const DefUseNode& node = nodes[i];
    const std::uint32_t word = program_->words[node.at];
    const OpcodeRow& row = row_of(word);
    if (node.choice != kNone) {
      ChoiceLink& link = link_choice(i);
      if (node.a != kNone) link.a = producer_choice_[node.a];
      if (node.b != kNone) link.b = producer_choice_[node.b];
      producer_choice_[i] = {node.choice, 0};
    } else if (row.form == Form::Machine) {
      producer_choice_[i] = producer_choice_[node.a];
    } else if (row.opcode == Opcode::Offset && operand_of(word) == 0) {
      producer_choice_[i] = producer_choice_[node.a];
      producer_choice_[i].less += std::bit_cast<float>(program_->words[node.at + 1]);
    } else {
      for (const std::uint32_t operand : {node.a, node.b, node.c}) {
        if (operand != kNone && producer_choice_[operand].choice != kNone)
          links_[producer_choice_[operand].choice].always = true;
      }
    }
  }
}

void Specialiser::resolve(float least, float most, float error) {
  CHECK(is_read_ || read(), "what is to be cut is an expression");
  live_.resize(links_.size());
  is_counted_ = false;
  if (independent_) return resolve_pairs(links_.data(), ranges_.data(), links_.size(), live_.data());
  demanded_.resize(links_.size());
  resolve_choices(links_.data(), bounds_.data(), links_.size(), producer_choice_[graph_.root()], least, most, error,
                  demanded_.data(), live_.data());
}

std::uint32_t Specialiser::choices_left(std::size_t box) const {
  std::uint32_t left = 0;
  for (const LiveOperands live : live_) left += (live.a & live.b) >> box & 1;
  return left;
}

void Specialiser::prune(std::size_t box, PrunedProgram& out) {
  box_ = static_cast<std::uint32_t>(box);
  locals_ = 0;
  if (!graph_.tees().empty()) begin_locals();
  writer_.begin(*program_);
  waiting_ = 0;
  push(graph_.root(), Task::Value);
  while (waiting_ > 0) {
    const Task task = tasks_[--waiting_];
    if (task.what == Task::Value) {
      emit(forward_of(task.node));
    } else if (task.what == Task::Local) {
      define_local(task.node);
    } else {
      emit_whole(task.node);
    }
  }
  writer_.finish(locals_, out);
}

// Follows choices that return a kept operand unchanged. Returns the first node from `id` on that computes something.
std::uint32_t Specialiser::forward_of(std::uint32_t id) const {
  while (true) {
    const DefUseNode& node = graph_.nodes()[id];
    if (node.choice == kNone) return id;
    const bool a = keeps_a(node.choice), b = keeps_b(node.choice);
    const ForwardsOperand forwards_operand = forwards_operand_[node.choice];
    if ((a && b) || !(a ? forwards_operand.a : forwards_operand.b)) return id;
    id = a ? node.a : node.b;
  }
}

// Counts the uses of each local per box. The first use in the order of the code becomes the local's definition. Users
// come after what they use, so one pass from the last node to the first sees all uses of a node before that node.
void Specialiser::count_uses() {
  const auto& nodes = graph_.nodes();
  needed_.assign(nodes.size(), 0);
  uses_.assign(graph_.tees().size(), {});
  need(graph_.root(), independent_ ? 1 : 0xffff);
  for (std::uint32_t id = graph_.root() + 1; id-- > 0;) {
    const DefUseNode& node = nodes[id];
    const std::uint32_t word = program_->words[node.at];
    const OpcodeRow& row = row_of(word);
    std::uint32_t boxes = needed_[id];
    if (row.opcode == Opcode::Tee) boxes |= uses_[number_[id]].boxes;
    if (boxes == 0) continue;
    const std::uint32_t a = node.choice == kNone ? boxes : boxes & live_[node.choice].a;
    const std::uint32_t b = node.choice == kNone ? boxes : boxes & live_[node.choice].b;
    if (is_function(row.form)) {
      const Sources sources = sources_of(word);
      need_operand(sources.a, node.a, a);
      if (row.form == Form::Binary) need_operand(sources.b, node.b, b);
    } else if (row.form == Form::Ternary) {
      for (const std::uint32_t operand : {node.a, node.b, node.c}) need(operand, boxes);
    } else if (row.opcode == Opcode::Load) {
      need_operand(Source::Local, node.a, boxes);
    } else if (row.form == Form::Machine || is_joined(word)) {
      need(node.a, a);
    }
  }
  is_counted_ = true;
}

// Marks the value of `node` as needed at its place on the stack.
void Specialiser::need(std::uint32_t node, std::uint32_t boxes) {
  needed_[node] = static_cast<std::uint16_t>(needed_[node] | boxes);
  const bool tee = row_of(program_->words[graph_.nodes()[node].at]).opcode == Opcode::Tee;
  if (tee) count_use(uses_[number_[node]], boxes);
}

void Specialiser::need_operand(Source source, std::uint32_t node, std::uint32_t boxes) {
  if (source == Source::Stack) return need(node, boxes);
  if (source != Source::Local) return;
  Uses& uses = uses_[number_[node]];
  uses.boxes |= boxes;
  count_use(uses, boxes);
}

void Specialiser::count_use(Uses& uses, std::uint32_t boxes) {
  for (; boxes != 0; boxes &= boxes - 1) ++uses.count[static_cast<std::size_t>(std::countr_zero(boxes))];
}

void Specialiser::begin_locals() {
  if (!is_counted_) count_uses();
  local_.clear();
  for (const Uses& uses : uses_) local_.push_back({uses.count[box_], uses.count[box_] > 1, kNone});
}

void Specialiser::emit(std::uint32_t id) {
  const DefUseNode& node = graph_.nodes()[id];
  const std::uint32_t word = program_->words[node.at];
  const OpcodeRow& row = row_of(word);
  if (is_function(row.form)) return emit_operator(id, node, word, row);
  if (row.opcode == Opcode::Load) return use_local(node.a);
  if (row.opcode == Opcode::Tee) return use_local(id);
  if (is_joined(word) && !keeps_a(node.choice)) {
    return writer_.put(id, word & ~(kFusedMin << 8), node.at + 1, immediates_of(word));
  }
  emit_whole(id);
  if (row.opcode == Opcode::Drop) push(node.point, Task::Instruction);
  if (node.a != kNone) push(node.a, Task::Value);
  if (row.form != Form::Ternary) return;
  push(node.b, Task::Value);  // pushed later and so written first, because the code is written backwards
  push(node.c, Task::Value);
}

void Specialiser::emit_whole(std::uint32_t id) {
  const std::uint32_t at = graph_.nodes()[id].at, word = program_->words[at];
  writer_.put(id, word, at + 1, immediates_of(word));
}

// Emits a Unary or Binary, or the remaining operand of a choice, if that is not on the stack or changes its sign.
void Specialiser::emit_operator(std::uint32_t id, const DefUseNode& node, std::uint32_t word, const OpcodeRow& row) {
  if (node.choice != kNone) {
    const bool has_a = keeps_a(node.choice);
    if (has_a != keeps_b(node.choice)) return emit_lone(id, has_a);
  }
  Sources sources = sources_of(word);
  const std::uint32_t immediates =
      static_cast<std::uint32_t>(row.immediates) + (sources.a == Source::Constant) + (sources.b == Source::Constant);
  // The code is written backwards, so the operand that comes last in the code is taken and written first.
  std::uint32_t local = 0;
  const std::size_t first = waiting_;
  if (row.form == Form::Binary) sources.b = take(sources.b, node.b, local);
  sources.a = take(sources.a, node.a, local);
  if (waiting_ == first + 2) std::swap(tasks_[first], tasks_[first + 1]);
  sources.local = local;
  writer_.put_function(id, (word & 0xff) | operand_of(sources) << 8, row, node.at + 1, immediates);
}

// Emits the remaining operand of a choice, `a` if `first`, else b.
void Specialiser::emit_lone(std::uint32_t id, bool first) {
  const DefUseNode& node = graph_.nodes()[id];
  const std::uint32_t word = program_->words[node.at];
  const Sources sources = sources_of(word);
  const Source source = first ? sources.a : sources.b;
  const std::uint32_t operand = first ? node.a : node.b;
  const bool negate = !first && links_[node.choice].opposite;
  const std::uint32_t constant = node.at + 1 + (!first && sources.a == Source::Constant ? 1 : 0);
  if (negate) writer_.put(id, opcode_word(Opcode::Negate), 0, 0);
  switch (source) {
    case Source::Stack:
      return push(operand, Task::Value);
    case Source::Local:
      return use_local(operand);
    case Source::Constant:
      return writer_.put(id, opcode_word(Opcode::Constant), constant, 1);
    default: {
      const auto axis = static_cast<std::uint32_t>(source) - static_cast<std::uint32_t>(Source::X);
      const auto opcode = static_cast<Opcode>(static_cast<std::uint32_t>(Opcode::X) + axis);
      return writer_.put(id, opcode_word(opcode), 0, 0);
    }
  }
}

// Returns the source of an operator's operand in the part. A local that is not used earlier in the code is computed
// in place, on the stack.
Source Specialiser::take(Source source, std::uint32_t operand, std::uint32_t& local) {
  if (source == Source::Local) {
    Local& l = local_[number_[operand]];
    if (--l.left > 0) {
      local = number_of(l);
      return source;
    }
    push(operand, Task::Local);
    return Source::Stack;
  }
  if (source == Source::Stack) push(operand, Task::Value);
  return source;
}

void Specialiser::use_local(std::uint32_t tee) {
  Local& local = local_[number_[tee]];
  if (--local.left == 0) return define_local(tee);
  writer_.put(tee, opcode_word(Opcode::Load, number_of(local)), 0, 0);
}

void Specialiser::define_local(std::uint32_t tee) {
  Local& local = local_[number_[tee]];
  if (local.shared) writer_.put(tee, opcode_word(Opcode::Tee, number_of(local)), 0, 0);
  push(graph_.nodes()[tee].a, Task::Value);
}

std::uint32_t Specialiser::number_of(Local& local) {
  if (local.number == kNone) local.number = locals_++;
  return local.number;
}

}  // namespace fathom::vm
