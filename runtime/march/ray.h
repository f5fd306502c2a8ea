// A ray and what became of it.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

namespace fathom::runtime {

struct Ray {
  glm::dvec3 origin;     // scene units
  glm::dvec3 direction;  // any finite length but zero; normalised unless it has unit length already
  double t_max = std::numeric_limits<double>::infinity();  // scene units, beside the field's `far`
  int side = 0;                                            // +1 starts outside, -1 inside a solid; 0: find out
  float slope = -1;  // dg/dt expected at the origin in [-1,1]: dot(normal, direction) when it leaves a surface
  float clear = 0;   // nothing lies nearer than this along it, scene units; above 0 only outside solids
};

struct Arrival {
  // Contact: a miss that came nearer to a surface than double resolves.
  enum class Status : std::uint8_t { Hit, Miss, Contact, Invalid };
  std::uint32_t id;
  Status status;
  std::int8_t side = 1;            // of the space the ray travelled through, +1 or -1
  std::uint32_t evaluations = 0;   // of the field, for this ray
  std::uint32_t certified = 0;     // those in double; 0: float decided
  float width = 0;                 // of the bracket round the hit, scene units
  double t = 0;                    // of the hit, scene units from the origin
  std::uint64_t instructions = 0;  // of the field's program, over the evaluations
};

}  // namespace fathom::runtime
