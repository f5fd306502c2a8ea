// The evaluator of the surfaces' shares in a point, where blends mix surfaces: one point, in double.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "vm/interpret/evaluate.h"
#include "vm/interpret/interpret-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Surface of a shape until a tag assigns one.
constexpr std::uint32_t kUnclaimed = std::numeric_limits<std::uint32_t>::max();

// A number and its growth per inward movement of each surface it was made from, a derivative, of which only the
// largest are kept. In a Placed number, `surface` is the index of a tag in order of execution.
enum class Shares { Plain, Placed };
template <Shares kShares>
struct Shared {
  using Constant = Real;
  Real v;
  SurfaceShares shares;
};

// Adds the shares of `from` times `scale` to `to`. If `to` is full, a larger share replaces the smallest.
void add_shares(SurfaceShares& to, const SurfaceShares& from, double scale) {
  for (int i = 0; i < from.count; ++i) {
    const SurfaceShare share{from.all[i].surface, from.all[i].weight * scale};
    if (!(share.weight > 0)) continue;
    const auto end = to.all.begin() + to.count;
    const auto same =
        std::find_if(to.all.begin(), end, [&](const SurfaceShare& s) { return s.surface == share.surface; });
    if (same != end) {
      same->weight += share.weight;
    } else if (to.count < SurfaceShares::kMost) {
      to.all[to.count++] = share;
    } else {
      const auto least = std::min_element(to.all.begin(), end, [](const SurfaceShare& a, const SurfaceShare& b) {
        return a.weight < b.weight || (a.weight == b.weight && a.surface > b.surface);
      });
      if (least->weight < share.weight) *least = share;
    }
  }
}

template <Shares kShares>
struct ValueTraits<Shared<kShares>> {
  using Shared = HWY_NAMESPACE::Shared<kShares>;
  using Point = Real;
  using D = Dual<Real>;
  static constexpr bool kConvex = false;
  static HWY_INLINE Shared lift(const Point& value, bool = false) {
    return {value, {{SurfaceShare{kUnclaimed, 1}}, 1}};
  }
  template <class Op>
  static HWY_INLINE Shared apply(const Shared& a, const Real* k) {
    return {Op::template apply<Real>(a.v, k), a.shares};
  }
  // An operation on several numbers scales each operand's shares by the derivative with respect to that operand.
  template <class Op>
  static HWY_INLINE Shared apply(const Shared& a, const Shared& b, const Real* k) {
    const Real zero{0}, one{1};
    const D result = Op::template apply<D>(D{a.v, one, zero, zero}, D{b.v, zero, one, zero}, k);
    Shared out{result.v, {}};
    add_shares(out.shares, a.shares, std::fabs(result.dx.v));
    add_shares(out.shares, b.shares, std::fabs(result.dy.v));
    return out;
  }
  template <class Op>
  static HWY_INLINE Shared apply(const Shared& a, const Shared& b, const Shared& c) {
    const Real zero{0}, one{1};
    const D result = Op::template apply<D>(D{a.v, one, zero, zero}, D{b.v, zero, one, zero}, D{c.v, zero, zero, one});
    Shared out{result.v, {}};
    add_shares(out.shares, a.shares, std::fabs(result.dx.v));
    add_shares(out.shares, b.shares, std::fabs(result.dy.v));
    add_shares(out.shares, c.shares, std::fabs(result.dz.v));
    return out;
  }
  static HWY_INLINE void tag(Shared& value, std::uint32_t surface) {
    SurfaceShares claimed;
    for (int i = 0; i < value.shares.count; ++i) {
      SurfaceShare share = value.shares.all[i];
      if (share.surface == kUnclaimed) share.surface = surface;
      add_shares(claimed, {{share}, 1}, 1);
    }
    value.shares = claimed;
  }
};

// The min of a shape with kFusedMin.
template <Shares kShares>
HWY_INLINE Shared<kShares> min(const Shared<kShares>& a, const Shared<kShares>& b) {
  return ValueTraits<Shared<kShares>>::template apply<MinOp>(a, b, nullptr);
}

template <>
struct TagObserver<Shared<Shares::Placed>> {
  std::vector<SurfacePlace> seen;  // [number of the tag]
  std::uint32_t see(std::uint32_t surface, const Vec3<Real>& p) {
    seen.push_back({surface, {p.x.v, p.y.v, p.z.v}});
    return static_cast<std::uint32_t>(seen.size() - 1);
  }
};

namespace {

template <Shares kShares>
SurfaceShares shares(const Code& program, glm::dvec3 p, Workspace& workspace) {
  Interpreter<Shared<kShares>> machine(program, workspace, 1);
  *machine.first_point() = Vec3<Real>{{p.x}, {p.y}, {p.z}};
  machine.interpret();
  SurfaceShares result = machine.result()->shares;
  const auto unclaimed = [](const SurfaceShare& share) { return share.surface == kUnclaimed; };
  const auto end = std::remove_if(result.all.begin(), result.all.begin() + result.count, unclaimed);
  result.count = static_cast<int>(end - result.all.begin());
  double sum = 0;
  for (int i = 0; i < result.count; ++i) sum += result.all[i].weight;
  for (int i = 0; i < result.count; ++i) result.all[i].weight /= sum;
  if constexpr (kShares == Shares::Placed) {
    for (int i = 0; i < result.count; ++i) {
      const SurfacePlace& seen = machine.tags().seen[result.all[i].surface];
      result.all[i].surface = seen.surface, result.all[i].place = seen.place;
    }
  }
  return result;
}

}  // namespace
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace fathom::vm {

SurfaceShares evaluate_shares(const Code& program, glm::dvec3 point, Workspace& workspace) {
  return HWY_NAMESPACE::shares<HWY_NAMESPACE::Shares::Plain>(program, point, workspace);
}

SurfaceShares evaluate_placed_shares(const Code& program, glm::dvec3 point, Workspace& workspace) {
  return HWY_NAMESPACE::shares<HWY_NAMESPACE::Shares::Placed>(program, point, workspace);
}

}  // namespace fathom::vm
