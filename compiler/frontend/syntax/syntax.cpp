#include "compiler/frontend/syntax/syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fathom::compiler {

namespace syntax {

const Property* Record::find(std::string_view name) const {
  for (const Property& property : properties) {
    if (property.name == name) return &property;
  }
  return nullptr;
}

}  // namespace syntax

std::string describe(const syntax::Value& value) {
  struct Describer {
    std::string operator()(std::monostate) const { return "null"; }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(double number) const {
      return std::isnan(number) ? "not a number" : fmt::format("{}", number);
    }
    std::string operator()(const std::string&) const { return "a string"; }
    std::string operator()(const syntax::List& list) const {
      if (list.empty()) return "an empty list";
      const auto number = [](const syntax::Value& item) { return std::holds_alternative<double>(item.data); };
      const bool numbers = std::all_of(list.begin(), list.end(), number);
      if (list.size() == 1) return numbers ? "a list of one number" : "a list";
      return numbers ? fmt::format("a list of {} numbers", list.size()) : "a list";
    }
    std::string operator()(const syntax::Record&) const { return "an object"; }
    std::string operator()(const syntax::ReadFormula&) const { return "a formula"; }
  };
  return std::visit(Describer{}, value.data);
}

std::uint64_t integer_of(std::string_view text) {
  std::uint64_t integer = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), integer);
  return error == std::errc() && end == text.data() + text.size() ? integer : 0;
}

std::string number_text(const syntax::Value& number) {
  if (number.integer != 0) return fmt::format("{}", number.integer);
  const double value = std::get<double>(number.data);
  // A point tells a number that may be rounded from one that is written in digits. From 1e16 on an exponent does.
  return std::abs(value) >= 0x1p53 && std::abs(value) < 1e16 ? fmt::format("{:#}", value) : fmt::format("{}", value);
}

std::optional<glm::dvec3> three_numbers(const syntax::Value& value) {
  if (const double* number = std::get_if<double>(&value.data)) return glm::dvec3(*number);
  const auto* list = std::get_if<syntax::List>(&value.data);
  if (list == nullptr || list->size() != 3) return std::nullopt;
  glm::dvec3 out;
  for (int i = 0; i < 3; ++i) {
    const double* number = std::get_if<double>(&(*list)[static_cast<std::size_t>(i)].data);
    if (number == nullptr) return std::nullopt;
    out[i] = *number;
  }
  return out;
}

}  // namespace fathom::compiler
