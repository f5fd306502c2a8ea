// The advance of lanes by either kind of method, compiled once for each instruction set and chosen at run time
// (Highway's foreach_target).
#include "runtime/march/lanes.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/march/lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "runtime/march/sphere_tracing-inl.h"
#include "runtime/march/tiered-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

// Advances one register of lanes after another. move(i) advances the register whose first lane is i, and returns the
// lanes that have ended.
template <class N, class S, class Move>
HWY_INLINE std::size_t for_each_register(std::size_t count, LaneNumbers& ended, const Move& move) {
  constexpr std::size_t kStep = sizeof(N) / sizeof(S);
  // One bit per lane, and one loop over the bits at the end, whose length the processor mispredicts once.
  std::uint64_t bits[Lanes<S>::kCapacity / 64] = {};
  for (std::size_t i = 0; i < count; i += kStep) bits[i / 64] |= std::uint64_t{lanes_of(move(i))} << i % 64;
  std::size_t total = 0;
  for (std::size_t word = 0; word * 64 < count; ++word) {
    for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
      const std::size_t lane = word * 64 + static_cast<std::size_t>(std::countr_zero(left));
      if (lane < count) ended[total++] = static_cast<std::uint16_t>(lane);
    }
  }
  return total;
}

template <class N, class S>
HWY_INLINE N load_number(const S* from) {
  return load(from, static_cast<N*>(nullptr));
}

template <class N, bool kConvex, class S>
std::size_t tiered(Lanes<S>& lanes, std::size_t count, FieldSamples<S> at, const LaneRules<S>& rules,
                   LaneNumbers& ended) {
  return for_each_register<N, S>(count, ended, [&](std::size_t i) HWY_ATTR {
    Tiered<N, S, kConvex> step(lanes, i, rules);
    return step.run(load_number<N>(at.f + i), load_number<N>((kConvex ? at.convexity : at.f) + i), rules);
  });
}

template <class Step, class N, class S>
std::size_t traced(Lanes<S>& lanes, std::size_t count, FieldSamples<S> at, const LaneRules<S>& rules,
                   LaneNumbers& ended) {
  return for_each_register<N, S>(count, ended, [&](std::size_t i) HWY_ATTR {
    return trace<Step, N>(lanes, i, rules, load_number<N>(at.f + i));
  });
}

template <class N, class S>
std::size_t advance(Lanes<S>& lanes, std::size_t count, FieldSamples<S> at, const LaneRules<S>& rules,
                    LaneNumbers& ended) {
  switch (rules.method) {
    case Method::Sphere:
      return traced<PlainStep, N>(lanes, count, at, rules, ended);
    case Method::Relaxed:
      return traced<FixedStep, N>(lanes, count, at, rules, ended);
    case Method::Automatic:
      return traced<AutomaticStep, N>(lanes, count, at, rules, ended);
    default:
      return at.convexity != nullptr ? tiered<N, true>(lanes, count, at, rules, ended)
                                     : tiered<N, false>(lanes, count, at, rules, ended);
  }
}

std::size_t advance_f32(Lanes<float>& lanes, std::size_t count, FieldSamples<float> at, const LaneRules<float>& rules,
                        LaneNumbers& ended) {
  return advance<Batch>(lanes, count, at, rules, ended);
}
std::size_t advance_f64(Lanes<double>& lanes, std::size_t count, FieldSamples<double> at,
                        const LaneRules<double>& rules, LaneNumbers& ended) {
  return advance<Real>(lanes, count, at, rules, ended);
}
std::size_t batch_lanes() { return sizeof(Batch) / sizeof(float); }

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(advance_f32);
HWY_EXPORT(batch_lanes);

std::size_t register_lanes() { return HWY_DYNAMIC_DISPATCH(batch_lanes)(); }

std::size_t advance(Lanes<float>& lanes, std::size_t count, FieldSamples<float> at, const LaneRules<float>& rules,
                    LaneNumbers& ended) {
  return HWY_DYNAMIC_DISPATCH(advance_f32)(lanes, count, at, rules, ended);
}
std::size_t advance(Lanes<double>& lanes, std::size_t count, FieldSamples<double> at, const LaneRules<double>& rules,
                    LaneNumbers& ended) {
  return HWY_STATIC_DISPATCH(advance_f64)(lanes, count, at, rules, ended);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
