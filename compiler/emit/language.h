// Differences between the languages that `fathom emit` writes, in addition to the spelling of operations
// (vm/record/operations.def).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "vm/record/recorded_function.h"

namespace fathom::compiler {

// The text of a value, and how tightly it binds.
struct Expression {
  std::string text;
  vm::Binding binding = vm::Binding::Call;
};

struct Language {
  std::string_view vm::OperationInfo::*spelling;
  std::string prefix;              // of function names
  std::string_view function_head;  // before a function's return type
  std::string_view constant;       // before the type of a named value
  std::string_view number_type, mask_type;
  std::string_view immediate_type;          // of function parameters that are numbers of the scene
  bool has_double;                          // in addition to float
  std::string_view point;                   // pattern that makes a point of {0}, {1}, {2}
  std::string (*literal)(double value);     // prints a number of a formula
  // Prints a number of the scene, an argument for such a parameter.
  std::function<std::string(double value)> immediate;
  Expression (*number)(std::string_view);   // turns a literal or such a parameter into a number
  bool has_comments;                        // with the names of the scene's nodes
  std::span<const std::string_view> taken;  // names that parameters and functions cannot have

  // Returns `name`, or a similar name that is not taken.
  std::string free_name(std::string_view name) const;
};

extern const Language kCpp, kGlsl;

}  // namespace fathom::compiler
