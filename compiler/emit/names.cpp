// Checks the names that a user gives to emitted code.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

#include "compiler/emit/emit.h"

namespace fathom::compiler {
namespace {

bool is_identifier(std::string_view name) {
  const auto fits = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::all_of(name.begin(), name.end(), fits);
}

// Keywords and other spellings of operators. Source: ISO/IEC 14882:2020, [lex.key].
constexpr std::string_view kKeywords[] = {
    "alignas",     "alignof",  "and",        "and_eq",    "asm",       "auto",         "bitand",
    "bitor",       "bool",     "break",      "case",      "catch",     "char",         "char8_t",
    "char16_t",    "char32_t", "class",      "co_await",  "co_return", "co_yield",     "compl",
    "concept",     "const",    "const_cast", "consteval", "constexpr", "constinit",    "continue",
    "decltype",    "default",  "delete",     "do",        "double",    "dynamic_cast", "else",
    "enum",        "explicit", "export",     "extern",    "false",     "float",        "for",
    "friend",      "goto",     "if",         "inline",    "int",       "long",         "mutable",
    "namespace",   "new",      "noexcept",   "not",       "not_eq",    "nullptr",      "operator",
    "or",          "or_eq",    "private",    "protected", "public",    "register",     "reinterpret_cast",
    "requires",    "return",   "short",      "signed",    "sizeof",    "static",       "static_assert",
    "static_cast", "struct",   "switch",     "template",  "this",      "thread_local", "throw",
    "true",        "try",      "typedef",    "typeid",    "typename",  "union",        "unsigned",
    "using",       "virtual",  "void",       "volatile",  "wchar_t",   "while",        "xor",
    "xor_eq"};

// Returns the problem with one name of a namespace; empty when there is none.
std::string problem_with_part(std::string_view name) {
  if (!is_identifier(name)) return "a namespace is made of letters, digits and _, with :: between";
  if (std::find(std::begin(kKeywords), std::end(kKeywords), name) != std::end(kKeywords))
    return fmt::format("`{}` is a word of C++ itself; `{}_` is none", name, name);
  const bool reserved = name.size() > 1 && name[0] == '_' && std::isupper(static_cast<unsigned char>(name[1])) != 0;
  if (reserved || name.find("__") != name.npos)
    return "C++ keeps names with __ in them, and those that begin with _ and a capital letter, for itself";
  return "";
}

}  // namespace

std::string problem_with_namespace(std::string_view name) {
  if (name == "std" || name.starts_with("std::")) return "`std` is the standard library's";
  for (std::string_view rest = name;;) {
    const std::size_t colons = rest.find("::");
    if (std::string problem = problem_with_part(rest.substr(0, colons)); !problem.empty()) return problem;
    if (colons == rest.npos) return "";
    rest.remove_prefix(colons + 2);
  }
}

std::string problem_with_glsl_name(std::string_view name) {
  if (!is_identifier(name)) return "a name is made of letters, digits and _";
  if (name.starts_with("gl_") || name.find("__") != name.npos || name.ends_with('_')) {
    return "GLSL keeps names with gl_ before or __ in them for itself";
  }
  return "";
}

}  // namespace fathom::compiler
