// The renderer's own way to follow rays, for a register of lanes at once: steps certified by the Lipschitz constant
// and stretched by automatic relaxation; near the surface a step that should cross it; then the bracket shrinks.
//
// A step of length z from a sample with safe radius r is accepted when z <= r + r' with r' the safe radius found
// there: the two balls then leave no gap (Keinert et al., "Enhanced Sphere Tracing", 2014). Its length is z = 2 r /
// (1 - m), where the field is modelled as a plane of slope m along the ray, and m is an average of the slopes seen
// (Ban and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023). The bracket shrinks by the Illinois
// method: an end that stays twice running has its value halved, which pulls the secant towards it (Dowell and
// Jarratt, "A Modified Regula Falsi Method", 1971).
#if defined(FATHOM_RUNTIME_TIERED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_RUNTIME_TIERED_INL
#undef FATHOM_RUNTIME_TIERED_INL
#else
#define FATHOM_RUNTIME_TIERED_INL
#endif

#include <limits>

#include "runtime/lane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

// Weight of the newest slope in m; Ban and Valasek's choice.
inline constexpr double kBeta = 0.3;
// m stays below this, so that a step is at most 2 / (1 - 0.9) = 20 safe radii.
inline constexpr double kLargestM = 0.9;
// Within this many d_f of the surface, or the field's band when that is more, a crossing is tried.
inline constexpr double kBandErrors = 16;
// It is aimed beyond the predicted root by this share of the way, and a few d_f, to come out on the far side.
inline constexpr double kOvershoot = 1.1, kOvershootErrors = 4;
// ... and is at most this many bands long: what lies in the way of a longer one could be stepped over unseen. A band
// widened by d_f may take it to twice that, no further.
inline constexpr double kLongestCrossing = 16;
// After an attempt that met no surface so many samples are accepted before the next, then twice as many. A lane that
// would have to wait for more than the most grazes the surface, and is finished by certify(), as is one that takes
// more evaluations than its budget.
inline constexpr double kMostPenalty = 16, kBudget = 512;
// A value this small a part of d_f holds no more digits of the root: half a unit in the last place at 1.
inline constexpr double kRootError = 0x1p-8;
// Of d_f, what float is usually off by; and how uncertain a root may be, relative to t or to the field's band, before
// double looks at it.
inline constexpr double kTypicalError = 0.25, kTolerance = 0x1p-16, kBandShare = 0.125;

template <class N, class S>
class Tiered {
 public:
  using Mask = MaskOf<N>;

  HWY_INLINE Tiered(Lanes<S>& lanes, std::size_t first, const LaneRules<S>& rules)
      : a_(lanes, first),
        inv_lipschitz_(N::broadcast(rules.inv_lipschitz)),
        field_band_(N::broadcast(rules.band)),
        resolution_(N::broadcast(rules.resolution)) {}

  // f: the field at the lanes' points.
  HWY_INLINE void run(N f, const LaneRules<S>& rules) {
    look(f, distance_error(a_, f, rules));
    const Mask starting = a_.in_phase(LanePhase::Start), emerging = a_.in_phase(LanePhase::Emerge);
    const Mask retreating = a_.in_phase(LanePhase::Retreat), refining = a_.in_phase(LanePhase::Refine);
    const Mask beginning = starting | emerging, walking = !(beginning | refining);
    const Mask inside = g_<k(0), outside = !inside, crossing = a_.get(kCrossing)> k(0);
    const N gap = a_.get(kTNext) - a_.get(kT) - a_.get(kR) - r_;  // what neither ball covers

    // An exact 0 is a touch, as where a solid is cut from its like.
    const Mask accepted = outside & (beginning | (walking & (retreating | !(gap > k(0)))));
    const Mask crossed = inside & walking & (crossing | retreating | !(gap > unseen_));
    const Mask failed = walking & !(accepted | crossed);
    accept(accepted, accepted & walking);
    retreat(failed, failed & crossing);
    if (any(inside & beginning)) {
      begin_inside(inside & starting);
      a_.settle(inside & emerging, k(0), a_.get(kTNext));
    }
    if (any(refining | crossed)) refine(refining, crossed);
    a_.finish();
  }

 private:
  static HWY_INLINE N k(double value) { return number<N>(value); }

  HWY_INLINE void look(N f, N error) {
    a_.put(kEvaluations, a_.get(kEvaluations) + k(1));
    a_.conclude(!(abs(f) < k(std::numeric_limits<double>::infinity())), LaneVerdict::Invalid);
    a_.put(kSide, is_zero(a_.get(kSide)), select(f < k(0), k(-1), k(1)));
    error_ = error;
    g_ = a_.get(kSide) * f;
    r_ = (abs(g_) - error) * inv_lipschitz_;
    band_ = max(field_band_, k(kBandErrors) * error);
    unseen_ = min(band_, k(2) * field_band_);
    longest_ = k(kLongestCrossing) * unseen_;
    // Far from the origin, or where large numbers cancel, d_f is larger than any step that may be taken unseen: what
    // happens near the surface is for double to decide.
    coarse_ = k(kOvershootErrors) * error > longest_;
  }

  // Steps that t can hardly hold lead nowhere.
  HWY_INLINE Mask is_step(N t, N z) const { return z > resolution_ * max(t, error_); }

  // The sample at t_next becomes the last accepted one; those that came there by a step learn from it, and the next
  // step is proposed. What is computed for other lanes is nowhere put.
  HWY_INLINE void accept(Mask accepted, Mask stepped) {
    const N t = a_.get(kTNext), per_z = k(1) / (t - a_.get(kT));
    const N m = k(1 - kBeta) * a_.get(kM) + k(kBeta) * ((r_ - a_.get(kR)) * per_z);
    a_.put(kM, stepped, min(m, k(kLargestM)));
    a_.put(kSlope, stepped, (g_ - a_.get(kG)) * per_z);
    a_.put(kT, accepted, t);
    a_.put(kG, accepted, g_);
    a_.put(kR, accepted, r_);
    a_.conclude(accepted & !(max(t, t + r_) < a_.get(kTMax)), LaneVerdict::Miss);

    const N slope = a_.get(kSlope), patience = a_.get(kPatience);
    const Mask near = accepted & (g_ < band_) & (slope < k(0));
    const Mask waits = near & (patience > k(0)) & (r_ > error_), tries = near & !waits;
    a_.put(kPatience, waits, patience - k(1));
    const N relaxed = k(2) * r_ / (k(1) - a_.get(kM));
    const N beyond = (k(kOvershoot) * g_ + k(kOvershootErrors) * error_) / -slope;
    const N z = select(tries, max(relaxed, min(beyond, longest_)), relaxed);
    a_.put(kCrossing, accepted, select(tries & (beyond > relaxed), k(1), k(0)));
    const Mask spent = !(a_.get(kEvaluations) < k(kBudget)), stuck = !is_step(t, z);
    a_.conclude(accepted & (spent | stuck | (near & coarse_)), LaneVerdict::Certify);
    a_.put(kTNext, accepted, min(t + z, a_.get(kTMax)));
    a_.enter(accepted, LanePhase::Walk);
  }

  HWY_INLINE void retreat(Mask failed, Mask from_crossing) {
    const N t = a_.get(kT), r = a_.get(kR), penalty = a_.get(kPenalty);
    a_.put(kM, failed, k(-1));
    a_.put(kPatience, from_crossing, penalty);
    a_.put(kPenalty, from_crossing, penalty + penalty);
    a_.put(kTNext, failed, t + r);
    a_.enter(failed, LanePhase::Retreat);
    const Mask grazes = from_crossing & (penalty > k(kMostPenalty)), stuck = !is_step(t, r);
    a_.conclude(failed & (grazes | stuck), LaneVerdict::Certify);
  }

  // Beyond the surface it should have left. One look ahead tells whether it comes out or goes in.
  HWY_INLINE void begin_inside(Mask inside) {
    a_.put(kTNext, inside, k(4) * (k(16) * error_ - g_) * inv_lipschitz_);
    a_.enter(inside, LanePhase::Emerge);
    a_.conclude(inside & coarse_ & (-g_ < error_), LaneVerdict::Certify);
  }

  // The bracket [t, t_hi] shrinks to the sample, and the secant says where to look next.
  HWY_INLINE void refine(Mask refining, Mask crossed) {
    const Mask all = refining | crossed, lower = refining & (g_ > k(0)), upper = all & !lower;
    const N t = a_.get(kTNext), half = k(0.5);
    const N lo = select(lower, t, a_.get(kT)), hi = select(upper, t, a_.get(kTHi));
    const N g_lo = select(lower, g_, select(crossed, a_.get(kG), half * a_.get(kGLo)));
    const N g_hi = select(upper, g_, half * a_.get(kGHi));
    const N width = hi - lo, done = resolution_ * hi, aside = half * done;
    const N next = min(max(lo + g_lo / (g_lo - g_hi) * width, lo + aside), hi - aside);

    // A small value behind the surface, or 0, may be where two solids meet; before it, it is no more than a touch.
    const Mask root = lower & (!(g_ > k(kRootError) * error_));
    const Mask divisible = (width > done) & (next > lo) & (next < hi);
    const Mask found = all & (root | (!divisible));
    // A root of what is nearly level is as uncertain as d_f divided by the slope.
    const N fall = select(crossed, a_.get(kG) - g_, a_.get(kSlope)), over = select(crossed, width, a_.get(kR));
    const N slack = k(kTypicalError) * error_ * over;
    const Mask vague = found & (slack > max(k(kTolerance) * t, k(kBandShare) * field_band_) * fall);
    a_.put(kT, all, lo);
    a_.conclude(vague, LaneVerdict::Certify);
    a_.settle(found, select(root, t, select(g_lo < -g_hi, lo, hi)), select(root, done, width));
    a_.put(kSlope, all, fall);
    a_.put(kR, all, over);
    a_.put(kTHi, all, hi);
    a_.put(kGLo, all, g_lo);
    a_.put(kGHi, all, g_hi);
    a_.put(kTNext, all, next);
    a_.enter(crossed, LanePhase::Refine);
  }

  LaneView<N, S> a_;
  const N inv_lipschitz_, field_band_, resolution_;
  N error_, g_, r_, band_, unseen_, longest_;
  Mask coarse_;
};

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
