#include "vm/specialise.h"

#include <algorithm>
#include <bit>

#include "vm/check.h"

namespace fathom::vm {
namespace {

static_assert(kEnclosedBoxes == 16);

// Columns of the table (vm/opcode.h), at hand: parts are made of tens of thousands of instructions a picture.
struct Row {
  Opcode opcode;
  Form form;
  bool choice;
  int cost;  // of a function
};
constexpr Row kRows[] = {
#define OP(Name, mnemonic, form, immediates, choice, cost, meaning) \
  {Opcode::Name, Form::form, Choice::choice != Choice::None, cost},
#include "vm/opcodes.def"
#undef OP
};
const Row& row_of(std::uint32_t word) { return kRows[word & 0xff]; }

// The rule of the choice at a word; its operands are not filled in.
ChoiceLink link_of(const Code& code, std::uint32_t at) {
  const std::uint32_t word = code.words[at];
  const auto link = [&](ChoiceRule rule, bool opposite, bool blends) {
    const std::size_t own = at + 1 + static_cast<std::size_t>(leading_immediates(word));
    return ChoiceLink{rule,       opposite,  false, blends ? std::bit_cast<float>(code.words[own]) : 0,
                      {kNone, 0}, {kNone, 0}};
  };
  switch (static_cast<Opcode>(word & 0xff)) {
    case Opcode::Min:
      return link(ChoiceRule::Least, false, false);
    case Opcode::Max:
      return link(ChoiceRule::Greatest, false, false);
    case Opcode::Subtract:
      return link(ChoiceRule::Greatest, true, false);
    case Opcode::SmoothMin:
      return link(ChoiceRule::Least, false, true);
    case Opcode::SmoothMax:
      return link(ChoiceRule::Greatest, false, true);
    case Opcode::SmoothSubtract:
      return link(ChoiceRule::Greatest, true, true);
    default:
      return link(row_of(word).form == Form::Shape ? ChoiceRule::Least : ChoiceRule::Keep, false, false);
  }
}

bool is_function(Form form) { return form == Form::Unary || form == Form::Binary; }
bool is_joined(std::uint32_t word) { return row_of(word).form == Form::Shape && (operand_of(word) & kJoined) != 0; }

}  // namespace

Part whole(const Code& code) {
  Part part;
  part.words.assign(code.words, code.words + code.size);
  part.wide.assign(code.wide, code.wide + code.size);
  part.locals = code.locals, part.max_values = code.max_values, part.max_points = code.max_points;
  part.choices = code.choices;
  for (std::size_t at = 0; at < code.size; at += instruction_length(code.words[at])) {
    part.sources.push_back(static_cast<std::uint32_t>(at));
    part.cost += instruction_cost(code.words[at]);
  }
  return part;
}

bool Specialiser::look(const Part& program, const Boxes& boxes, Workspace& workspace) {
  program_ = &program;
  pairwise_ = false;
  if (!read()) return false;
  enclose(program, boxes, lo_.data(), hi_.data(), bounds_, workspace);
  return true;
}

SlopeBound Specialiser::look(const Part& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace) {
  program_ = &program;
  pairwise_ = true;
  is_read_ = false;  // most of those who ask want the bound alone
  return enclose_slope(program, lo, hi, bounds_, workspace);
}

bool Specialiser::read() {
  is_read_ = expression_.read(*program_);
  if (is_read_) link_choices();
  return is_read_;
}

void Specialiser::link_choices() {
  const auto& nodes = expression_.nodes();
  under_.assign(nodes.size(), {kNone, 0});
  links_.clear(), hands_on_.clear();
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const ExpressionNode& node = nodes[i];
    const std::uint32_t word = program_->words[node.at];
    const Row& row = row_of(word);
    if (node.choice != kNone) {
      ChoiceLink link = link_of(*program_, node.at);
      if (node.a != kNone) link.a = under_[node.a];
      if (node.b != kNone) link.b = under_[node.b];
      link.always = pairwise_;
      links_.push_back(link);
      const Sources sources = is_joined(word) ? Sources{Source::Stack, Source::Local} : sources_of(word);
      hands_on_.push_back({sources.a == Source::Stack, sources.b == Source::Stack && !link.opposite});
      under_[i] = {node.choice, 0};
    } else if (row.form == Form::Machine) {
      under_[i] = under_[node.a];
    } else if (row.opcode == Opcode::Offset && operand_of(word) == 0) {
      under_[i] = under_[node.a];
      under_[i].less += std::bit_cast<float>(program_->words[node.at + 1]);
    } else {
      for (const std::uint32_t operand : {node.a, node.b}) {
        if (operand != kNone && under_[operand].choice != kNone) links_[under_[operand].choice].always = true;
      }
    }
  }
}

void Specialiser::decide(float least, float most) {
  CHECK(is_read_ || read(), "what is to be cut is an expression");
  interest_.resize(links_.size()), kept_.resize(links_.size());
  settle_choices(links_.data(), bounds_.data(), links_.size(), under_[expression_.root()], least, most,
                 interest_.data(), kept_.data());
}

std::uint32_t Specialiser::choices_left(std::size_t box) const {
  std::uint32_t left = 0;
  for (const KeptOperands kept : kept_) left += (kept.a & kept.b) >> box & 1;
  return left;
}

void Specialiser::part(std::size_t box, Part& out) {
  box_ = static_cast<std::uint32_t>(box);
  emitted_.clear();
  locals_ = 0;
  if (expression_.locals() > 0) count_uses();
  tasks_.assign(1, {expression_.root(), Task::Value});
  while (!tasks_.empty()) {
    const Task task = tasks_.back();
    tasks_.pop_back();
    if (task.what == Task::Value) {
      emit(task.node);
    } else if (task.what == Task::Local) {
      define_local(task.node);
    } else {
      emit_whole(task.node);
    }
  }
  write(out);
}

// Where the value of a node comes from once the choices on the way are settled; the node itself when it computes
// something still.
std::uint32_t Specialiser::resolve(std::uint32_t id) const {
  while (true) {
    const ExpressionNode& node = expression_.nodes()[id];
    if (node.choice == kNone) return id;
    const bool a = keeps_a(node.choice), b = keeps_b(node.choice);
    const HandsOn hands_on = hands_on_[node.choice];
    if ((a && b) || !(a ? hands_on.a : hands_on.b)) return id;
    id = a ? node.a : node.b;
  }
}

// How often each local is used in this box; its first use in the order of the code is its definition.
void Specialiser::count_uses() {
  const auto& nodes = expression_.nodes();
  uses_.assign(nodes.size(), {});
  resolved_.resize(nodes.size());
  counted_.assign(1, expression_.root());
  const auto use_local = [&](std::uint32_t tee) {
    if (uses_[tee].left++ == 0) counted_.push_back(nodes[tee].a);
    uses_[tee].shared = uses_[tee].left > 1;
  };
  while (!counted_.empty()) {
    const std::uint32_t wanted = counted_.back(), id = resolve(wanted);
    counted_.pop_back();
    resolved_[wanted] = id;
    const ExpressionNode& node = nodes[id];
    const std::uint32_t word = program_->words[node.at];
    const Row& row = row_of(word);
    if (row.opcode == Opcode::Load) {
      use_local(node.a);
    } else if (row.opcode == Opcode::Tee) {
      use_local(id);
    } else if (row.form == Form::Machine || is_joined(word)) {
      if (row.form == Form::Machine || keeps_a(node.choice)) counted_.push_back(node.a);
    } else if (row.form == Form::Unary || row.form == Form::Binary) {
      const Sources sources = sources_of(word);
      const bool a = node.choice == kNone || keeps_a(node.choice);
      const bool b = row.form == Form::Binary && (node.choice == kNone || keeps_b(node.choice));
      if (a && sources.a == Source::Stack) counted_.push_back(node.a);
      if (a && sources.a == Source::Local) use_local(node.a);
      if (b && sources.b == Source::Stack) counted_.push_back(node.b);
      if (b && sources.b == Source::Local) use_local(node.b);
    }
  }
}

void Specialiser::emit(std::uint32_t id) {
  id = expression_.locals() > 0 ? resolved_[id] : resolve(id);
  const ExpressionNode& node = expression_.nodes()[id];
  const std::uint32_t word = program_->words[node.at];
  const Row& row = row_of(word);
  if (row.form == Form::Unary || row.form == Form::Binary) return emit_operator(id);
  if (row.opcode == Opcode::Load) return use_local(node.a);
  if (row.opcode == Opcode::Tee) return use_local(id);
  if (is_joined(word) && !keeps_a(node.choice)) return emit_word(id, word & ~(kJoined << 8));
  emit_whole(id);
  if (row.opcode == Opcode::Drop) tasks_.push_back({node.point, Task::Instruction});
  if (node.a != kNone) tasks_.push_back({node.a, Task::Value});
}

void Specialiser::emit_word(std::uint32_t id, std::uint32_t word) {
  const std::uint32_t at = expression_.nodes()[id].at;
  const auto length = static_cast<std::uint32_t>(instruction_length(program_->words[at]));
  emitted_.push_back({id, word, at + 1, length - 1});
}

void Specialiser::emit_whole(std::uint32_t id) { emit_word(id, program_->words[expression_.nodes()[id].at]); }

// A function of numbers, or a choice of which one operand is left that lies on no stack or changes its sign.
void Specialiser::emit_operator(std::uint32_t id) {
  const ExpressionNode& node = expression_.nodes()[id];
  const std::uint32_t word = program_->words[node.at];
  Sources sources = sources_of(word);
  const bool binary = row_of(word).form == Form::Binary;
  const bool has_a = node.choice == kNone || keeps_a(node.choice);
  const bool has_b = binary && (node.choice == kNone || keeps_b(node.choice));
  if (binary && has_a != has_b) return emit_lone(id, has_a);
  const std::size_t instruction = emitted_.size();
  emit_whole(id);
  std::uint32_t local = 0;
  // What comes last in the code is taken first.
  Task tasks[2];
  int count = 0;
  if (has_b) sources.b = take(sources.b, node.b, local, tasks, count);
  sources.a = take(sources.a, node.a, local, tasks, count);
  sources.local = local;
  emitted_[instruction].word = (word & 0xff) | operand_of(sources) << 8;
  while (count-- > 0) tasks_.push_back(tasks[count]);
}

// The operand that is left of a choice.
void Specialiser::emit_lone(std::uint32_t id, bool first) {
  const ExpressionNode& node = expression_.nodes()[id];
  const std::uint32_t word = program_->words[node.at];
  const Sources sources = sources_of(word);
  const Source source = first ? sources.a : sources.b;
  const std::uint32_t operand = first ? node.a : node.b;
  const bool negate = !first && links_[node.choice].opposite;
  const std::uint32_t constant = node.at + 1 + (!first && sources.a == Source::Constant ? 1 : 0);
  if (negate) emitted_.push_back({id, opcode_word(Opcode::Negate), 0, 0});
  switch (source) {
    case Source::Stack:
      return tasks_.push_back({operand, Task::Value});
    case Source::Local:
      return use_local(operand);
    case Source::Constant:
      return emitted_.push_back({id, opcode_word(Opcode::Constant), constant, 1});
    default: {
      const auto axis = static_cast<std::uint32_t>(source) - static_cast<std::uint32_t>(Source::X);
      const auto opcode = static_cast<Opcode>(static_cast<std::uint32_t>(Opcode::X) + axis);
      return emitted_.push_back({id, opcode_word(opcode), 0, 0});
    }
  }
}

// Where an operator takes an operand from now: a local that is used nowhere before is computed in its place.
Source Specialiser::take(Source source, std::uint32_t operand, std::uint32_t& local, Task* tasks, int& count) {
  if (source == Source::Local) {
    Local& l = uses_[operand];
    if (--l.left > 0) {
      local = number_of(l);
      return source;
    }
    tasks[count++] = {operand, Task::Local};
    return Source::Stack;
  }
  if (source == Source::Stack) tasks[count++] = {operand, Task::Value};
  return source;
}

void Specialiser::use_local(std::uint32_t tee) {
  Local& local = uses_[tee];
  if (--local.left == 0) return define_local(tee);
  emitted_.push_back({tee, opcode_word(Opcode::Load, number_of(local)), 0, 0});
}

void Specialiser::define_local(std::uint32_t tee) {
  if (uses_[tee].shared) emitted_.push_back({tee, opcode_word(Opcode::Tee, number_of(uses_[tee])), 0, 0});
  tasks_.push_back({expression_.nodes()[tee].a, Task::Value});
}

std::uint32_t Specialiser::number_of(Local& local) {
  if (local.number == kNone) local.number = locals_++;
  return local.number;
}

void Specialiser::write(Part& out) const {
  std::size_t size = 0, at = 0;
  for (const Emitted& e : emitted_) size += 1 + e.count;
  out.words.resize(size), out.wide.resize(size), out.sources.clear();
  out.locals = locals_;
  out.cost = 0, out.choices = 0;
  std::int64_t values = 0, points = 1, most_values = 0, most_points = 1;
  for (std::size_t i = emitted_.size(); i-- > 0;) {
    const Emitted& e = emitted_[i];
    out.words[at] = e.word, out.wide[at] = 0, ++at;
    for (std::uint32_t k = 0; k < e.count; ++k, ++at) {
      out.words[at] = program_->words[e.immediate + k], out.wide[at] = program_->wide[e.immediate + k];
    }
    out.sources.push_back(program_->sources[e.node]);
    const Row& row = row_of(e.word);
    if (is_function(row.form)) {  // most of a formula
      const Sources sources = sources_of(e.word);
      out.cost += row.cost, out.choices += row.choice;
      values += 1 - (sources.a == Source::Stack) - (row.form == Form::Binary && sources.b == Source::Stack);
    } else {
      const StackEffect effect = effect_of(e.word);
      out.cost += instruction_cost(e.word), out.choices += is_choice(e.word);
      values += effect.values_change, points += effect.points_change;
    }
    most_values = std::max(most_values, values), most_points = std::max(most_points, points);
  }
  out.max_values = static_cast<std::uint32_t>(most_values);
  out.max_points = static_cast<std::uint32_t>(most_points);
}

}  // namespace fathom::vm
