// Finds points where a field is NaN or infinite. Rays that come there see nothing, not even objects behind. The
// search tests boxes by enclosures of the machine's results (vm/range/enclose.h), and reports only evaluated points.
// Tested by: tests/runtime/cli/picture/cli_invalid_test.cpp, tests/golden/diagnostics (W0513)
#pragma once

#include <optional>
#include <string>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// A point where a program has no finite value, and the operation that causes this.
struct NanPlace {
  glm::dvec3 point;                    // in the program's coordinates
  std::string operation;               // as `fathom dump` names it; empty when unknown
  std::uint32_t line = 0, column = 0;  // 1-based; 0 when unknown
};

// Returns the cause of a value that is not finite; nothing when the value at the point is finite.
std::optional<NanPlace> explain_nan(const vm::VerifiedProgram& program, glm::dvec3 point);

// Returns the first point found within the finite box; nothing when a few thousand boxes show none.
std::optional<NanPlace> find_nan(const vm::VerifiedProgram& program, const Box& box);

inline constexpr const char* kNanRemedy =
    "keep arguments where there is a value: sqrt(max(x, 0)), log(max(x, 1e-9)), x/max(y, 1e-9), acos(clamp(x, -1, "
    "1))";

// Warns of one such point (W0514). `scene` is the graph in the coordinates of `field`, whose zero is at `origin`.
void warn_of_nan(const Scene& scene, const CompiledField& field, const SceneTables& tables, glm::dvec3 origin,
                 const Source& source, Diagnostics& diagnostics);

}  // namespace fathom::compiler
