#include "vm/program/opcode.h"

#include <array>
#include <charconv>

namespace fathom::vm {
namespace {

constexpr StackEffect plain_effect(Opcode opcode, Form form) {
  switch (form) {
    case Form::Point:
      return {0, 0, 1, +1};
    case Form::Shape:
    case Form::Outline:
      return {0, +1, 1, 0};
    case Form::Unary:
      return {1, 0, 0, 0};
    case Form::Binary:
      return {2, -1, 0, 0};
    case Form::Ternary:
      return {3, -2, 0, 0};
    case Form::Machine:
      break;
  }
  switch (opcode) {
    case Opcode::Drop:
      return {0, 0, 2, -1};  // the bottom point is the caller's and stays
    case Opcode::Load:
      return {0, +1, 0, 0};
    default:
      return {1, 0, 0, 0};  // Tee, Tag
  }
}

constexpr auto kTable = [] {
  using enum Fact;
  return std::array<OpcodeInfo, kOpcodeCount>{{
#define OP(Name, mnemonic, form, immediates, choice, cost, facts, meaning) \
  {Opcode::Name,                                                           \
   mnemonic,                                                               \
   Form::form,                                                             \
   immediates,                                                             \
   count_names(immediates),                                                \
   Choice::choice,                                                         \
   cost,                                                                   \
   facts,                                                                  \
   plain_effect(Opcode::Name, Form::form),                                 \
   Form::form == Form::Outline || has(facts, Numbered)},
#include "vm/program/opcodes.def"
#undef OP
  }};
}();

// Returns the blank-separated word number `index` of `names`, or an empty view.
std::string_view nth_name(std::string_view names, int index) {
  for (;;) {
    const std::size_t start = names.find_first_not_of(' ');
    if (start == names.npos) return {};
    names.remove_prefix(start);
    const std::string_view name = names.substr(0, names.find(' '));
    if (index-- == 0) return name;
    names.remove_prefix(name.size());
  }
}

}  // namespace

const OpcodeInfo& info(Opcode opcode) { return kTable[static_cast<std::size_t>(opcode)]; }

std::uint32_t group_count(std::uint32_t word) {
  return kTable[word & 0xff].form == Form::Outline ? operand_of(word) : 1;
}

std::uint32_t minimum_groups(Opcode opcode) { return has(info(opcode).facts, Fact::ThreeGroups) ? 3 : 1; }

int leading_immediates(std::uint32_t word) {
  const Form form = kTable[word & 0xff].form;
  if (form == Form::Shape) return operand_of(word) & kFusedTranslate ? 3 : 0;
  if (form != Form::Unary && form != Form::Binary) return 0;
  const Sources sources = sources_of(word);
  return (sources.a == Source::Constant) + (sources.b == Source::Constant);
}

StackEffect effect_of(std::uint32_t word) {
  const OpcodeInfo& row = kTable[word & 0xff];
  if (row.form == Form::Shape && (operand_of(word) & kFusedMin)) return {1, 0, 1, 0};
  if (row.form != Form::Unary && row.form != Form::Binary) return row.effect;
  const Sources sources = sources_of(word);
  const bool a = sources.a == Source::Stack, b = row.form == Form::Binary && sources.b == Source::Stack;
  return {a + b, 1 - a - b, 0, 0};
}

bool is_choice(std::uint32_t word) {
  const OpcodeInfo& row = kTable[word & 0xff];
  return row.choice != Choice::None || (row.form == Form::Shape && (operand_of(word) & kFusedMin) != 0);
}

std::size_t instruction_length(std::uint32_t word) {
  const std::size_t own = std::size_t{group_count(word)} * static_cast<std::size_t>(kTable[word & 0xff].immediates);
  return 1 + static_cast<std::size_t>(leading_immediates(word)) + own;
}

std::uint64_t instruction_cost(std::uint32_t word) {
  const OpcodeInfo& row = kTable[word & 0xff];
  const std::uint32_t modes = row.form == Form::Shape ? operand_of(word) : 0;
  const int moved = modes & kFusedTranslate ? info(Opcode::Translate).cost : 0;
  const int joined = modes & kFusedMin ? info(Opcode::Min).cost : 0;
  return std::uint64_t{group_count(word)} * static_cast<std::uint64_t>(row.cost) +
         static_cast<std::uint64_t>(moved + joined);
}

const OpcodeInfo* find_opcode(std::uint32_t byte) { return byte < kTable.size() ? &kTable[byte] : nullptr; }

std::uint32_t largest_integer(const OpcodeInfo& opcode, int index) {
  if (opcode.immediate_names.find(':') == opcode.immediate_names.npos) return 0;
  const std::string_view name = nth_name(opcode.immediate_names, index);
  const std::size_t colon = name.find(':');
  if (colon == name.npos) return 0;
  std::uint32_t largest = 0;
  std::from_chars(name.data() + colon + 1, name.data() + name.size(), largest);
  return largest;
}

std::string_view immediate_name(const OpcodeInfo& opcode, int index) {
  const std::string_view name = nth_name(opcode.immediate_names, index);
  return name.substr(0, name.find(':'));
}

}  // namespace fathom::vm
