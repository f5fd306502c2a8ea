// Gradient noise of Interval, Along and Slope: ranges of the noise and its derivatives while its operands range over
// a box.
//
// Within a cell of the lattice the corners' directions are known, and the noise is a polynomial. A box that spans at
// most two cells along each axis gets the hull over its cells. Any larger box gets the bounds that hold for any hash
// (vm/number/noise_bounds.h). Tested by: tests/vm/number/noise_test.cpp
#if defined(FATHOM_VM_NOISE_RANGE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_NOISE_RANGE_INL
#undef FATHOM_VM_NOISE_RANGE_INL
#else
#define FATHOM_VM_NOISE_RANGE_INL
#endif

#include <array>

#include "vm/number/along-inl.h"
#include "vm/number/noise-inl.h"
#include "vm/number/slope-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

struct NoiseRange {
  Interval v;
  std::array<Interval, 3> d;  // derivatives along x, y and z
  double steepest;            // bound on the gradient's length
};
using NoiseBox = std::array<Interval, 3>;

// Returns a bound on the gradient's length over the box, from the coordinates' maximum distances to an integer.
inline double steepest_noise(const NoiseBox& box) {
  double steepest = kNoiseSlope;
  for (const Interval& at : box) {
    const double whole = round_nearest(Real{at.lo}).v;
    const double off = magnitude(at - Interval{whole, whole});
    if (off < 0.5) steepest = std::min(steepest, noise_slope(off));
  }
  return steepest;
}
// Returns the bounds that hold over the box for any hash.
inline NoiseRange any_noise(const NoiseBox& box) {
  const double steepest = steepest_noise(box);
  const Interval slope{-steepest, steepest};
  return {{-kNoiseRange, kNoiseRange}, {slope, slope, slope}, steepest};
}

// Range of a + (b - a) t for t in [0, 1]; the tightest possible for independent operands.
inline Interval mix_ranges(Interval a, Interval b, Interval t) {
  const auto at = [](double from, double to, double part) { return from + (to - from) * part; };
  return outward(std::min(at(a.lo, b.lo, t.lo), at(a.lo, b.lo, t.hi)),
                 std::max(at(a.hi, b.hi, t.lo), at(a.hi, b.hi, t.hi)));
}

// Noise over a box within one cell of the lattice.
class NoiseCell {
 public:
  // `corner`: lowest corner of the cell; `box`: within the closed cell.
  NoiseCell(const std::array<double, 3>& corner, const NoiseBox& box) {
    Real hashes[8];
    noise_corners(Real{corner[0]}, Real{corner[1]}, Real{corner[2]}, hashes);
    const Real zero{0}, one{1};
    for (std::size_t c = 0; c < 8; ++c) {
      g_[c] = {edge_dot(hashes[c], one, zero, zero).v, edge_dot(hashes[c], zero, one, zero).v,
               edge_dot(hashes[c], zero, zero, one).v};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      at_[i] = intersect(box[i] - Interval{corner[i], corner[i]}, 0, 1);
      fade_[i] = fade_range(at_[i]);
      slope_[i] = slope_range(at_[i]);
    }
  }

  NoiseRange range() const {
    NoiseRange result{value(), {derivative(0), derivative(1), derivative(2)}, kNoiseSlope};
    // Mean value form: the value at the box's middle plus derivatives times offsets; far tighter for small boxes.
    std::array<Interval, 3> middle;
    Interval moved{0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      const double m = (at_[i].lo + at_[i].hi) / 2;
      middle[i] = {m, m};
      moved = moved + result.d[i] * (at_[i] - middle[i]);
    }
    const Interval near =
        value(middle, {fade_range(middle[0]), fade_range(middle[1]), fade_range(middle[2])}) + moved;
    result.v = {std::max(result.v.lo, near.lo), std::min(result.v.hi, near.hi)};
    return result;
  }

 private:
  static constexpr double kSlack = 1e-14;  // far above the rounding error of the polynomials within a cell
  static constexpr std::size_t kBit[] = {1, 2, 4};

  // Product of a finite range and s = 1, 2, -1 or -2, which is exact.
  static Interval times(double s, Interval t) {
    return s > 0 ? Interval{s * t.lo, s * t.hi} : Interval{s * t.hi, s * t.lo};
  }

  static Interval fade_range(Interval t) {
    return intersect({noise_fade(Real{t.lo}).v - kSlack, noise_fade(Real{t.hi}).v + kSlack}, 0, 1);
  }
  static Interval slope_range(Interval t) {
    const double a = noise_fade_slope(Real{t.lo}).v, b = noise_fade_slope(Real{t.hi}).v;
    return {std::max(0.0, std::min(a, b) - kSlack), contains(t, 0.5) ? 1.875 : std::max(a, b) + kSlack};
  }

  // Range of dot(direction of corner c, `at` - corner c).
  Interval plane(std::size_t c, const std::array<Interval, 3>& at) const {
    Interval sum{0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      if (g_[c][i] == 0) continue;
      const double from = c & kBit[i] ? 1 : 0;
      sum = sum + times(g_[c][i], at[i] - Interval{from, from});
    }
    return sum;
  }
  Interval value() const { return value(at_, fade_); }
  Interval value(const std::array<Interval, 3>& at, const std::array<Interval, 3>& fade) const {
    Interval edges[4];
    for (std::size_t e = 0; e < 4; ++e) edges[e] = mix_ranges(plane(2 * e, at), plane(2 * e + 1, at), fade[0]);
    return mix_ranges(mix_ranges(edges[0], edges[1], fade[1]), mix_ranges(edges[2], edges[3], fade[1]), fade[2]);
  }

  // Range of the derivative along axis i, interpolated over the four cell edges parallel to that axis: the fade's
  // slope times the difference of the planes of the edge's ends, plus the planes' own slopes.
  Interval derivative(std::size_t i) const {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const auto edge = [&](std::size_t c) {
      const std::size_t d = c | kBit[i];
      Interval difference{-g_[d][i], -g_[d][i]};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double from = axis != i && c & kBit[axis] ? 1 : 0, turn = g_[d][axis] - g_[c][axis];
        if (turn != 0) difference = difference + times(turn, at_[axis] - Interval{from, from});
      }
      return slope_[i] * difference + mix_ranges({g_[c][i], g_[c][i]}, {g_[d][i], g_[d][i]}, fade_[i]);
    };
    const Interval low = mix_ranges(edge(0), edge(kBit[j]), fade_[j]);
    const Interval high = mix_ranges(edge(kBit[k]), edge(kBit[j] | kBit[k]), fade_[j]);
    return mix_ranges(low, high, fade_[k]);
  }

  std::array<std::array<double, 3>, 8> g_;  // [corner] direction
  std::array<Interval, 3> at_, fade_, slope_;
};

inline NoiseRange noise_range(const NoiseBox& box) {
  std::array<double, 3> first;
  std::array<int, 3> more;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(magnitude(box[i]) < kNoiseReach)) return any_noise(box);
    first[i] = std::floor(box[i].lo);
    const double cells = std::max(1.0, std::ceil(box[i].hi) - first[i]);
    if (cells > 2) return any_noise(box);
    more[i] = cells > 1 ? 1 : 0;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Interval none{kInfinity, -kInfinity};
  NoiseRange all{none, {none, none, none}, steepest_noise(box)};
  for (int n = 0; n < 8; ++n) {
    const std::array<int, 3> step = {n & 1, n >> 1 & 1, n >> 2};
    if (step[0] > more[0] || step[1] > more[1] || step[2] > more[2]) continue;
    std::array<double, 3> corner;
    NoiseBox part;
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = first[i] + step[i];
      part[i] = {std::max(box[i].lo, corner[i]), std::min(box[i].hi, corner[i] + 1)};
    }
    const NoiseRange range = NoiseCell(corner, part).range();
    all.v = hull(all.v, range.v);
    for (std::size_t i = 0; i < 3; ++i) all.d[i] = hull(all.d[i], range.d[i]);
  }
  all.v = intersect(all.v, -kNoiseRange, kNoiseRange);
  for (Interval& d : all.d) d = intersect(d, -all.steepest, all.steepest);
  all.steepest = std::min(all.steepest, length(all.d[0], all.d[1], all.d[2]).hi);
  return all;
}

inline Interval noise(Interval x, Interval y, Interval z) { return noise_range({x, y, z}).v; }

inline Along noise(const Along& x, const Along& y, const Along& z) {
  const NoiseRange n = noise_range({x.v, y.v, z.v});
  const double speed = times(n.steepest, length(x.d, y.d, z.d).hi);
  return {n.v, intersect(n.d[0] * x.d + n.d[1] * y.d + n.d[2] * z.d, -speed, speed)};
}

// The gradient is J^T times the noise's gradient, where J are the operands' derivatives. So its length is at most the
// length of the noise's gradient times J's largest singular value.
inline Slope noise(const Slope& x, const Slope& y, const Slope& z) {
  const NoiseRange n = noise_range({x.v, y.v, z.v});
  const auto along = [&](Interval by_x, Interval by_y, Interval by_z) {
    return n.d[0] * by_x + n.d[1] * by_y + n.d[2] * by_z;
  };
  const double stretch = gram_norm((sqr(x) + sqr(y) + sqr(z)).squares.g);
  const double carried =
      kNoiseSlope * std::sqrt(x.error() * x.error() + y.error() * y.error() + z.error() * z.error());
  const double error = carried < kUnbounded ? std::min(carried, 2 * kNoiseRange / kUnit) + kNoiseUnits : kUnbounded;
  return make_slope(n.v, along(x.dx, y.dx, z.dx), along(x.dy, y.dy, z.dy), along(x.dz, y.dz, z.dz),
                    times(n.steepest, stretch), error);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
