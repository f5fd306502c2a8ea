// Validator for those keywords of JSON Schema (draft 2020-12) that compiler/frontend/records/schema.cpp writes. An
// unknown keyword throws, so that no rule is silently ignored.
//
// Source: Wright, Andrews, Hutton, "JSON Schema Validation", 2022.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fathom::test {

// Returns the first violation in `value` with its location, or an empty string. `schema` is a part of `whole`, in
// which $ref is resolved.
std::string schema_problem(const nlohmann::json& value, const nlohmann::json& schema, const nlohmann::json& whole);

inline std::string schema_problem(const nlohmann::json& value, const nlohmann::json& schema) {
  return schema_problem(value, schema, schema);
}

}  // namespace fathom::test
