// A ray and the result of following it.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

namespace fathom::runtime {

inline constexpr std::uint32_t kNoPiece = std::numeric_limits<std::uint32_t>::max();

struct Ray {
  glm::dvec3 origin;     // scene units
  glm::dvec3 direction;  // any finite length except zero; the marcher normalises it unless it has unit length
  double t_max = std::numeric_limits<double>::infinity();  // scene units; Field::far is a limit, too
  int side = 0;                                            // +1: starts outside, -1: inside a solid, 0: not known
  // dg/dt expected at the origin, relative to the field's Lipschitz constant, in [-1,1]: dot(gradient, direction)
  // when the ray leaves a surface. A guess too high only makes the first step fail.
  float slope = -1;
  double clear = 0;  // no surface lies nearer than this along the ray, scene units
  std::uint32_t leaves =
      kNoPiece;  // piece of the scene whose surface the ray leaves outwards (runtime/field/pieces.h)
};

// The result of following a ray: where it hit, or the reason why it did not.
struct RayHit {
  // NearMiss: a miss that came nearer to a surface than double resolves.
  enum class Status : std::uint8_t { Hit, Miss, NearMiss, Invalid };
  std::uint32_t id;
  Status status;
  std::int8_t side = 1;            // +1: the ray travelled outside, -1: inside a solid
  std::uint32_t evaluations = 0;   // of the field, for this ray
  std::uint32_t certified = 0;     // number of evaluations in double; 0: float decided
  float width = 0;                 // width of the bracket around the hit, scene units
  double t = 0;                    // distance from the origin to the hit, scene units
  std::uint64_t instructions = 0;  // number of instructions of the field's program, over all evaluations
  std::uint32_t piece = kNoPiece;  // of the scene that was hit, if rays meet pieces
};

}  // namespace fathom::runtime
