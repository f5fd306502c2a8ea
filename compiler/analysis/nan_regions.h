// Where a field is not a number: places that rays come to and see nothing at, not even what stands behind them.
// Boxes are looked for by what the machine can compute in them (vm/range/enclose.h), and reported once a point is found.
// Tested by: tests/runtime/cli/picture/cli_invalid_test.cpp, tests/golden/diagnostics (W0513)
#pragma once

#include <optional>
#include <string>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// A point where a program has no finite value, and what of the scene that is due to.
struct NanPlace {
  glm::dvec3 point;                    // in the program's coordinates
  std::string operation;               // as `fathom dump` names it; empty when nothing is known
  std::uint32_t line = 0, column = 0;  // 1-based; 0 when nothing is known
};

// What the program's value at the point is due to; nothing where it is a finite number.
std::optional<NanPlace> explain_nan(const vm::VerifiedProgram& program, glm::dvec3 point);

// The first that is found within the box, which is finite; nothing when a few thousand boxes show none.
std::optional<NanPlace> find_nan(const vm::VerifiedProgram& program, const Box& box);

inline constexpr const char* kNanRemedy =
    "keep arguments where there is a value: sqrt(max(x, 0)), log(max(x, 1e-9)), x/max(y, 1e-9), acos(clamp(x, -1, "
    "1))";

// Warns of one (W0514). `scene` is the graph in the coordinates of `field`, whose zero is at `origin`.
void warn_of_nan(const Scene& scene, const CompiledField& field, const SceneTables& tables, glm::dvec3 origin,
                 const Source& source, Diagnostics& diagnostics);

}  // namespace fathom::compiler
