// The scale, rotate and translate of a node or a pattern as the parameters of a Transform node (compiler/graph/graph.h).
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "compiler/frontend/records/record_reader.h"

namespace fathom::compiler {

// The rotation by degrees about an axis of any length but zero; exact for multiples of 90 degrees about x, y or z.
glm::dmat3 rotation_about(glm::dvec3 axis, double degrees);

// The rotation by degrees about the fixed x, then y, then z axis.
glm::dmat3 rotation_xyz(glm::dvec3 degrees);

// Rows of the map from the parent's space to the node's, then the factor of its distances. The node is scaled by
// `scale` (each > 0), then rotated, then moved.
std::array<double, 13> transform_params(glm::dvec3 scale, const glm::dmat3& rotation, glm::dvec3 translation);

// The same for a node whose y axis is to point from `from` to `to`, with its origin `share` of the way short of `to`.
// The points differ.
std::array<double, 13> placed_between(glm::dvec3 from, glm::dvec3 to, double share);

// transform_params() of the properties scale, rotate and translate of a record; nullopt when none is given.
std::optional<std::array<double, 13>> read_placement(const RecordReader& reader, const Scope& scope,
                                                     Diagnostics& diagnostics);

}  // namespace fathom::compiler
