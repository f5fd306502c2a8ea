// Vectors in the plane of outlines.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>

#include "compiler/shapes/node_table.h"

namespace fathom::compiler {

inline glm::dvec2 vec2_at(Params p, std::size_t i) { return {p[i], p[i + 1]}; }
inline double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace fathom::compiler
