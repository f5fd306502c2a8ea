// JSON Schema (draft 2020-12) of scene files, made from the tables in records.h, for editors and other tools.
//
// The compiler rejects every file that the schema rejects. The compiler rejects more: a schema cannot tell if names
// resolve, if parameters fit together, or if the camera has a direction of view.
// Tested by: tests/compiler/frontend/records/schema_test.cpp
#pragma once

#include <string>

namespace fathom::compiler {

// Returns the schema as indented text, with properties in the order of the tables.
std::string scene_schema();

}  // namespace fathom::compiler
