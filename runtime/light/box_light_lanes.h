// Area lights that are boxes, sampled for many shading points at once, in lanes of doubles: the faces that a point
// sees, each nearly uniformly in solid angle and without trigonometry.
//
// A face is chosen in proportion to about its solid angle, up to the half sphere's. Only the density on the chosen
// face has to be exact. On the face, with z its distance, the solid angle per area is z (x^2 + y^2 + z^2)^(-3/2).
// y given x is sampled exactly, by a closed form. x is sampled with a density proportional to
// (x^2 + z^2 + m^2)^(-3/2), where m is the minimum of |y|, which has the same form. That density is exact for a
// rectangle that looks narrow from the point, and nearly exact otherwise. The weights 1 / pdf have a relative
// variance below .02 if the rectangle is no nearer than half its shorter side, and below 1 at a hundredth of that
// side. Sampling uniformly over the area had .4 and 300. Exact uniformity (Urena, Fajardo, King, "An Area-Preserving
// Parametrization for Spherical Rectangles", 2013) costs an arc tangent and sines, and loses digits at small angles.
// Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace fathom::runtime {

struct BoxLight {
  glm::dmat3 rotation;  // from the box's space, after which it is translated
  glm::dvec3 translation;
  glm::dvec3 lo, hi;      // corners, in the box's space
  glm::dvec3 sampled{1};  // [axis]; 0: the two faces across this axis are not
};

// [point]. Numbers are in the programs' coordinates.
struct BoxLightRows {
  static constexpr std::size_t kCapacity = 64;

  void set(std::size_t i, std::size_t index, glm::dvec3 place) {
    light[i] = static_cast<std::int64_t>(index);
    for (int k = 0; k < 3; ++k) from[k][i] = place[k];
  }
  glm::dvec3 way_of(std::size_t i) const { return {way[0][i], way[1][i], way[2][i]}; }

  alignas(64) double from[3][kCapacity];  // shading points
  alignas(64) double u[kCapacity], v[kCapacity];
  alignas(64) std::int64_t light[kCapacity];  // index of the light

  alignas(64) double way[3][kCapacity];  // from the shading point to a point of the surface
  alignas(64) double distance[kCapacity];
  alignas(64) double cosine[kCapacity];      // between the face's normal and the way back
  alignas(64) std::int64_t axis[kCapacity];  // of the sampled face
  alignas(64) double pdf[kCapacity];         // per solid angle; 0: no sample, or never sampled
};

// Samples a point for each of `from` by u and v. Sets way, distance, cosine, axis and pdf.
void sample_box_lights(std::span<const BoxLight> lights, std::size_t count, BoxLightRows& rows);
// Sets pdf to the density with which sample_box_lights() samples `way` for `from`.
void set_box_light_pdfs(std::span<const BoxLight> lights, std::size_t count, BoxLightRows& rows);

}  // namespace fathom::runtime
