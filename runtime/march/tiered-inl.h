// The renderer's own way to follow rays, for a register of lanes at once: steps certified by the Lipschitz constant
// and stretched by automatic relaxation; near the surface a step that should cross it; then the bracket shrinks.
//
// A step of length z from a sample with safe radius r is accepted when z <= r + r' with r' the safe radius found
// there: the two balls then leave no gap (Keinert et al., "Enhanced Sphere Tracing", 2014). Its length is z = 2 r /
// (1 - m), where the field is modelled as a plane of slope m along the ray, and m is an average of the slopes seen
// (Ban and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023). The bracket shrinks by the Illinois
// method: an end that stays twice running has its value halved, which pulls the secant towards it (Dowell and
// Jarratt, "A Modified Regula Falsi Method", 1971).
//
// Where the field is known to be convex around a sample (vm/number/convex-inl.h), the line through it and the one
// before is a lower bound of what follows: a step to where that line is 0 is safe, however long, and one that crosses
// there passes over nothing. A line that rises is safe to where something else may come near.
#if defined(FATHOM_RUNTIME_TIERED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_RUNTIME_TIERED_INL
#undef FATHOM_RUNTIME_TIERED_INL
#else
#define FATHOM_RUNTIME_TIERED_INL
#endif

#include <limits>

#include "runtime/march/lane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

// Weight of the newest slope in m, and a step's length in 1/(1 - m) safe radii. Ban and Valasek have 0.3 and 2, with
// which the two balls of a plane just touch and rounding decides: a hair less saves a tenth of the evaluations.
inline constexpr double kBeta = 0.5, kReach = 1.99;
// m stays below this, so that a step is at most 2 / (1 - 0.9) = 20 safe radii.
inline constexpr double kLargestM = 0.9;
// Within this many d_f of the surface, or the field's band when that is more, a crossing is tried.
inline constexpr double kBandErrors = 16;
// It is aimed beyond the predicted root by this share of the way, and a few d_f, to come out on the far side; from
// afar, along a line that holds, by less, for there the share is long.
inline constexpr double kOvershoot = 1.1, kFarOvershoot = 1.01, kOvershootErrors = 4;
// ... and is at most this many bands long: what lies in the way of a longer one could be stepped over unseen. A band
// widened by d_f may take it to twice that, no further.
inline constexpr double kLongestCrossing = 16;
// So that kOvershootErrors d_f are no longer than the longest crossing, d_f may be no more than so many bands.
inline constexpr double kCoarse = 2 * kLongestCrossing / kOvershootErrors;
// After an attempt that met no surface so many samples are accepted before the next, then twice as many. A lane that
// would have to wait for more than the most grazes the surface, and is finished by certify(), as is one that takes
// more evaluations than its budget.
inline constexpr double kMostPenalty = 16, kBudget = 704;
// After one from afar a single one: it says where the line bends, and nothing of what is near.
inline constexpr double kFarPenalty = 1;
// What is convex without end is so this far, a number that can be reckoned with.
inline constexpr double kEndless = 0x1p100;
// A value this small a part of d_f holds no more digits of the root: a fiftieth of a unit in the last place at 1.
inline constexpr double kRootError = 0x1p-8;
// Of d_f, what float is usually off by; and how uncertain a root may be, relative to t or to the field's band, before
// double looks at it. What is small beside 1 and seen from nearby needs it, where d_f is large for what is seen.
inline constexpr double kTypicalError = 0.25, kTolerance = 0x1p-16, kBandShare = 0.125;

template <class N, class S, bool kConvex>
class Tiered {
 public:
  using Mask = MaskOf<N>;

  HWY_INLINE Tiered(Lanes<S>& lanes, std::size_t first, const LaneRules<S>& rules)
      : a_(lanes, first),
        inv_lipschitz_(N::broadcast(rules.inv_lipschitz)),
        field_band_(N::broadcast(rules.band)),
        resolution_(N::broadcast(rules.resolution)) {}

  // f: the field at the lanes' points; convex: how far around them it is so. What is computed for lanes that it does
  // not concern is nowhere put. Returns those that have ended.
  HWY_INLINE Mask run(N f, N convex, const LaneRules<S>& rules) {
    look(f, distance_error(a_, f, rules));
    const N phase = a_.get(kPhase);
    const Mask beginning = phase < code(LanePhase::Walk), refining = phase == code(LanePhase::Refine);
    const Mask retreating = phase == code(LanePhase::Retreat), walking = !(beginning | refining);
    // An exact 0 is a touch, as where a solid is cut from its like.
    const Mask inside = g_ < k(0), outside = g_ >= k(0);
    // What may be 0 and is rounded below it is no crossing, for where the field is 0 over a volume nothing is solid.
    const Mask deep = g_ < -error_;
    const Mask crossing = phase == code(LanePhase::Cross);
    const N gap = t_ - last_t_ - last_r_ - r_;  // what neither ball covers

    const Mask accepted = outside & (beginning | (walking & (retreating | (gap <= k(0)))));
    const Mask crossed = deep & walking & (crossing | retreating | (gap <= unseen_));
    const Mask failed = walking & (!(accepted | crossed)), bracketed = refining | crossed;
    phase_ = select(failed, code(LanePhase::Retreat), select(crossed, code(LanePhase::Refine), phase));
    new_t_ = select(accepted, t_, last_t_);
    new_g_ = select(accepted, g_, last_g_);
    const Mask stepped = accepted & walking;
    ahead_ = r_;
    if constexpr (kConvex) look_ahead(convex, stepped, rules);
    learn(stepped, failed);
    const N onwards = go_on(accepted, stepped), back = retreat(failed, failed & crossing, failed & retreating);
    next_ = select(accepted, onwards, back);
    new_r_ = select(accepted, ahead_, last_r_);
    if (any(bracketed)) refine(bracketed, refining & (g_ > k(0)), crossed);
    if (any(inside & beginning)) begin_inside(inside & beginning, phase);
    return finish(f);
  }

 private:
  static HWY_INLINE N k(double value) { return number<N>(value); }
  template <class Enum>
  static HWY_INLINE N code(Enum value) {
    return HWY_NAMESPACE::code<N>(value);
  }

  HWY_INLINE void look(N f, N error) {
    N side = a_.get(kSide);
    if (any(side == k(0))) {
      side = select(side == k(0), select(f < k(0), k(-1), k(1)), side);
      a_.put(kSide, side);
    }
    evaluations_ = a_.get(kEvaluations) + k(1);
    error_ = error;
    g_ = side * f;
    r_ = (abs(g_) - error) * inv_lipschitz_;
    t_ = a_.get(kTNext);
    last_t_ = a_.get(kT);
    last_g_ = a_.get(kG);
    last_r_ = a_.get(kR);
    band_ = max(field_band_, k(kBandErrors) * error);
    unseen_ = min(band_, k(2) * field_band_);
  }

  // Steps that t can hardly hold lead nowhere.
  HWY_INLINE Mask is_stuck(N t, N z) const { return z <= resolution_ * max(t, error_); }

  // How far ahead is free by the line through the last two samples, where both are of one convex function: where the
  // last one's value was less than what else there is could have come down to there.
  HWY_INLINE void look_ahead(N convex, Mask stepped, const LaneRules<S>& rules) {
    const N unit = N::broadcast(rules.unit), known = min(convex, k(kEndless));
    const N run = t_ - last_t_, errors = k(2) * error_ + unit * (run + last_g_);  // of both values
    const N reach = known - unit * known - error_;
    on_line_ = stepped & (a_.get(kSide) > k(0)) & (last_g_ + errors < reach - N::broadcast(rules.lipschitz) * run);
    reach_ = reach * inv_lipschitz_;
    const N drop = last_g_ - g_ + errors;
    const N meets = select(drop > k(0), (g_ - error_) * run / drop, reach_);
    ahead_ = select(on_line_, max(r_, min(meets, reach_)), r_);
  }

  // From the step that led here; one that was too long says nothing but that.
  HWY_INLINE void learn(Mask stepped, Mask failed) {
    const N m = a_.get(kM), seen = (g_ - last_g_) * inv_lipschitz_ * rough_reciprocal(t_ - last_t_);
    m_ = select(stepped, min(k(1 - kBeta) * m + k(kBeta) * seen, k(kLargestM)), select(failed, k(-1), m));
  }

  // The next place after an accepted sample.
  HWY_INLINE N go_on(Mask accepted, Mask stepped) {
    const N t_max = a_.get(kTMax), patience = a_.get(kPatience);
    misses_ = accepted & (max(t_, t_ + ahead_) >= t_max);
    const Mask falls = stepped & (g_ < last_g_), near = falls & (g_ < band_);
    const Mask nearing = kConvex ? near | (falls & on_line_) : near;
    const Mask waits = nearing & (patience > k(0)) & (r_ > error_), tries = nearing & (!waits);
    patience_ = select(waits, patience - k(1), patience);
    const N relaxed = max(ahead_, k(kReach) * r_ * rough_reciprocal(k(1) - m_));
    // Where the line through the last two samples would be well beyond the surface.
    const N overshoot = kConvex ? select(near, k(kOvershoot), k(kFarOvershoot)) : k(kOvershoot);
    const N beyond =
        (overshoot * g_ + k(kOvershootErrors) * error_) * (t_ - last_t_) * rough_reciprocal(last_g_ - g_);
    const N longest = k(kLongestCrossing) * unseen_;
    const N crossing = min(beyond, kConvex ? select(on_line_, max(reach_, longest), longest) : longest);
    const N z = select(tries, max(relaxed, crossing), relaxed);
    phase_ =
        select(accepted, select(tries & (beyond > relaxed), code(LanePhase::Cross), code(LanePhase::Walk)), phase_);
    // Far from the origin, or where large numbers cancel, d_f is larger than any step that may be taken unseen: what
    // happens near the surface is for double to decide.
    const Mask coarse = near & (error_ > k(kCoarse) * field_band_);
    undecided_ = accepted & ((evaluations_ >= k(kBudget)) | is_stuck(t_, z) | coarse);
    return min(t_ + z, t_max);
  }

  // The plain step from the last accepted sample.
  HWY_INLINE N retreat(Mask failed, Mask from_crossing, Mask again) {
    const N penalty = a_.get(kPenalty);
    const Mask near = from_crossing & (last_g_ < band_), grazes = near & (penalty > k(kMostPenalty));
    patience_ = select(near, penalty, select(from_crossing, k(kFarPenalty), patience_));
    penalty_ = select(near, penalty + penalty, penalty);
    undecided_ = undecided_ | grazes | again | (failed & is_stuck(last_t_, last_r_));
    return last_t_ + last_r_;
  }

  // Beyond the surface it should have left. One look ahead tells whether it comes out or goes in.
  HWY_INLINE void begin_inside(Mask inside, N phase) {
    const Mask starting = inside & (phase == code(LanePhase::Start)), emerging = inside & (!starting);
    const Mask coarse = error_ > k(kCoarse) * field_band_;
    const Mask shallow = -g_ < error_;
    undecided_ = undecided_ | (shallow & (emerging | (starting & coarse)));
    phase_ = select(starting, code(LanePhase::Emerge), phase_);
    hits_ = hits_ | (emerging & (!shallow));
    new_t_ = select(emerging, k(0), new_t_);  // kRoot
    new_r_ = select(emerging, t_, new_r_);    // kWidth
    next_ = select(inside, k(4) * (k(16) * error_ - g_) * inv_lipschitz_, next_);
  }

  // The bracket [t, t_hi] shrinks to the sample, and the secant says where to look next.
  HWY_INLINE void refine(Mask bracketed, Mask lower, Mask crossed) {
    const N half = k(0.5);
    const N lo = select(lower, t_, last_t_), hi = select(lower, a_.get(kTHi), t_);
    const N g_lo = select(lower, g_, select(crossed, last_g_, half * last_g_));
    const N g_hi = select(lower, half * a_.get(kGHi), g_);
    const N width = hi - lo, done = resolution_ * hi, aside = half * done;
    // The secant stays beside an end that is 0, where the root may be. Where it is 0 there, too, as where t is so
    // small that many t are one place, it would stay for as many samples.
    const Mask creeps = (!lower) & (!crossed) & (g_ == k(0)) & (a_.get(kGHi) == k(0));
    const N share = select(creeps, half, g_lo / (g_lo - g_hi));
    const N next = min(max(lo + share * width, lo + aside), hi - aside);

    // A small value behind the surface, or 0, may be where two solids meet; before it, it is no more than a touch.
    const Mask root = lower & (g_ <= k(kRootError) * error_);
    const Mask found = bracketed & (root | (width <= done) | (next <= lo) | (next >= hi));
    // A root of what is nearly level is as uncertain as d_f divided by the slope.
    const N fall = select(crossed, last_g_ - g_, a_.get(kFall)), span = select(crossed, width, last_r_);
    const N slack = k(kTypicalError) * error_ * span;
    const Mask vague = found & (slack > max(k(kTolerance) * t_, k(kBandShare) * field_band_) * fall);
    const Mask known = found & (!vague);
    undecided_ = undecided_ | vague;
    hits_ = hits_ | known;

    patience_ = select(bracketed, hi, patience_);  // kTHi
    penalty_ = select(bracketed, g_hi, penalty_);  // kGHi
    m_ = select(bracketed, fall, m_);              // kFall
    new_g_ = select(bracketed, g_lo, new_g_);      // kGLo
    const N best = select(root, t_, select(g_lo < -g_hi, lo, hi));
    new_t_ = select(known, best, select(bracketed, lo, new_t_));                         // kRoot or kTLo
    new_r_ = select(known, select(root, done, width), select(bracketed, span, new_r_));  // kWidth or kSpan
    next_ = select(bracketed, next, next_);
  }

  HWY_INLINE Mask finish(N f) {
    a_.put(kEvaluations, evaluations_);
    a_.put(kPhase, phase_);
    a_.put(kT, new_t_);
    a_.put(kG, new_g_);
    a_.put(kR, new_r_);
    a_.put(kM, m_);
    a_.put(kPatience, patience_);
    a_.put(kPenalty, penalty_);
    const Mask finite = abs(f) < k(std::numeric_limits<double>::infinity());
    N verdict = select(undecided_, code(LaneVerdict::Certify), code(LaneVerdict::Going));
    verdict = select(misses_, code(LaneVerdict::Miss), select(hits_, code(LaneVerdict::Hit), verdict));
    // A lane that is invalid stays where it is.
    return a_.finish(select(finite, next_, t_), select(finite, verdict, code(LaneVerdict::Invalid)));
  }

  LaneView<N, Lanes<S>> a_;
  const N inv_lipschitz_, field_band_, resolution_;
  N error_, g_, r_, t_;         // of the sample: d_f, value, safe radius, place
  N last_t_, last_g_, last_r_;  // of the last accepted one; of a bracket as in lane_rows.h
  N band_, unseen_, evaluations_;
  Mask on_line_;     // of kConvex alone: whether the line through both holds
  N reach_, ahead_;  // how far it does; how far is free
  N phase_, new_t_, new_g_, new_r_, m_, patience_, penalty_, next_;  // what is put at the end
  Mask undecided_, misses_, hits_ = number<N>(0) > number<N>(0);
};

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
