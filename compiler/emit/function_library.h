// The functions an emitted file needs, each printed once and after the functions it calls.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "compiler/emit/language.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {

// An instruction's immediates, without those that belong to its operand.
struct Immediates {
  std::span<const std::uint32_t> words;
  std::span<const double> doubles;
  std::span<const std::string> texts = {};  // that stand for numbers, where they are not empty
};

class FunctionLibrary {
 public:
  explicit FunctionLibrary(const Language& language) : language_(language) {}

  // Returns the instruction's result as an expression: a call, or the bare operation if the formula has only one.
  // `operands`: a point, or one to three numbers.
  Expression apply(vm::Opcode opcode, const std::vector<Expression>& operands, const Immediates& immediates);

  // Returns all functions printed so far.
  const std::string& text() const { return text_; }

 private:
  struct Function {
    std::string name;
    vm::RecordedFunction recorded;
    bool printed = false;
  };

  Function& function_of(const vm::OpcodeInfo& row, const Immediates& immediates);
  void print(Function& function, const vm::OpcodeInfo& row);
  void print_called(const vm::RecordedFunction& function);
  void print_operation(vm::Operation operation);

  const Language& language_;
  std::map<std::vector<double>, Function> functions_;  // by opcode and the immediates that shape the function
  std::map<vm::Opcode, int> outlines_;                 // number of functions per outline
  std::map<vm::Operation, bool> operations_;           // true once printed
  std::string text_;
};

}  // namespace fathom::compiler
