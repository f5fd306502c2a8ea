// Shorthand functions for the rows of the tables in records.h.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "compiler/frontend/records/record_spec.h"

namespace fathom::compiler::rows {

inline constexpr Range kUnit{0, 1};

inline PropertySpec number(std::string_view name, std::string_view doc, std::vector<double> fallback,
                           Range range = {}, Rule rule = Rule::Any) {
  return {name, ValueType::Number, doc, std::move(fallback), false, rule, range, {}};
}
inline PropertySpec integer(std::string_view name, std::string_view doc, double fallback, Range range) {
  return {name, ValueType::Integer, doc, {fallback}, false, Rule::Any, range, {}};
}
inline PropertySpec seed(std::string_view name, std::string_view doc) { return {name, ValueType::Seed, doc, {0}}; }
inline PropertySpec vec3(std::string_view name, std::string_view doc, std::vector<double> fallback,
                         Rule rule = Rule::Any) {
  return {name, ValueType::Vec3, doc, std::move(fallback), false, rule, {}, {}};
}
inline PropertySpec color(std::string_view name, std::string_view doc, double fallback, Range range = kUnit,
                          Rule rule = Rule::Any) {
  return {name, ValueType::Color, doc, {fallback, fallback, fallback}, false, rule, range, {}};
}
inline PropertySpec other(std::string_view name, ValueType type, std::string_view doc, bool required = false) {
  return {name, type, doc, {}, required, Rule::Any, {}, {}};
}
inline PropertySpec choice(std::vector<std::string_view> choices, std::string_view doc, bool required) {
  return {"type", ValueType::Choice, doc, {}, required, Rule::Any, {}, std::move(choices)};
}
template <std::size_t N>
PropertySpec choice(std::string_view name, std::string_view doc, const std::array<std::string_view, N>& names) {
  return {name, ValueType::Choice, doc, {}, false, Rule::Any, {}, {names.begin(), names.end()}};
}
inline PropertySpec instead_of(std::vector<std::string_view> others, PropertySpec property) {
  property.instead_of = std::move(others);
  return property;
}

}  // namespace fathom::compiler::rows
