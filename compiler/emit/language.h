// What the languages that `fathom emit` writes differ in, beside how operations are spelled (vm/record/operations.def).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "vm/record/recorded_function.h"

namespace fathom::compiler {

// A piece of text that stands for a value.
struct Expression {
  std::string text;
  vm::Binding binding = vm::Binding::Call;
};

struct Language {
  std::string_view vm::OperationInfo::*spelling;
  std::string prefix;              // of the names of functions
  std::string_view function_head;  // before a function's type
  std::string_view constant;       // before the type of a value that does not change
  std::string_view number_type, mask_type;
  std::string_view immediate_type;          // of a function's parameters that are numbers of the scene
  bool has_double;                          // beside float
  std::string_view point;                   // pattern that makes a point of {0}, {1}, {2}
  std::string (*literal)(double value);     // as an argument for such a parameter
  Expression (*number)(std::string_view);   // a literal or such a parameter as a number
  std::span<const std::string_view> taken;  // names that parameters and functions cannot have

  // `name`, or one like it that is not taken.
  std::string free_name(std::string_view name) const;
};

extern const Language kCpp, kGlsl;

}  // namespace fathom::compiler
