// fathom schema: the JSON Schema of scene files, for editors that complete and check while one types.
// Tested by: tests/runtime/cli_dump_test.cpp
#include "compiler/frontend/schema.h"

#include <ostream>

#include "runtime/cli/arguments.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kSchemaExamples =
    "fathom schema > scene.schema.json\n"
    "\n"
    "A scene names it in its first property: \"$schema\": \"./scene.schema.json\"";

}  // namespace

int run_schema(std::span<const std::string> args, const Streams& streams) {
  Arguments arguments("schema", "Prints the JSON Schema (draft 2020-12) of scene files.", kSchemaExamples);
  if (const auto code = arguments.parse(args, streams)) return *code;
  streams.out << compiler::scene_schema();
  return kDone;
}

}  // namespace fathom::cli
