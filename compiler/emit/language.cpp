#include "compiler/emit/language.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::compiler {
namespace {

// Names in the rows of opcodes that mean something else in these languages, or within an emitted file.
constexpr std::string_view kCppTaken[] = {"and", "or",     "not",    "xor",    "abs",   "any",      "ceil",
                                          "cos", "exp",    "floor",  "length", "log",   "mantissa", "max",
                                          "min", "number", "select", "sin",    "sqrt",  "exponent", "square",
                                          "tan", "asin",   "acos",   "atan",   "atan2", "pow",      "distance"};
constexpr std::string_view kGlslTaken[] = {"abs",  "ceil", "cos", "exp",  "floor", "length",  "log",
                                           "max",  "min",  "sin", "sqrt", "tan",   "step",    "inverse",
                                           "sign", "atan", "mix", "mod",  "exp2",  "distance"};

std::string cpp_literal(double value) {
  if (std::isinf(value)) return value > 0 ? "kInfinity" : "-kInfinity";
  return fmt::format("{}", value);
}
Expression cpp_number(std::string_view literal) { return {fmt::format("number({})", literal)}; }

// Returns the fewest digits that give the float, with a point, because an integer is not a float in GLSL.
std::string glsl_literal(double value) {
  const float rounded = static_cast<float>(value);
  if (std::isinf(rounded)) return rounded > 0 ? "uintBitsToFloat(0x7f800000u)" : "uintBitsToFloat(0xff800000u)";
  const std::string text = fmt::format("{}", rounded);
  return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}
Expression glsl_number(std::string_view literal) {
  return {std::string(literal), literal.starts_with('-') ? vm::Binding::Sign : vm::Binding::Call};
}

}  // namespace

const Language kCpp{
    .spelling = &vm::OperationInfo::cpp,
    .prefix = "",
    .function_head = "static FATHOM_SCENE_INLINE ",
    .constant = "const ",
    .number_type = "T",
    .mask_type = "auto",
    .immediate_type = "double",
    .has_double = true,
    .point = "vec3{{{0}, {1}, {2}}}",
    .literal = cpp_literal,
    .immediate = cpp_literal,
    .number = cpp_number,
    .has_comments = true,
    .taken = kCppTaken,
};
// GLSL allows `const` only for values that the compiler can compute.
const Language kGlsl{
    .spelling = &vm::OperationInfo::glsl,
    .prefix = "scene_",
    .function_head = "",
    .constant = "",
    .number_type = "float",
    .mask_type = "bool",
    .immediate_type = "float",
    .has_double = false,
    .point = "vec3({0}, {1}, {2})",
    .literal = glsl_literal,
    .immediate = glsl_literal,
    .number = glsl_number,
    .has_comments = true,
    .taken = kGlslTaken,
};

std::string Language::free_name(std::string_view name) const {
  std::string result(name);
  if (std::find(taken.begin(), taken.end(), name) != taken.end()) result += '_';
  return result;
}

}  // namespace fathom::compiler
