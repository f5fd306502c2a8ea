// One ray's place in the stream: a small state machine, moved on by each evaluation of the field.
//
//   Start --> Walk <--> Retreat        Walk: at t with g(t) = g > 0, the field asked for at t_next
//     |        |  |                    Retreat: the last step was too long; the plain safe one is under way
//   Emerge     |  Refine --> Hit       Refine: a crossing lies in [t, t_hi]
//              Miss, Certify           Emerge: began on the wrong side of the surface, by rounding
//
// A step of length z from a sample with safe radius r is accepted when z <= r + r' with r' the safe radius found
// there: the two balls then leave no gap (Keinert et al., "Enhanced Sphere Tracing", 2014). Its length is z = 2 r /
// (1 - m), where the field is modelled as a plane of slope m along the ray, and m is an average of the slopes seen
// (Ban and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023).
//
// Not a public header: march.h is.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace fathom::runtime {

enum class LaneVerdict : std::uint8_t { Going, Hit, Miss, Invalid, Certify };

struct Lane {
  enum class Phase : std::uint8_t { Start, Emerge, Walk, Retreat, Refine };

  glm::vec3 origin, direction;
  float side;              // 0 until the first evaluation when it has to be found out
  float t_max;             // the ray ends here
  float t, g;              // the last accepted sample; while refining the bracket's free end
  float t_next;            // where the field is evaluated next
  float r;                 // safe radius at t: nothing lies within (t - r, t + r)
  float m;                 // relaxation: expected slope of the safe radius along the ray
  float slope;             // of g over the last accepted step
  float t_hi, g_hi, g_lo;  // while refining: the far end, its value, the value the secant uses at the free end
  float width;             // of the bracket, once hit
  std::uint16_t evaluations;
  std::uint8_t patience;  // samples to accept before the next attempt to cross
  std::uint8_t failures;  // attempts to cross that met no surface
  bool crossing;          // the step under way is such an attempt
  Phase phase;
};

// What a lane must know of the field.
struct LaneRules {
  float inv_lipschitz;
  float band;    // scene units
  float finest;  // scene units (runtime/field.h)
};

// Moves the lane on, given f at t_next and the error bound d_f there.
LaneVerdict update(Lane& lane, float f, float error, const LaneRules& rules) noexcept;

}  // namespace fathom::runtime
