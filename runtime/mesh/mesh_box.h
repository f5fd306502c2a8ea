// The box of a mesh and the size of its cells, as the program and the library choose them.
// Tested by: tests/runtime/cli/cli_mesh_test.cpp, tests/bindings/library_mesh_test.cpp
#pragma once

#include <optional>
#include <variant>

#include "compiler/scene/compiled_scene.h"
#include "runtime/mesh/make_mesh.h"

namespace fathom::runtime {

// Cells along the longest side of the box.
inline constexpr int kDefaultResolution = 256, kMinResolution = 4, kMaxResolution = 1 << 18;

struct MeshBox {
  compiler::Box box;  // finite and not flat, programs' coordinates
  bool is_clipped;    // the solid may go on outside
};
// Reason why a scene has no box: there is no solid in it, or the solid has no end.
enum class NoMeshBox { Empty, Endless };

// Returns the part of the scene's bound within `wanted`, programs' coordinates, or the whole bound.
std::variant<MeshBox, NoMeshBox> mesh_box(const compiler::CompiledScene& scene,
                                          const std::optional<compiler::Box>& wanted);

// Returns the options of a mesh within `tolerance`, or else with `resolution` cells.
MeshOptions mesh_options(const MeshBox& box, std::optional<double> tolerance, int resolution);

}  // namespace fathom::runtime
