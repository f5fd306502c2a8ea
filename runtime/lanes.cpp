// The lanes' two ways on, compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "runtime/tiered-inl.h"
#include "runtime/traced-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

template <class N, class S>
void tiered(Lanes<S>& lanes, std::size_t count, const S* f, const LaneRules<S>& rules) {
  constexpr std::size_t kStep = sizeof(N) / sizeof(S);
  for (std::size_t i = 0; i < count; i += kStep) {
    Tiered<N, S> step(lanes, i, rules);
    step.run(load(f + i, static_cast<N*>(nullptr)), rules);
  }
}

template <class Step, class N, class S>
void traced(Lanes<S>& lanes, std::size_t count, const S* f, const LaneRules<S>& rules) {
  constexpr std::size_t kStep = sizeof(N) / sizeof(S);
  for (std::size_t i = 0; i < count; i += kStep)
    trace<Step, N>(lanes, i, rules, load(f + i, static_cast<N*>(nullptr)));
}

template <class N, class S>
void advance(Lanes<S>& lanes, std::size_t count, const S* f, const LaneRules<S>& rules) {
  switch (rules.method) {
    case Method::Sphere:
      return traced<PlainStep, N>(lanes, count, f, rules);
    case Method::Relaxed:
      return traced<FixedStep, N>(lanes, count, f, rules);
    case Method::Automatic:
      return traced<AutomaticStep, N>(lanes, count, f, rules);
    default:
      return tiered<N>(lanes, count, f, rules);
  }
}

void advance_f32(Lanes<float>& lanes, std::size_t count, const float* f, const LaneRules<float>& rules) {
  advance<Batch>(lanes, count, f, rules);
}
void advance_f64(Lanes<double>& lanes, std::size_t count, const double* f, const LaneRules<double>& rules) {
  advance<Real>(lanes, count, f, rules);
}
std::size_t batch_lanes() { return sizeof(Batch) / sizeof(float); }

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(advance_f32);
HWY_EXPORT(batch_lanes);

std::size_t register_lanes() { return HWY_DYNAMIC_DISPATCH(batch_lanes)(); }

void advance(Lanes<float>& lanes, std::size_t count, const float* f, const LaneRules<float>& rules) {
  HWY_DYNAMIC_DISPATCH(advance_f32)(lanes, count, f, rules);
}
void advance(Lanes<double>& lanes, std::size_t count, const double* f, const LaneRules<double>& rules) {
  HWY_STATIC_DISPATCH(advance_f64)(lanes, count, f, rules);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
