// Meshes a scene: from the field to a closed manifold triangle mesh within a proved distance of the surface.
//
//     MeshResult result = make_mesh(scene, box, options);
//     if (result.end == MeshResult::End::Done) write_mesh(...)
//
// Steps: cells by a certified octree (find_cells.h), signs (signed_lattice.h), crossings (crossings.h), vertices and
// polygons (contour.h), parts that are too thin (lost_parts.h), simplification with proofs (simplify.h), and a last
// proof for the whole mesh.
// Tested by: tests/runtime/mesh/make_mesh_test.cpp
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/mesh/lost/lost_parts.h"
#include "runtime/mesh/mesh.h"

namespace fathom::runtime {

struct MeshOptions {
  double tolerance = 0;  // max distance of the mesh from the surface, scene units
  // Max distance from the surface at which simplification may leave samples of a triangle, about a cell apart, scene
  // units; at most `tolerance`.
  double deviation = 0;
  bool is_clipped = false;  // the solid is cut off at the box
  bool simplifies = true;
  double memory = 0;  // bytes
  int threads = 1;
  // Called with the name of each step.
  std::function<void(std::string_view step)> progress;
};

struct MeshResult {
  enum class End { Done, TooFine, TooMany, Empty };
  End end = End::Done;
  TriangleMesh mesh;
  // Distance within which every point of the mesh is of the surface, scene units, also after rounding to float; at
  // most the tolerance. Proved, if the float error of the field is (CompiledField::certified). The surface may be
  // further from the mesh where a part is thinner than the cells.
  double bound = 0;
  double cell = 0;                    // edge of the cells, scene units
  std::size_t cells = 0;              // number of cells that may hold the surface
  double memory = 0;                  // bytes that the mesh needs, an estimate, if there are too many cells
  std::size_t contour_triangles = 0;  // before simplification
  std::vector<LostPart> lost;
  std::size_t islands = 0;  // number of bodies of the mesh that are parts of another
};

// Meshes the scene's solid within the finite `box`, programs' coordinates. Unless it is clipped, the box must contain
// the solid.
MeshResult make_mesh(const compiler::CompiledScene& scene, const compiler::Box& box, const MeshOptions& options);

// Returns the tolerance for which a box has `resolution` cells along its longest side.
double tolerance_of(const compiler::Box& box, double resolution);
// Returns a deviation that a mesh of this tolerance keeps nearly everywhere without simplification.
double fine_deviation(double tolerance);

}  // namespace fathom::runtime
