// A program as JSON, for other tools: what the listing of vm/encoding/disassemble.h says, an instruction a line.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <string>
#include <string_view>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// {"scene": name, "program": which, "summary": ..., sizes, "code": [...]}, after the summary "origin": [x,y,z] where
// that is not zero (compiler/analysis/origin.h); an instruction a line:
//     {"offset": 0, "op": "sphere", "immediates": {"radius": 0.5}, "values": [0, 1], "points": [1, 1], "cost": 8,
//      "source": {"line": 6, "column": 5}, "symbol": "sphere \"ball\""}
// Immediates are the unrounded ones; the code holds the nearest floats. tee, load and tag have an "operand", too.
std::string program_json(const vm::VerifiedProgram& program, std::string_view which,
                         const compiler::CompiledScene& scene);

}  // namespace fathom::cli
