#include "runtime/cli/program_json.h"

#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

// A file's name may be no UTF-8; JSON must be.
std::string print(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json immediates_json(const vm::Program& program, std::size_t at, const vm::OpcodeInfo& row) {
  Json immediates = Json::object();
  for (int i = 0; i < row.immediates; ++i) {
    const std::size_t word = at + 1 + static_cast<std::size_t>(i);
    Json& value = immediates[std::string(vm::immediate_name(row, i))];
    if (vm::is_integer_immediate(row, i)) {
      value = program.words[word];
    } else {
      value = program.wide[word];
    }
  }
  return immediates;
}

Json source_json(const vm::DebugEntry& entry) {
  if (entry.line == 0) return nullptr;
  return {{"line", entry.line}, {"column", entry.column}};
}

}  // namespace

std::string program_json(const vm::VerifiedProgram& verified, std::string_view which, std::string_view summary) {
  const vm::Program& program = verified.program();
  const Json head = {{"scene", program.source_name},
                     {"program", which},
                     {"summary", summary},
                     {"instructions", verified.instructions()},
                     {"words", program.words.size()},
                     {"max_values", verified.max_values()},
                     {"max_points", verified.max_points()},
                     {"locals", program.locals},
                     {"cost", verified.cost()}};
  std::string out = print(head);
  out.back() = ',';  // the object goes on
  out += "\"code\":[";
  int values = 0, points = 1;
  for (std::size_t i = 0, at = 0; at < program.words.size(); ++i) {
    const vm::OpcodeInfo& row = *vm::find_opcode(program.words[at] & 0xff);
    Json line = {{"offset", at}, {"op", row.mnemonic}};
    if (row.has_operand) line["operand"] = vm::operand_of(program.words[at]);
    line["immediates"] = immediates_json(program, at, row);
    line["values"] = {values, values + row.effect.values_change};
    line["points"] = {points, points + row.effect.points_change};
    line["cost"] = row.cost;
    if (i < program.debug.size()) {
      line["source"] = source_json(program.debug[i]);
      line["symbol"] = program.debug[i].symbol;
    }
    out += (i == 0 ? "\n" : ",\n") + print(line);
    values += row.effect.values_change;
    points += row.effect.points_change;
    at += 1 + static_cast<std::size_t>(row.immediates);
  }
  return out + "\n]}\n";
}

}  // namespace fathom::cli
