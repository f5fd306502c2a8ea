// The evaluators in double of one point, its gradient and surface, or a box. Slopes are in vm/range/slope.cpp.
#include <cmath>
#include <cstdint>
#include <vector>

#include "vm/interpret/evaluate.h"
#include "vm/interpret/interpret-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Numbers each execution of a tag: the surface times kTags, plus the number of tags executed before. So the winning
// tag can be identified, and ties are decided by the surface first, as in all evaluators.
template <>
struct TagObserver<Tagged<Real>> {
  // More than a verified program has instructions. The number is exact in a double: 28 bits and a surface's 24.
  static constexpr double kTags = 0x1p28;
  std::vector<glm::dvec3> seen;
  double see(std::uint32_t surface, const Vec3<Real>& p) {
    seen.emplace_back(p.x.v, p.y.v, p.z.v);
    return surface * kTags + static_cast<double>(seen.size() - 1);
  }
};

namespace {

template <class T, class P>
T run_once(const Code& program, const Vec3<P>& point, Workspace& workspace) {
  Interpreter<T> machine(program, workspace, 1);
  *machine.first_point() = point;
  machine.interpret();
  return *machine.result();
}

double distance(const Code& program, glm::dvec3 p, Workspace& workspace) {
  return run_once<Real>(program, Vec3<Real>{{p.x}, {p.y}, {p.z}}, workspace).v;
}

SurfaceValue surface(const Code& program, glm::dvec3 p, Workspace& workspace) {
  using D = Dual<Real>;
  const Real zero{0}, one{1};
  const Vec3<D> point{{{p.x}, one, zero, zero}, {{p.y}, zero, one, zero}, {{p.z}, zero, zero, one}};
  const auto result = run_once<Tagged<Convex<D>>>(program, point, workspace);
  const D& d = result.v.v;
  const auto finite_or_zero = [](Real a) { return std::isfinite(a.v) ? a.v : 0; };
  return {d.v.v,
          {finite_or_zero(d.dx), finite_or_zero(d.dy), finite_or_zero(d.dz)},
          result.surface.v < 0 ? 0 : static_cast<std::uint32_t>(result.surface.v),
          result.v.convex.v};
}

SurfacePlace place(const Code& program, glm::dvec3 p, Workspace& workspace) {
  using T = Tagged<Real>;
  Interpreter<T> machine(program, workspace, 1);
  *machine.first_point() = Vec3<Real>{{p.x}, {p.y}, {p.z}};
  machine.interpret();
  const double tag = machine.result()->surface.v;
  if (tag < 0) return {0, p};
  const double surface = std::floor(tag / TagObserver<T>::kTags);
  const auto number = static_cast<std::size_t>(tag - surface * TagObserver<T>::kTags);
  return {static_cast<std::uint32_t>(surface), machine.tags().seen[number]};
}

Range range(const Code& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace) {
  const auto coordinate = [&](int axis) { return Along{{lo[axis], hi[axis]}, {0, 0}}; };
  const Along result = run_once<Along>(program, Vec3<Along>{coordinate(0), coordinate(1), coordinate(2)}, workspace);
  return {result.v.lo, result.v.hi};
}

AlongLine along(const Code& program, glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                Workspace& workspace) {
  const auto coordinate = [&](int axis) {
    const double a = origin[axis] + begin * direction[axis], b = origin[axis] + end * direction[axis];
    // Widened by far more than the rounding error of the end points.
    const double slack = 0x1p-48 * (std::fabs(a) + std::fabs(b));
    return Along{{std::min(a, b) - slack, std::max(a, b) + slack}, {direction[axis], direction[axis]}};
  };
  const Along result = run_once<Along>(program, Vec3<Along>{coordinate(0), coordinate(1), coordinate(2)}, workspace);
  return {{result.v.lo, result.v.hi}, {result.d.lo, result.d.hi}};
}

}  // namespace
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace fathom::vm {

double evaluate_distance(const Code& program, glm::dvec3 point, Workspace& workspace) {
  return HWY_NAMESPACE::distance(program, point, workspace);
}

SurfaceValue evaluate_surface(const Code& program, glm::dvec3 point, Workspace& workspace) {
  return HWY_NAMESPACE::surface(program, point, workspace);
}

SurfacePlace evaluate_place(const Code& program, glm::dvec3 point, Workspace& workspace) {
  return HWY_NAMESPACE::place(program, point, workspace);
}

Range evaluate_range(const Code& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace) {
  return HWY_NAMESPACE::range(program, lo, hi, workspace);
}

AlongLine evaluate_along(const Code& program, glm::dvec3 origin, glm::dvec3 direction, double begin,
                         double end, Workspace& workspace) {
  return HWY_NAMESPACE::along(program, origin, direction, begin, end, workspace);
}

}  // namespace fathom::vm
