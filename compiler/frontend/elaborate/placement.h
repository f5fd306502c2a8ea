// Conversion of scale, rotate and translate of a node or a pattern to the parameters of a Transform node
// (compiler/graph/graph.h).
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "compiler/frontend/records/record_reader.h"

namespace fathom::compiler {

// Returns the rotation by an angle in degrees about an axis of any nonzero length. Exact for multiples of 90 degrees
// about x, y or z.
glm::dmat3 rotation_about(glm::dvec3 axis, double degrees);

// Returns the rotation by degrees about the fixed x, then y, then z axis.
glm::dmat3 rotation_xyz(glm::dvec3 degrees);

// Returns the rows of the map from the parent's space to the node's, then the factor of the node's distances. The
// node is scaled by `scale` (each > 0), then rotated, then moved.
std::array<double, 13> transform_params(glm::dvec3 scale, const glm::dmat3& rotation, glm::dvec3 translation);

// Returns transform_params() for a node whose y axis points from `from` to `to`. The node's origin lies on that
// segment, `share` of its length before `to`. The two points must differ.
std::array<double, 13> placed_between(glm::dvec3 from, glm::dvec3 to, double share);

// Returns transform_params() for the properties scale, rotate and translate of a record, or nullopt if none is given.
std::optional<std::array<double, 13>> read_placement(const RecordReader& reader, const Scope& scope,
                                                     Diagnostics& diagnostics);

}  // namespace fathom::compiler
