// Entrances of rays into solids that have a formula for them: balls, boxes, cylinders and half-spaces. For many rays
// at once.
// Not a public header: march.h is. Tested by: tests/runtime/march/closed_form_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

// Uncertain: the ray begins in or next to the solid, or barely touches it, so that rounding may decide.
enum class Meeting : std::uint8_t { Misses, Enters, Uncertain };

// Rays, each with a solid, as a structure of arrays.
struct Entrances {
  static constexpr std::size_t kCapacity = 384, kPadded = kCapacity + 8;  // a register may begin at the last ray

  std::size_t count = 0;
  double origin[3][kPadded] = {}, direction[3][kPadded] = {};  // [axis][ray]; directions have unit length
  std::int64_t form[kPadded] = {};                             // of the solid: offset from the first form, in doubles
  // Results: a Meeting; if the ray enters, t of the surface, and a bound on the error of t.
  double meeting[kPadded], t[kPadded], slack[kPadded];

  // `number`: of the solid's form.
  void push(glm::dvec3 from, glm::dvec3 along, std::int32_t number) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis][count] = from[axis];
      direction[axis][count] = along[axis];
    }
    form[count++] = number * static_cast<std::int64_t>(sizeof(compiler::ClosedForm) / sizeof(double));
  }
  Meeting meeting_of(std::size_t i) const { return static_cast<Meeting>(meeting[i]); }
};

// Sets the results of all rays. All solids have one shape, not None; `alike`: they are one solid.
void find_entrances(const compiler::ClosedForm* forms, bool alike, Entrances& rays);

}  // namespace fathom::runtime
