// The baseline methods of following rays, for comparison (method.h). A hit is where the field falls below epsilon,
// and a ray that takes too many evaluations is given up. For a register of lanes at once.
#if defined(FATHOM_RUNTIME_SPHERE_TRACING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_RUNTIME_SPHERE_TRACING_INL
#undef FATHOM_RUNTIME_SPHERE_TRACING_INL
#else
#define FATHOM_RUNTIME_SPHERE_TRACING_INL
#endif

#include "runtime/march/lane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

// A rule for steps: next() returns the length of the next step, given the safe radius r. PlainStep is sphere tracing.
struct PlainStep {
  static constexpr bool kRelaxed = false;
  template <class View, class N, class Mask>
  static HWY_INLINE N next(View&, Mask, N r, N, N) {
    return r;
  }
  template <class View, class Mask>
  static HWY_INLINE void retreat(View&, Mask) {}
};

// Keinert et al., "Enhanced Sphere Tracing", 2014: after a step that was too long, the ray continues with plain
// steps.
struct FixedStep {
  static constexpr bool kRelaxed = true;
  template <class View, class N, class Mask>
  static HWY_INLINE N next(View& a, Mask, N r, N, N relaxation) {
    return select(a.get(kOverstepped) > number<N>(1), r, relaxation * r);
  }
  template <class View, class Mask>
  static HWY_INLINE void retreat(View& a, Mask failed) {
    a.put(kOverstepped, failed, a.get(kOverstepped) + a.get(kOverstepped));
  }
};

// Ban and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023.
struct AutomaticStep {
  static constexpr bool kRelaxed = true;
  template <class View, class N, class Mask>
  static HWY_INLINE N next(View& a, Mask accepted, N r, N z, N) {
    const Mask learns = accepted & (z > number<N>(0));
    const N slope = (r - a.get(kR)) / select(learns, z, number<N>(1));
    const N m = number<N>(0.7) * a.get(kM) + number<N>(0.3) * slope;
    a.put(kM, learns, min(m, number<N>(0.9)));
    return number<N>(2) * r / (number<N>(1) - a.get(kM));
  }
  template <class View, class Mask>
  static HWY_INLINE void retreat(View& a, Mask failed) {
    a.put(kM, failed, number<decltype(a.get(kM))>(-1));
  }
};

template <class Step, class N, class S>
HWY_INLINE MaskOf<N> trace(Lanes<S>& lanes, std::size_t first, const LaneRules<S>& rules, N f) {
  using Mask = MaskOf<N>;
  LaneView<N, Lanes<S>> a(lanes, first);
  const N zero = number<N>(0), evaluations = a.get(kEvaluations) + number<N>(1);
  a.put(kEvaluations, evaluations);
  const N known = a.get(kSide), side = select(known == zero, select(f < zero, number<N>(-1), number<N>(1)), known);
  a.put(kSide, side);
  const N g = side * f, r = g * N::broadcast(rules.inv_lipschitz), t = a.get(kTNext), z = t - a.get(kT);

  Mask accepted = zero == zero;
  if constexpr (Step::kRelaxed) {
    // If the balls of this sample and the last one leave a gap, or if this sample is behind the surface, the lane
    // goes back to the end of the last ball. The lane accepts the sample there in any case.
    const Mask retreating = a.get(kPhase) == code<N>(LanePhase::Retreat);
    accepted = retreating | (z <= a.get(kR) + r);
    a.put(kPhase, select(accepted, code<N>(LanePhase::Walk), code<N>(LanePhase::Retreat)));
    Step::retreat(a, !accepted);
  }
  const Mask hits = accepted & (g < N::broadcast(rules.epsilon)), ends = accepted & (t >= a.get(kTMax));
  const Mask finite = abs(f) < number<N>(std::numeric_limits<double>::infinity());
  N verdict = select(evaluations >= N::broadcast(rules.steps), code<N>(LaneVerdict::OutOfSteps), zero);
  verdict = select(hits, code<N>(LaneVerdict::Hit), select(ends, code<N>(LaneVerdict::Miss), verdict));

  const N step = Step::next(a, accepted, r, z, N::broadcast(rules.relaxation));
  const N next = min(select(accepted, t + step, a.get(kT) + a.get(kR)), a.get(kTMax));
  a.put(kT, accepted, t);
  a.put(kR, accepted, r);
  return a.finish(select(finite, next, t), select(finite, verdict, code<N>(LaneVerdict::Invalid)));
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
