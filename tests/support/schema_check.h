// A validator for the keywords of JSON Schema (draft 2020-12) that compiler/frontend/records/schema.cpp writes, and no
// others: a keyword it does not know throws, so that no rule is passed over in silence.
//
// Source: Wright, Andrews, Hutton, "JSON Schema Validation", 2022.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fathom::tests {

// What is wrong with `value`, with its place; empty when nothing is. `schema` is a part of `whole`, where $ref looks.
std::string schema_problem(const nlohmann::json& value, const nlohmann::json& schema, const nlohmann::json& whole);

inline std::string schema_problem(const nlohmann::json& value, const nlohmann::json& schema) {
  return schema_problem(value, schema, schema);
}

}  // namespace fathom::tests
