#include "runtime/cli/dump/program_json.h"

#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Replaces invalid UTF-8, which file names may contain and JSON must not.
std::string print(const OrderedJson& json) { return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace); }

OrderedJson immediate_json(const vm::Program& program, const vm::OpcodeInfo& row, std::size_t word, int index) {
  return vm::is_integer_immediate(row, index) ? OrderedJson(program.words[word]) : OrderedJson(program.doubles[word]);
}

// Returns the immediates by name. For an outline, returns a list with one object per group.
OrderedJson immediates_json(const vm::Program& program, std::size_t at, const vm::OpcodeInfo& row) {
  const std::uint32_t word = program.words[at];
  OrderedJson groups = OrderedJson::array();
  std::size_t next = at + 1 + static_cast<std::size_t>(vm::leading_immediates(word));
  for (std::uint32_t group = 0; group < vm::group_count(word); ++group) {
    OrderedJson& immediates = groups.emplace_back(OrderedJson::object());
    for (int i = 0; i < row.immediates; ++i) {
      immediates[std::string(vm::immediate_name(row, i))] = immediate_json(program, row, next++, i);
    }
  }
  return row.form == vm::Form::Outline ? groups : groups[0];
}

// Adds the flags in the operand of an instruction: "at" and "min" of a shape, "operands" of a function.
void add_modes(OrderedJson& line, const vm::Program& program, std::size_t at, const vm::OpcodeInfo& row) {
  const std::uint32_t word = program.words[at];
  const std::uint32_t operand = vm::operand_of(word);
  if (row.has_operand) line["operand"] = operand;
  if (row.has_operand || operand == 0) return;
  const double* leading = program.doubles.data() + at + 1;
  if (row.form == vm::Form::Shape) {
    if (operand & vm::kFusedTranslate) line["at"] = {leading[0], leading[1], leading[2]};
    if (operand & vm::kFusedMin) line["min"] = true;
    return;
  }
  const vm::Sources sources = vm::sources_of(word);
  const auto source = [&](vm::Source from) -> OrderedJson {
    if (from == vm::Source::Constant) return *leading++;
    if (from == vm::Source::Local) return {{"local", sources.local}};
    constexpr const char* kNames[] = {"stack", "x", "y", "z"};
    return kNames[static_cast<int>(from)];
  };
  line["operands"] = OrderedJson::array({source(sources.a)});
  if (row.form == vm::Form::Binary) line["operands"].push_back(source(sources.b));
}

OrderedJson source_json(const vm::DebugEntry& entry) {
  if (entry.line == 0) return nullptr;
  return {{"line", entry.line}, {"column", entry.column}};
}

}  // namespace

std::string program_json(const vm::VerifiedProgram& verified, std::string_view which,
                         const compiler::CompiledScene& scene) {
  const vm::Program& program = verified.program();
  OrderedJson head = {{"scene", program.source_name}, {"program", which}, {"summary", scene.summary}};
  if (scene.origin != glm::dvec3(0)) head["origin"] = {scene.origin.x, scene.origin.y, scene.origin.z};
  head["instructions"] = verified.instructions();
  head["words"] = program.words.size();
  head["max_values"] = verified.max_values();
  head["max_points"] = verified.max_points();
  head["locals"] = program.locals;
  head["cost"] = verified.cost();
  std::string out = print(head);
  out.back() = ',';  // the object continues below
  out += "\"code\":[";
  int values = 0, points = 1;
  for (std::size_t i = 0, at = 0; at < program.words.size(); ++i) {
    const vm::OpcodeInfo& row = *vm::find_opcode(program.words[at] & 0xff);
    OrderedJson line = {{"offset", at}, {"op", row.mnemonic}};
    add_modes(line, program, at, row);
    line["immediates"] = immediates_json(program, at, row);
    const vm::StackEffect effect = vm::effect_of(program.words[at]);
    line["values"] = {values, values + effect.values_change};
    line["points"] = {points, points + effect.points_change};
    line["cost"] = vm::instruction_cost(program.words[at]);
    if (i < program.debug.size()) {
      line["source"] = source_json(program.debug[i]);
      line["symbol"] = program.debug[i].symbol;
    }
    out += (i == 0 ? "\n" : ",\n") + print(line);
    values += effect.values_change;
    points += effect.points_change;
    at += vm::instruction_length(program.words[at]);
  }
  return out + "\n]}\n";
}

}  // namespace fathom::cli
