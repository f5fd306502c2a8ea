// A program as JSON for other tools: the content of the listing of vm/encoding/disassemble.h, one instruction per
// line.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <string>
#include <string_view>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// Returns {"scene": name, "program": which, "summary": ..., sizes, "code": [...]}. The summary is followed by
// "origin": [x,y,z] if the origin is not zero (compiler/analysis/origin.h). Each instruction is one line:
//
//     {"offset": 0, "op": "sphere", "immediates": {"radius": 0.5}, "values": [0, 1], "points": [1, 1], "cost": 8,
//      "source": {"line": 6, "column": 5}, "symbol": "sphere \"ball\""}
//
// Immediates are the unrounded numbers, whereas the code holds the nearest floats. tee, load and tag also have an
// "operand".
std::string program_json(const vm::VerifiedProgram& program, std::string_view which,
                         const compiler::CompiledScene& scene);

}  // namespace fathom::cli
