#include "vm/range/slope.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vm/interpret/interpret-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Returns a float below `value`, by at least 2^-22 of `value`. Widths of blends are double here and f32 in
// vm/prune/resolve_choices.h. The margins of both operands outweigh the rounding of the width, so operands that
// resolve_pairs() finds too far apart to blend do not blend in double either.
inline float below(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max(), kShare = 0x1p-22, kLeast = 0x1p-126;
  const double lower = value - (std::fabs(value) * kShare + kLeast);
  if (!(lower >= -kLargest)) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(std::min(lower, kLargest));
}

template <>
struct ChoiceObserver<Slope> {
  ChoiceRange* range = nullptr;  // null if the ranges are not wanted

  void see(std::size_t, const Slope& a, const Slope& b) {
    if (range == nullptr) return;
    const Interval of_a = seen(a), of_b = seen(b);
    *range = {below(of_a.lo), -below(-of_a.hi), below(of_b.lo), -below(-of_b.hi)};
  }
  void next() {
    if (range != nullptr) ++range;
  }
};

namespace {

Slope coordinate(double lo, double hi, int axis) {
  const Interval zero{0, 0}, one{1, 1};
  Slope s = make_slope({lo, hi}, axis == 0 ? one : zero, axis == 1 ? one : zero, axis == 2 ? one : zero, 1, 0);
  s.norm = 1;
  s.nonnegative = lo >= 0;
  return s;
}

SlopeBound slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, ChoiceRange* choices, Workspace& workspace) {
  Interpreter<Slope> machine(program, workspace, 1);
  machine.observer().range = choices;
  *machine.first_point() = {coordinate(lo.x, hi.x, 0), coordinate(lo.y, hi.y, 1), coordinate(lo.z, hi.z, 2)};
  machine.interpret();
  const Slope& result = *machine.result();
  return {{result.v.lo, result.v.hi}, result.norm, result.error() * kUnit};
}

}  // namespace
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace fathom::vm {

SlopeBound evaluate_slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace) {
  return HWY_NAMESPACE::slope(program, lo, hi, nullptr, workspace);
}

SlopeBound enclose_slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, std::vector<ChoiceRange>& choices,
                         Workspace& workspace) {
  choices.resize(program.choices);
  return HWY_NAMESPACE::slope(program, lo, hi, choices.data(), workspace);
}

}  // namespace fathom::vm
