#include "compiler/emit/function_library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "compiler/emit/print_function.h"
#include "vm/record/record.h"

namespace fathom::compiler {
namespace {

using vm::Form;
using vm::OpcodeInfo;

// Returns how many numbers a row takes; 0 when it takes a point.
std::size_t numbers_of(const OpcodeInfo& row) {
  return row.form == Form::Unary ? 1 : row.form == Form::Binary ? 2 : row.form == Form::Ternary ? 3 : 0;
}
bool takes_point(const OpcodeInfo& row) { return numbers_of(row) == 0; }

// Returns the names of the row's immediates that become function parameters.
std::vector<std::string> parameter_names(const Language& language, const OpcodeInfo& row) {
  std::vector<std::string> names;
  if (row.form == Form::Outline) return names;
  for (int i = 0; i < row.immediates; ++i) {
    if (!vm::is_integer_immediate(row, i)) names.push_back(language.free_name(vm::immediate_name(row, i)));
  }
  return names;
}

// Returns the texts of the recorded function's parameters: first `operands`, then `floats` for all other immediates
// than integers.
std::vector<Expression> parameter_texts(const Language& language, const OpcodeInfo& row,
                                        std::span<const Expression> operands, std::span<const std::string> floats) {
  std::vector<Expression> texts;
  if (takes_point(row)) {
    for (const char* axis : {".x", ".y", ".z"}) texts.push_back({operands[0].text + axis});
  } else {
    texts.assign(operands.begin(), operands.end());
  }
  if (row.form == Form::Outline) return texts;
  for (int i = 0; i < row.immediates; ++i) {
    if (vm::is_integer_immediate(row, i)) {
      texts.push_back({""});
    } else {
      texts.push_back(language.number(floats.front()));
      floats = floats.subspan(1);
    }
  }
  return texts;
}

std::string joined(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, ", ")); }

}  // namespace

Expression FunctionLibrary::apply(vm::Opcode opcode, const std::vector<Expression>& operands,
                                  const Immediates& immediates) {
  const OpcodeInfo& row = vm::info(opcode);
  Function& function = function_of(row, immediates);
  std::vector<std::string> floats;
  for (int i = 0; row.form != Form::Outline && i < row.immediates; ++i) {
    if (vm::is_integer_immediate(row, i)) continue;
    const auto at = static_cast<std::size_t>(i);
    const bool has_text = at < immediates.texts.size() && !immediates.texts[at].empty();
    floats.push_back(has_text ? immediates.texts[at] : language_.immediate(immediates.doubles[at]));
  }
  if (const auto expression =
          as_expression(language_, function.recorded, parameter_texts(language_, row, operands, floats))) {
    print_called(function.recorded);
    return *expression;
  }
  if (!function.printed) print(function, row);
  std::vector<std::string> arguments;
  for (const Expression& operand : operands) arguments.push_back(operand.text);
  arguments.insert(arguments.end(), floats.begin(), floats.end());
  return {fmt::format("{}({})", function.name, joined(arguments))};
}

FunctionLibrary::Function& FunctionLibrary::function_of(const OpcodeInfo& row, const Immediates& immediates) {
  std::vector<double> key = {static_cast<double>(row.opcode)};
  std::string name = language_.prefix + std::string(row.mnemonic);
  if (row.form == Form::Outline) key.insert(key.end(), immediates.doubles.begin(), immediates.doubles.end());
  for (int i = 0; i < row.immediates; ++i) {
    if (!vm::is_integer_immediate(row, i)) continue;
    key.push_back(immediates.words[static_cast<std::size_t>(i)]);
    name += fmt::format("_{}", immediates.words[static_cast<std::size_t>(i)]);
  }
  const auto [found, fresh] = functions_.try_emplace(std::move(key));
  if (!fresh) return found->second;
  if (row.form == Form::Outline) {
    name += fmt::format("_{}", ++outlines_[row.opcode]);
    found->second.recorded = vm::record_outline(row.opcode, immediates.doubles);
  } else {
    found->second.recorded = vm::reroll(vm::record(row.opcode, immediates.words));
  }
  found->second.name = language_.free_name(name);
  return found->second;
}

void FunctionLibrary::print(Function& function, const OpcodeInfo& row) {
  function.printed = true;
  print_called(function.recorded);
  std::vector<Expression> operands;
  std::vector<std::string> parameters;
  if (takes_point(row)) {
    operands = {{"p"}};
    parameters = {"vec3 p"};
  } else {
    operands = {{"a"}, {"b"}, {"c"}};
    operands.resize(numbers_of(row));
    for (const Expression& operand : operands)
      parameters.push_back(fmt::format("{} {}", language_.number_type, operand.text));
  }
  const std::vector<std::string> names = parameter_names(language_, row);
  for (const std::string& name : names) parameters.push_back(fmt::format("{} {}", language_.immediate_type, name));
  text_ += fmt::format("{}{} {}({}) {{\n", language_.function_head,
                       row.form == Form::Point ? "vec3" : language_.number_type, function.name, joined(parameters));
  text_ += print_body(language_, function.recorded, parameter_texts(language_, row, operands, names), "  ");
  text_ += "}\n";
}

void FunctionLibrary::print_called(const vm::RecordedFunction& function) {
  for (const vm::Operation operation : called_functions(language_, function)) print_operation(operation);
}

// Prints the function of an operation. Its name lies between the @ and the parenthesis of the spelling.
void FunctionLibrary::print_operation(vm::Operation operation) {
  if (bool& printed = operations_[operation]; std::exchange(printed, true)) return;
  const vm::OperationInfo& row = vm::info(operation);
  const std::string_view spelling = row.*language_.spelling;
  const Expression all[] = {{"a"}, {"b"}, {"c"}};
  const std::span<const Expression> operands(all, row.operands);
  std::vector<std::string> parameters;
  for (const Expression& operand : operands)
    parameters.push_back(fmt::format("{} {}", language_.number_type, operand.text));

  const vm::RecordedFunction narrow = vm::record(operation, false), doubles = vm::record(operation, true);
  print_called(narrow);
  text_ += fmt::format("{}{} {}{}({}) {{\n", language_.function_head, language_.number_type, language_.prefix,
                       spelling.substr(1, spelling.find('(') - 1), joined(parameters));
  const std::string body = print_body(language_, narrow, operands, "  ");
  if (!language_.has_double || body == print_body(language_, doubles, operands, "  ")) {
    text_ += body;
  } else {
    text_ += "  if constexpr (kDouble) {\n" + print_body(language_, doubles, operands, "    ") + "  } else {\n" +
             print_body(language_, narrow, operands, "    ") + "  }\n";
  }
  text_ += "}\n";
}

}  // namespace fathom::compiler
