// Entrances of rays into pieces that have a formula for them: intersections of balls, boxes, cylinders and others,
// with such solids cut from them, by the parts of the rays in each (Roth, "Ray Casting for Modeling Solids", 1982).
// For many rays at once, each with a piece of its own, or all with the same pieces. Not a public header: march.h is.
// Tested by: tests/runtime/march/closed_form_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "compiler/geometry/box.h"
#include "compiler/scene/compiled_scene.h"
#include "runtime/march/clip.h"

namespace fathom::runtime {

// Uncertain: the ray begins in or next to the piece, or barely touches it, so that rounding may decide.
enum class Meeting : std::uint8_t { Misses, Enters, Uncertain };

// Rays, each with a solid, as a structure of arrays.
struct Entrances {
  static constexpr std::size_t kCapacity = 384, kPadded = kCapacity + 8;  // a register may begin at the last ray

  std::size_t count = 0;
  double origin[3][kPadded] = {}, direction[3][kPadded] = {};  // [axis][ray]; directions have unit length
  std::int64_t form[kPadded] = {};  // the piece's first: offset from the first of all forms, in doubles
  // Results: a Meeting; if the ray enters, t of the surface, and a bound on the error of t.
  double meeting[kPadded], t[kPadded], slack[kPadded];

  // `number`: of the piece's first form.
  void push(glm::dvec3 from, glm::dvec3 along, std::uint32_t number) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis][count] = from[axis];
      direction[axis][count] = along[axis];
    }
    form[count++] = static_cast<std::int64_t>(number * (sizeof(compiler::ClosedForm) / sizeof(double)));
  }
  glm::dvec3 origin_of(std::size_t i) const { return {origin[0][i], origin[1][i], origin[2][i]}; }
  glm::dvec3 direction_of(std::size_t i) const { return {direction[0][i], direction[1][i], direction[2][i]}; }
  Meeting meeting_of(std::size_t i) const { return static_cast<Meeting>(meeting[i]); }
};

// Sets the results of all rays. All pieces have `count` forms, of the same shapes; `alike`: they are one piece.
void find_entrances(std::span<const compiler::ClosedForm> forms, std::size_t count, bool alike, Entrances& rays);

// A piece that rays are scanned for. Without forms, its box is what is known of it.
struct ScannedPiece {
  std::span<const compiler::ClosedForm> forms;
  compiler::Box box;
  bool moved;   // the forms are not turned, only moved
  bool convex;  // a ray that leaves it does not meet it again
  std::uint32_t number;
};

// Maximum number of pieces that are scanned for.
inline constexpr std::size_t kMostScanned = 32;

// The pieces that rays may meet first, [ray] as in their block.
struct FirstMet {
  // The piece with the first entrance of which a formula is certain, or none if that is beyond the ray's length.
  static constexpr double kNone = -1;
  double piece[RayBlock::kPadded];
  double t[RayBlock::kPadded], slack[RayBlock::kPadded];
  // Bits of the other pieces that the ray may enter before t + 2 slack and within its length.
  std::uint64_t others[RayBlock::kPadded];
};

// Finds what the rays from `first` on may meet first. They begin outside all pieces. At most kMostScanned pieces, in
// any order; fastest if those that most rays meet come first.
void find_first(std::span<const ScannedPiece> pieces, const RayBlock& rays, std::size_t first, FirstMet& met);

}  // namespace fathom::runtime
