// The JSON Schema (draft 2020-12) of scene files, made from the tables in records.h, for editors and other tools.
//
// What it rejects the compiler rejects too. The reverse does not hold: whether names resolve, whether parameters fit
// together and what the camera sees is beyond a schema.
// Tested by: tests/compiler/frontend/records/schema_test.cpp
#pragma once

#include <string>

namespace fathom::compiler {

// The schema as indented text, properties in the order of the tables.
std::string scene_schema();

}  // namespace fathom::compiler
