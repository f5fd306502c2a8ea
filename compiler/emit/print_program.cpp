#include "compiler/emit/print_program.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace fathom::compiler {
namespace {

using vm::Form;
using vm::Opcode;
using vm::OpcodeInfo;

// Returns text for the rest of a line. Replaces characters that could end a comment, or extend it as \ and the
// trigraph ??/ do.
std::string comment_text(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c < ' ' || c > '~' || c == '\\' || c == '?') c = '.';
  }
  return result;
}

// Runs the program on names: both stacks and the locals hold the texts of the values that the machine's would hold.
class ProgramPrinter {
 public:
  ProgramPrinter(const Language& language, const vm::Program& program, FunctionLibrary& functions)
      : language_(language), program_(program), functions_(functions), locals_(program.locals) {}

  std::string print(const glm::dvec3& origin) {
    points_.push_back({"p"});
    if (origin != glm::dvec3(0)) {
      const double by[] = {origin.x, origin.y, origin.z};
      points_ = {line("vec3", "q", functions_.apply(Opcode::Translate, points_, {{}, by}), "the scene's origin")};
    }
    for (std::size_t i = 0; at_ < program_.words.size(); ++i) {
      const bool known = i < program_.debug.size();
      comment_ = known && program_.debug[i].symbol.ends_with('"') ? program_.debug[i].symbol : "";
      instruction();
    }
    out_ += fmt::format("  return {};\n", values_.back().text);
    return std::move(out_);
  }

 private:
  void instruction() {
    const std::uint32_t word = program_.words[at_];
    const OpcodeInfo& row = vm::info(static_cast<Opcode>(word & 0xff));
    leading_ = at_ + 1;
    const std::size_t end = at_ + vm::instruction_length(word);
    at_ = end;
    const std::size_t first = leading_ + static_cast<std::size_t>(vm::leading_immediates(word));
    const Immediates immediates{std::span(program_.words).subspan(first, end - first),
                                std::span(program_.doubles).subspan(first, end - first)};
    switch (row.form) {
      case Form::Point:
        points_.push_back(name_point(functions_.apply(row.opcode, {points_.back()}, immediates)));
        break;
      case Form::Shape:
        shape(row, word, immediates);
        break;
      case Form::Outline:
        push(functions_.apply(row.opcode, {points_.back()}, immediates));
        break;
      case Form::Unary:
      case Form::Binary:
        function(row, word, immediates);
        break;
      case Form::Ternary:
        ternary(row, immediates);
        break;
      case Form::Machine:
        machine(row, word);
        break;
    }
  }

  void shape(const OpcodeInfo& row, std::uint32_t word, const Immediates& immediates) {
    const std::uint32_t modes = vm::operand_of(word);
    Expression p = points_.back();
    if (modes & vm::kFusedTranslate) {
      p = functions_.apply(Opcode::Translate, {p}, {{}, std::span(program_.doubles).subspan(leading_, 3)});
    }
    Expression value = functions_.apply(row.opcode, {p}, immediates);
    if (modes & vm::kFusedMin) value = functions_.apply(Opcode::Min, {pop(), value}, {});
    push(std::move(value));
  }

  void function(const OpcodeInfo& row, std::uint32_t word, const Immediates& immediates) {
    const vm::Sources sources = vm::sources_of(word);
    // An operand b on the stack is the top value. A constant operand a is the first constant.
    std::vector<Expression> operands;
    const bool stack = row.form == Form::Binary && sources.b == vm::Source::Stack;
    const Expression top = stack ? pop() : Expression{};
    operands.push_back(operand(sources.a, sources.local));
    if (row.form == Form::Binary) operands.push_back(stack ? top : operand(sources.b, sources.local));
    push(functions_.apply(row.opcode, operands, immediates));
  }

  void ternary(const OpcodeInfo& row, const Immediates& immediates) {
    Expression c = pop(), b = pop(), a = pop();
    push(functions_.apply(row.opcode, {std::move(a), std::move(b), std::move(c)}, immediates));
  }

  Expression operand(vm::Source source, std::uint32_t local) {
    switch (source) {
      case vm::Source::Stack:
        return pop();
      case vm::Source::Constant:
        return language_.number(language_.literal(program_.doubles[leading_++]));
      case vm::Source::Local:
        return locals_[local];
      default:
        return {points_.back().text + '.' + " xyz"[static_cast<std::size_t>(source)]};
    }
  }

  // Instructions that tell surfaces apart do not affect the distance.
  void machine(const OpcodeInfo& row, std::uint32_t word) {
    if (row.opcode == Opcode::Drop) points_.pop_back();
    if (row.opcode == Opcode::Tee) locals_[vm::operand_of(word)] = values_.back();
    if (row.opcode == Opcode::Load) values_.push_back(locals_[vm::operand_of(word)]);
  }

  Expression pop() {
    Expression top = std::move(values_.back());
    values_.pop_back();
    return top;
  }
  // A coordinate or a constant needs no name.
  void push(Expression value) {
    const bool plain = value.text.find_first_of(" (,") == value.text.npos || value.text.starts_with("number(");
    values_.push_back(plain ? std::move(value) : name_value(value));
  }
  Expression name_value(const Expression& value) {
    return line(language_.number_type, fmt::format("d{}", ++value_names_), value, comment_);
  }
  Expression name_point(const Expression& value) {
    return line("vec3", fmt::format("p{}", ++point_names_), value, comment_);
  }
  Expression line(std::string_view type, std::string name, const Expression& value, const std::string& comment) {
    out_ += fmt::format("  {}{} {} = {};", language_.constant, type, name, value.text);
    if (!comment.empty()) out_ += "  // " + comment_text(comment);
    out_ += '\n';
    return {std::move(name)};
  }

  const Language& language_;
  const vm::Program& program_;
  FunctionLibrary& functions_;
  std::vector<Expression> points_, values_, locals_;
  std::size_t at_ = 0, leading_ = 0;
  std::string out_;
  std::string comment_;  // the instruction's symbol, if the scene gives it a name
  int value_names_ = 0, point_names_ = 0;
};

}  // namespace

std::string print_program(const Language& language, const vm::VerifiedProgram& program, const glm::dvec3& origin,
                          FunctionLibrary& functions) {
  return ProgramPrinter(language, program.program(), functions).print(origin);
}

std::string describe(const CompiledScene& scene) {
  return comment_text(fmt::format("{}: {}", scene.source.name(), scene.summary));
}

}  // namespace fathom::compiler
