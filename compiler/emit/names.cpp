// What names the emitted code can have.
#include <algorithm>
#include <cctype>

#include "compiler/emit.h"

namespace fathom::compiler {
namespace {

bool is_identifier(std::string_view name) {
  const auto fits = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::all_of(name.begin(), name.end(), fits);
}

}  // namespace

std::string problem_with_namespace(std::string_view name) {
  for (std::string_view rest = name;;) {
    const std::size_t colons = rest.find("::");
    if (!is_identifier(rest.substr(0, colons)))
      return "a namespace is made of letters, digits and _, with :: between";
    if (rest.substr(0, colons).find("__") != rest.npos) return "C++ keeps names with __ in them for itself";
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
