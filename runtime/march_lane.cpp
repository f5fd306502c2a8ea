#include "runtime/march_lane.h"

#include <algorithm>
#include <cmath>

namespace fathom::runtime {
namespace {

// Weight of the newest slope in m; Ban and Valasek's choice.
constexpr float kBeta = 0.3f;
// m stays below this, so that a step is at most 2 / (1 - 0.9) = 20 safe radii.
constexpr float kLargestM = 0.9f;
// A crossing is aimed beyond the predicted root by this share of the way, and a few d_f, to come out on the far side.
constexpr float kOvershoot = 1.1f;
constexpr float kOvershootErrors = 4;
// ... and is at most this many bands long: what lies in the way of a longer one could be stepped over unseen. A band
// widened by d_f may take it to twice that, no further.
constexpr float kLongestCrossing = 16;
// A lane that takes more evaluations in float than this is finished by certify().
constexpr int kBudget = 512;
// A value this small a part of d_f holds no more digits of the root: half a unit in the last place at 1.
constexpr float kRootError = 0.0625f;
// Width of a bracket that is done, relative to t: two units in the last place.
constexpr float kRootWidth = 0x1p-22f;

float safe_radius(float g, float error, const LaneRules& rules) {
  return (std::abs(g) - error) * rules.inv_lipschitz;
}

float band_of(float error, const LaneRules& rules) { return std::max(rules.band, 16 * error); }

float longest_crossing(float error, const LaneRules& rules) {
  return kLongestCrossing * std::min(band_of(error, rules), 2 * rules.band);
}

// Far from the origin, or where large numbers cancel, d_f is larger than any step that may be taken unseen: what
// happens near the surface is for double to decide.
bool float_is_too_coarse(float error, const LaneRules& rules) {
  return kOvershootErrors * error > longest_crossing(error, rules);
}

LaneVerdict propose(Lane& a, float error, const LaneRules& rules) {
  if (a.t + a.r >= a.t_max) return LaneVerdict::Miss;
  if (a.evaluations >= kBudget) return LaneVerdict::Certify;
  float z = 2 * a.r / (1 - a.m);
  a.crossing = false;
  if (a.g < band_of(error, rules) && a.slope < 0) {
    if (float_is_too_coarse(error, rules)) return LaneVerdict::Certify;
    if (a.patience > 0 && a.r > error) {
      --a.patience;
    } else {
      const float beyond = (kOvershoot * a.g + kOvershootErrors * error) / -a.slope;
      a.crossing = beyond > z;
      z = std::max(z, std::min(beyond, longest_crossing(error, rules)));
    }
  }
  // Steps that float t can hardly hold lead nowhere.
  if (!(z > kRootWidth * std::max(a.t, error))) return LaneVerdict::Certify;
  a.t_next = std::min(a.t + z, a.t_max);
  a.phase = Lane::Phase::Walk;
  return LaneVerdict::Going;
}

LaneVerdict accept(Lane& a, float g, float r, float error, const LaneRules& rules) {
  const float z = a.t_next - a.t;
  if (z > 0) {
    const float per_z = 1 / z;
    a.m = std::min((1 - kBeta) * a.m + kBeta * ((r - a.r) * per_z), kLargestM);
    a.slope = (g - a.g) * per_z;
  }
  a.t = a.t_next;
  a.g = g;
  a.r = r;
  if (a.t >= a.t_max) return LaneVerdict::Miss;
  return propose(a, error, rules);
}

LaneVerdict retreat(Lane& a, float error) {
  a.m = -1;
  if (a.crossing) {
    if (a.failures < 7) ++a.failures;
    a.patience = static_cast<std::uint8_t>(1u << a.failures);
  }
  a.t_next = a.t + a.r;
  a.phase = Lane::Phase::Retreat;
  if (!(a.r > kRootWidth * std::max(a.t, error))) return LaneVerdict::Certify;
  return LaneVerdict::Going;
}

LaneVerdict hit(Lane& a, float t, float width) {
  a.t = t;
  a.width = width;
  return LaneVerdict::Hit;
}

// The next place to look for the root in [t, t_hi]: the secant's, kept off the ends; the middle every fourth time.
LaneVerdict divide(Lane& a) {
  const float width = a.t_hi - a.t;
  const float done = kRootWidth * a.t_hi;
  if (width <= done) return hit(a, a.g < -a.g_hi ? a.t : a.t_hi, width);
  const float share = a.evaluations % 4 == 3 ? 0.5f : a.g_lo / (a.g_lo - a.g_hi);
  const float aside = 0.5f * done;
  a.t_next = std::clamp(a.t + share * width, a.t + aside, a.t_hi - aside);
  if (!(a.t_next > a.t && a.t_next < a.t_hi)) return hit(a, a.t_hi, width);
  return LaneVerdict::Going;
}

LaneVerdict begin_refining(Lane& a, float g, float error) {
  a.phase = Lane::Phase::Refine;
  a.t_hi = a.t_next;
  a.g_hi = g;
  a.g_lo = a.g;
  if (-g <= kRootError * error) return hit(a, a.t_hi, kRootWidth * a.t_hi);
  return divide(a);
}

// Illinois method: an end that stays twice running has its value halved, which pulls the secant towards it (Dowell
// and Jarratt, "A Modified Regula Falsi Method", 1971).
LaneVerdict refine(Lane& a, float g, float error) {
  if (std::abs(g) <= kRootError * error) return hit(a, a.t_next, kRootWidth * a.t_next);
  if (g > 0) {
    a.t = a.t_next;
    a.g = a.g_lo = g;
    a.g_hi *= 0.5f;
  } else {
    a.t_hi = a.t_next;
    a.g_hi = g;
    a.g_lo *= 0.5f;
  }
  return divide(a);
}

LaneVerdict walk(Lane& a, float g, float error, const LaneRules& rules) {
  const float z = a.t_next - a.t;
  const float r = safe_radius(g, error, rules);
  const float gap = z - a.r - r;  // what neither ball covers
  const bool plain = a.phase == Lane::Phase::Retreat;
  if (g >= 0) {  // a zero is no change of sign: where coplanar cuts leave nothing, the field is 0 and not below
    if (gap <= 0 || plain) return accept(a, g, r, error, rules);
    return retreat(a, error);
  }
  if (a.crossing || plain || gap <= std::min(band_of(error, rules), 2 * rules.band))
    return begin_refining(a, g, error);
  return retreat(a, error);
}

LaneVerdict start(Lane& a, float f, float error, const LaneRules& rules) {
  const bool given = a.side != 0;
  if (!given) a.side = f < 0 ? -1.0f : 1.0f;
  const float g = a.side * f;
  a.g = g;
  a.r = safe_radius(g, error, rules);
  a.slope = 0;
  if (g > 0) return propose(a, error, rules);
  if (-g < error && float_is_too_coarse(error, rules)) return LaneVerdict::Certify;
  // Beyond the surface it should have left. One look ahead tells whether it comes out or goes in.
  a.phase = Lane::Phase::Emerge;
  a.t_next = 4 * (-g + 16 * error) * rules.inv_lipschitz;
  return LaneVerdict::Going;
}

LaneVerdict emerge(Lane& a, float g, float error, const LaneRules& rules) {
  if (!(g > 0)) return hit(a, 0, a.t_next);
  a.t = a.t_next;
  a.g = g;
  a.r = safe_radius(g, error, rules);
  return propose(a, error, rules);
}

}  // namespace

LaneVerdict update(Lane& a, float f, float error, const LaneRules& rules) noexcept {
  ++a.evaluations;
  if (!(std::abs(f) < INFINITY)) return LaneVerdict::Invalid;
  switch (a.phase) {
    case Lane::Phase::Start:
      return start(a, f, error, rules);
    case Lane::Phase::Emerge:
      return emerge(a, a.side * f, error, rules);
    case Lane::Phase::Walk:
    case Lane::Phase::Retreat:
      return walk(a, a.side * f, error, rules);
    case Lane::Phase::Refine:
      return refine(a, a.side * f, error);
  }
  return LaneVerdict::Invalid;
}

}  // namespace fathom::runtime
