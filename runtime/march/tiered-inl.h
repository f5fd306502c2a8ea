// The renderer's own method of following rays, for a register of lanes at once. Steps are certified by the Lipschitz
// constant and lengthened by automatic relaxation. Near the surface a step tries to cross it, and then the bracket
// shrinks.
//
// A step of length z from a sample with safe radius r is accepted if z <= r + r', where r' is the safe radius at the
// new sample: the two balls then leave no gap (Keinert et al., "Enhanced Sphere Tracing", 2014). The length is
// z = 2 r / (1 - m), where the field is modelled as a plane of slope m along the ray, and m is an average of the
// slopes seen (Ban and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023). The bracket shrinks by the
// Illinois method: an end that stays twice running has its value halved, which pulls the secant towards that end
// (Dowell and Jarratt, "A Modified Regula Falsi Method", 1971).
//
// If the field is known to be convex around a sample (vm/number/convexity-inl.h), the line through this sample and
// the one before is a lower bound of the field further on. A step to the zero of the line is safe, however long, and
// a step that crosses the surface there passes over nothing. A rising line is safe up to where another object may
// come near.
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

// kBeta: weight of the newest slope in m. kReach: length of a step in units of r / (1 - m). Ban and Valasek have 0.3
// and 2. With 2, the two balls of a plane just touch, and rounding or a slight bend decides: 1.95 lets
// fewer steps fail.
inline constexpr double kBeta = 0.5, kReach = 1.95;
// Maximum of m, so that a step is at most 2 / (1 - 0.9) = 20 safe radii.
inline constexpr double kLargestM = 0.9;
// A crossing is tried within this many d_f of the surface, or within the field's band if that is more.
inline constexpr double kBandErrors = 16;
// A crossing has this length relative to the way to the predicted root, plus kOvershootErrors d_f, to come out on the
// far side. From afar, along a line that holds, the factor is kFarOvershoot, because the way is long there.
inline constexpr double kOvershoot = 1.1, kFarOvershoot = 1.01, kOvershootErrors = 4;
// Maximum length of a crossing, in bands: a longer step could pass over an object unseen. A band widened by d_f may
// double that length, but no more.
inline constexpr double kLongestCrossing = 16;
// Maximum of d_f, in bands, so that kOvershootErrors d_f are no longer than the longest crossing.
inline constexpr double kCoarse = 2 * kLongestCrossing / kOvershootErrors;
// kMaxBackoff: after an attempt to cross that met no surface, a lane accepts a number of samples before the next
// attempt, and twice as many after each further one. A lane that would have to wait for more samples than this grazes
// the surface, and is finished by certify(). kBudget: certify() also finishes a lane that takes more evaluations.
inline constexpr double kMaxBackoff = 64, kBudget = 704;
// Samples to accept after a failed attempt from afar, which shows where the line bends and nothing of what is near.
inline constexpr double kFarBackoff = 1;
// A finite number in place of an infinite convexity radius, for use in arithmetic.
inline constexpr double kMaxConvexityRadius = 0x1p100;
// Share of d_f below which a value holds no more digits of the root: a sixth of a unit in the last place at 1.
inline constexpr double kRootError = 0x1p-5;
// kTypicalError: usual error of float, as a share of d_f. kTolerance and kBandShare: maximum uncertainty of a root,
// relative to t or to the field's band, above which double decides. An object that is small compared to 1 and seen
// from nearby needs double, because d_f is large relative to what is seen.
inline constexpr double kTypicalError = 0.25, kTolerance = 0x1p-16, kBandShare = 0.125;

template <class N, class S, bool kConvex>
class Tiered {
 public:
  using Mask = MaskOf<N>;

  HWY_INLINE Tiered(Lanes<S>& lanes, std::size_t first, const LaneRules<S>& rules)
      : lanes_(lanes, first),
        inv_lipschitz_(N::broadcast(rules.inv_lipschitz)),
        field_band_(N::broadcast(rules.band)),
        resolution_(N::broadcast(rules.resolution)) {}

  // f: the field at the lanes' points. convex: the convexity radii there. Values are computed for all lanes, and
  // stored only for the lanes that they concern. Returns the lanes that have ended.
  HWY_INLINE Mask run(N f, N convex, const LaneRules<S>& rules) {
    load_sample(f, distance_error(lanes_, f, rules));
    const N phase = lanes_.get(kPhase);
    const Mask beginning = phase < code(LanePhase::Walk), refining = phase == code(LanePhase::Refine);
    const Mask retreating = phase == code(LanePhase::Retreat), walking = !(beginning | refining);
    // An exact 0 is a touch, e.g. where a solid is cut from an equal one.
    const Mask inside = g_ < k(0), outside = g_ >= k(0);
    // A value that may be 0 but is rounded below 0 is no crossing, because a volume in which the field is 0 is not
    // solid.
    const Mask deep = g_ < -error_;
    const Mask crossing = phase == code(LanePhase::Cross);
    const N gap = t_ - last_t_ - last_r_ - r_;  // length that neither ball covers

    const Mask accepted = outside & (beginning | (walking & (retreating | (gap <= k(0)))));
    const Mask crossed = deep & walking & (crossing | retreating | (gap <= max_gap_));
    const Mask failed = walking & (!(accepted | crossed)), bracketed = refining | crossed;
    phase_ = select(failed, code(LanePhase::Retreat), select(crossed, code(LanePhase::Refine), phase));
    rows_.put(kT, select(accepted, t_, last_t_));
    rows_.put(kG, select(accepted, g_, last_g_));
    const Mask stepped = accepted & walking;
    free_length_ = r_;
    if constexpr (kConvex) extend_by_convexity(convex, stepped, rules);
    update_relaxation(stepped, failed);
    const N onwards = next_accepted(accepted, stepped),
            back = next_rejected(failed, failed & crossing, failed & retreating);
    next_ = select(accepted, onwards, back);
    rows_.put(kR, select(accepted, free_length_, last_r_));
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

  HWY_INLINE void load_sample(N f, N error) {
    N side = lanes_.get(kSide);
    if (any(side == k(0))) {
      side = select(side == k(0), select(f < k(0), k(-1), k(1)), side);
      lanes_.put(kSide, side);
    }
    evaluations_ = lanes_.get(kEvaluations) + k(1);
    error_ = error;
    g_ = side * f;
    r_ = (abs(g_) - error) * inv_lipschitz_;
    t_ = lanes_.get(kTNext);
    last_t_ = lanes_.get(kT);
    last_g_ = lanes_.get(kG);
    last_r_ = lanes_.get(kR);
    band_ = max(field_band_, k(kBandErrors) * error);
    max_gap_ = min(band_, k(2) * field_band_);
  }

  // True if t can hardly hold a step of length z, so that the lane would not get ahead.
  HWY_INLINE Mask is_stuck(N t, N z) const { return z <= resolution_ * max(t, error_); }

  // Computes how far the line through the last two samples proves the ray free. The line holds if both samples are of
  // one convex function: if the last sample's value was less than the values of all other objects could have been
  // there.
  HWY_INLINE void extend_by_convexity(N convex, Mask stepped, const LaneRules<S>& rules) {
    const N unit = N::broadcast(rules.unit), known = min(convex, k(kMaxConvexityRadius));
    const N run = t_ - last_t_, errors = k(2) * error_ + unit * (run + last_g_);  // errors: of both values
    const N reach = known - unit * known - error_;
    line_holds_ =
        stepped & (lanes_.get(kSide) > k(0)) & (last_g_ + errors < reach - N::broadcast(rules.lipschitz) * run);
    line_length_ = reach * inv_lipschitz_;
    const N drop = last_g_ - g_ + errors;
    const N meets = select(drop > k(0), (g_ - error_) * run / drop, line_length_);
    free_length_ = select(line_holds_, max(r_, min(meets, line_length_)), r_);
  }

  // Updates m by the step that led here. A step that was too long says nothing else, and resets m.
  HWY_INLINE void update_relaxation(Mask stepped, Mask failed) {
    const N m = lanes_.get(kM), seen = (g_ - last_g_) * inv_lipschitz_ * rough_reciprocal(t_ - last_t_);
    const N mean = min(k(1 - kBeta) * m + k(kBeta) * seen, k(kLargestM));
    rows_.put(kM, select(stepped, mean, select(failed, k(-1), m)));
  }

  // Returns the next t after an accepted sample.
  HWY_INLINE N next_accepted(Mask accepted, Mask stepped) {
    const N t_max = lanes_.get(kTMax), backoff_count = lanes_.get(kBackoffCount);
    misses_ = accepted & (max(t_, t_ + free_length_) >= t_max);
    const Mask falls = stepped & (g_ < last_g_), near = falls & (g_ < band_);
    const Mask nearing = kConvex ? near | (falls & line_holds_) : near;
    const Mask waits = nearing & (backoff_count > k(0)) & (r_ > error_), tries = nearing & (!waits);
    rows_.put(kBackoffCount, select(waits, backoff_count - k(1), backoff_count));
    const N relaxed = max(free_length_, k(kReach) * r_ * rough_reciprocal(k(1) - rows_.get(kM)));
    // The step to where the line through the last two samples is well beyond the surface.
    const N overshoot = kConvex ? select(near, k(kOvershoot), k(kFarOvershoot)) : k(kOvershoot);
    const N beyond =
        (overshoot * g_ + k(kOvershootErrors) * error_) * (t_ - last_t_) * rough_reciprocal(last_g_ - g_);
    const N longest = k(kLongestCrossing) * max_gap_;
    const N crossing = min(beyond, kConvex ? select(line_holds_, max(line_length_, longest), longest) : longest);
    const N z = select(tries, max(relaxed, crossing), relaxed);
    phase_ =
        select(accepted, select(tries & (beyond > relaxed), code(LanePhase::Cross), code(LanePhase::Walk)), phase_);
    // Far from the origin, or where large numbers cancel, d_f exceeds any step that may be taken unseen. Double then
    // decides what happens near the surface.
    const Mask coarse = near & (error_ > k(kCoarse) * field_band_);
    undecided_ = accepted & ((evaluations_ >= k(kBudget)) | is_stuck(t_, z) | coarse);
    return min(t_ + z, t_max);
  }

  // Returns the t of the plain step from the last accepted sample.
  HWY_INLINE N next_rejected(Mask failed, Mask from_crossing, Mask again) {
    const N backoff = lanes_.get(kBackoff);
    const Mask near = from_crossing & (last_g_ < band_), grazes = near & (backoff > k(kMaxBackoff));
    rows_.put(kBackoffCount, select(near, backoff, select(from_crossing, k(kFarBackoff), rows_.get(kBackoffCount))));
    rows_.put(kBackoff, select(near, backoff + backoff, backoff));
    undecided_ = undecided_ | grazes | again | (failed & is_stuck(last_t_, last_r_));
    return last_t_ + last_r_;
  }

  // Handles a lane that starts beyond the surface it should have left. A look ahead tells if the lane comes out or
  // goes in.
  HWY_INLINE void begin_inside(Mask inside, N phase) {
    const Mask starting = inside & (phase == code(LanePhase::Start)), emerging = inside & (!starting);
    const Mask coarse = error_ > k(kCoarse) * field_band_;
    const Mask shallow = -g_ < error_;
    undecided_ = undecided_ | (shallow & (emerging | (starting & coarse)));
    phase_ = select(starting, code(LanePhase::Emerge), phase_);
    hits_ = hits_ | (emerging & (!shallow));
    rows_.put(kRoot, emerging, k(0));
    rows_.put(kWidth, emerging, t_);
    next_ = select(inside, k(4) * (k(16) * error_ - g_) * inv_lipschitz_, next_);
  }

  // Shrinks the bracket [t_lo, t_hi] to the sample, and chooses the next sample by the secant. The bracket of a lane
  // that has just crossed begins at the last accepted sample.
  HWY_INLINE void refine(Mask bracketed, Mask lower, Mask crossed) {
    const N half = k(0.5), last_g_lo = lanes_.get(kGLo);
    const N lo = select(lower, t_, lanes_.get(kTLo)), hi = select(lower, lanes_.get(kTHi), t_);
    const N g_lo = select(lower, g_, select(crossed, last_g_lo, half * last_g_lo));
    const N g_hi = select(lower, half * lanes_.get(kGHi), g_);
    const N width = hi - lo, done = resolution_ * hi, aside = half * done;
    // The secant stays next to an end that is 0, where the root may be. If the sample next to that end is 0, too,
    // e.g. because t is so small that many t give one point, the secant would creep along all these t: bisect
    // instead.
    const Mask creeps = (!lower) & (!crossed) & (g_ == k(0)) & (lanes_.get(kGHi) == k(0));
    const N share = select(creeps, half, g_lo / (g_lo - g_hi));
    const N next = min(max(lo + share * width, lo + aside), hi - aside);

    // A small value before the surface counts as the root, and is at worst a touch. A small value behind the surface,
    // or 0, does not, because two solids may meet there.
    const Mask root = lower & (g_ <= k(kRootError) * error_);
    const Mask found = bracketed & (root | (width <= done) | (next <= lo) | (next >= hi));
    // The root of a function that is nearly level has an uncertainty of d_f divided by the slope.
    const N fall = select(crossed, last_g_ - g_, lanes_.get(kFall)), span = select(crossed, width, lanes_.get(kSpan));
    const N slack = k(kTypicalError) * error_ * span;
    const Mask vague =
        found & (slack > max(k(kTolerance) * (lanes_.get(kBefore) + t_), k(kBandShare) * field_band_) * fall);
    const Mask known = found & (!vague);
    undecided_ = undecided_ | vague;
    hits_ = hits_ | known;

    rows_.put(kTLo, bracketed, lo);
    rows_.put(kTHi, bracketed, hi);
    rows_.put(kGLo, bracketed, g_lo);
    rows_.put(kGHi, bracketed, g_hi);
    rows_.put(kSpan, bracketed, span);
    rows_.put(kFall, bracketed, fall);
    const N best = select(root, t_, select(g_lo < -g_hi, lo, hi));
    rows_.put(kRoot, known, best);
    rows_.put(kWidth, known, select(root, done, width));
    next_ = select(bracketed, next, next_);
  }

  HWY_INLINE Mask finish(N f) {
    lanes_.put(kEvaluations, evaluations_);
    lanes_.put(kPhase, phase_);
    rows_.store(lanes_);
    const Mask finite = abs(f) < k(std::numeric_limits<double>::infinity());
    N verdict = select(undecided_, code(LaneVerdict::Certify), code(LaneVerdict::Active));
    verdict = select(misses_, code(LaneVerdict::Miss), select(hits_, code(LaneVerdict::Hit), verdict));
    // An invalid lane stays at its sample.
    return lanes_.finish(select(finite, next_, t_), select(finite, verdict, code(LaneVerdict::Invalid)));
  }

  LaneView<N, Lanes<S>> lanes_;
  const N inv_lipschitz_, field_band_, resolution_;
  N error_, g_, r_, t_;         // the sample's d_f, g, safe radius and t
  N last_t_, last_g_, last_r_;  // the last accepted sample's, of lanes that walk
  N band_, max_gap_, evaluations_;
  Mask line_holds_;              // kConvex only: the line through both samples holds
  N line_length_, free_length_;  // length over which the line holds; length that is free
  N phase_, next_;               // values that finish() stores
  SharedRows<N> rows_;
  Mask undecided_, misses_, hits_ = number<N>(0) > number<N>(0);
};

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
