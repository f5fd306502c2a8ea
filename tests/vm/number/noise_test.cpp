// Gradient noise: compared with its definition; a proof of its range and max slope; its bounds over boxes; its edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/judge/judge_noise.h"
#include "tests/support/scaled_cases.h"
#include "tests/vm/range/boxes.h"
#include "vm/number/noise_bounds.h"
#include "vm/number/real.h"
#include "vm/range/slope.h"

namespace fathom::test::noise_test {
namespace {

using glm::dvec3;
using vm::kNoiseRange;
using vm::kNoiseSlope;
using vm::Opcode;

vm::VerifiedProgram noise_program() { return formula({{Opcode::X}, {Opcode::Y}, {Opcode::Z}, {Opcode::Noise}}); }

// Points within `reach` of the origin. In every other point some coordinates are integers or the floats next to an
// integer.
Cloud noise_points(Random& random, double reach, std::size_t count) {
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    float p[3];
    for (float& x : p) {
      x = static_cast<float>(random.uniform(-reach, reach));
      if (i % 2 == 0 || !random.chance(0.5)) continue;
      x = std::round(x);
      if (random.chance(0.7)) x = std::nextafter(x, random.chance(0.5) ? 1e30f : -1e30f);
    }
    cloud.add(p[0], p[1], p[2]);
  }
  return cloud;
}

// Interval. The arithmetic does not round outwards: is_proved() keeps a margin of 1e-9 instead.
struct Bounds {
  double lo, hi;
};
Bounds operator+(Bounds a, Bounds b) { return {a.lo + b.lo, a.hi + b.hi}; }
Bounds operator*(Bounds a, Bounds b) {
  const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
  return {lo, hi};
}
double largest(Bounds a) { return std::max(std::abs(a.lo), std::abs(a.hi)); }

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double fade_slope(double t) { return 30 * t * t * (1 - t) * (1 - t); }

// Part of the octant of a cell next to the origin, and of the directions (1, a, b). All other octants and directions
// are mirror images, because the twelve gradients at corners are invariant under the symmetries of the cube.
struct Piece {
  std::array<Bounds, 3> at = {{{0, 0.5}, {0, 0.5}, {0, 0.5}}};
  Bounds a = {-1, 1}, b = {-1, 1};

  // Halves the piece along its longest side. Sides of the directions count a quarter, because they matter less.
  std::array<Piece, 2> halves(bool of_directions) const {
    std::array<Piece, 2> made = {*this, *this};
    const auto sides = [&](Piece& piece) {
      return std::array<Bounds*, 5>{&piece.at[0], &piece.at[1], &piece.at[2], &piece.a, &piece.b};
    };
    std::array<Bounds*, 5> lower = sides(made[0]), upper = sides(made[1]);
    std::size_t longest = 0;
    const auto length = [&](std::size_t i) { return (lower[i]->hi - lower[i]->lo) * (i < 3 ? 1 : 0.25); };
    for (std::size_t i = 1; i < (of_directions ? 5 : 3); ++i) longest = length(i) > length(longest) ? i : longest;
    lower[longest]->hi = upper[longest]->lo = (lower[longest]->lo + lower[longest]->hi) / 2;
    return made;
  }
};

struct AxisWeights {
  Bounds weight[2], slope[2], from[2];  // of the corners at 0 and 1
};
AxisWeights weights(Bounds t) {
  const Bounds w{fade(t.lo), fade(t.hi)}, s{fade_slope(t.lo), fade_slope(t.hi)};  // both increase up to 1/2
  return {{{1 - w.hi, 1 - w.lo}, w}, {{-s.hi, -s.lo}, s}, {t, {t.lo - 1, t.hi - 1}}};
}
// Max |g . v| over the twelve gradients g.
double most_of_directions(const Bounds (&v)[3]) {
  const double x = largest(v[0]), y = largest(v[1]), z = largest(v[2]);
  return x + y + z - std::min({x, y, z});
}

// Upper bound of the noise value on a piece, for the worst gradients. The value is then the sum over corners of
// weight times the two largest of |p - corner|. The bound is the value at the piece's centre plus what the
// derivatives can add on the way from there. The derivatives are summed over the corners first, because near a
// maximum most of the sum cancels.
double max_value(const Piece& piece) {
  const AxisWeights axes[3] = {weights(piece.at[0]), weights(piece.at[1]), weights(piece.at[2])};
  Bounds rises[3] = {{0, 0}, {0, 0}, {0, 0}};
  double middle = 0, half[3], middle_weights[3][2], middle_from[3][2];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double t = (piece.at[axis].lo + piece.at[axis].hi) / 2;
    half[axis] = piece.at[axis].hi - t;
    middle_weights[axis][0] = 1 - fade(t), middle_weights[axis][1] = fade(t);
    middle_from[axis][0] = t, middle_from[axis][1] = 1 - t;
  }
  for (int c = 0; c < 8; ++c) {
    const int at[3] = {c & 1, c >> 1 & 1, c >> 2};
    Bounds weight{1, 1}, size[3], parts[3];
    double here = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Bounds from = axes[axis].from[at[axis]];
      size[axis] = at[axis] == 0 ? from : Bounds{-from.hi, -from.lo};
      weight = weight * axes[axis].weight[at[axis]];
      here *= middle_weights[axis][at[axis]];
      const double off = middle_from[axis][at[axis]];
      parts[axis] = {off, off};
    }
    middle += here * most_of_directions(parts);
    const Bounds low[3] = {{0, size[0].lo}, {0, size[1].lo}, {0, size[2].lo}};
    const Bounds most{most_of_directions(low), most_of_directions(size)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
      const Bounds turn = axes[axis].slope[at[axis]] * (axes[j].weight[at[j]] * axes[k].weight[at[k]]);
      // `can`, `must`: 1 if this coordinate may be, or is certain to be, one of the two largest.
      const double can = size[axis].hi < size[j].lo && size[axis].hi < size[k].lo ? 0 : 1;
      const double must = size[axis].lo > std::min(size[j].hi, size[k].hi) ? 1 : 0;
      const Bounds rise = at[axis] == 0 ? Bounds{must, can} : Bounds{-can, -must};
      rises[axis] = rises[axis] + turn * most + weight * rise;
    }
  }
  return middle + half[0] * largest(rises[0]) + half[1] * largest(rises[1]) + half[2] * largest(rises[2]);
}

// Upper bound of the derivative along a direction on a piece. Along s the derivative is the sum over corners of g .
// ((s . grad w) (p - corner) + w s). Its maximum over g is convex in s, so over a square of directions it is largest
// in a corner of the square.
double max_slope(const Piece& piece) {
  const AxisWeights x = weights(piece.at[0]), y = weights(piece.at[1]), z = weights(piece.at[2]);
  double most = 0;
  for (int end = 0; end < 4; ++end) {
    const double by_a = end & 1 ? piece.a.hi : piece.a.lo, by_b = end & 2 ? piece.b.hi : piece.b.lo;
    const Bounds a{by_a, by_a}, b{by_b, by_b};
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
      const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
      const Bounds rest = y.weight[j] * z.weight[k], w = x.weight[i] * rest;
      const Bounds turn = a * (y.slope[j] * z.weight[k]) + b * (y.weight[j] * z.slope[k]);
      const Bounds slope = x.slope[i] * rest + x.weight[i] * turn;
      const Bounds v[3] = {slope * x.from[i] + w, slope * y.from[j] + w * a, slope * z.from[k] + w * b};
      sum += most_of_directions(v);
    }
    most = std::max(most, sum);
  }
  const auto least = [](Bounds s) { return s.lo <= 0 && s.hi >= 0 ? 0 : std::min(s.lo * s.lo, s.hi * s.hi); };
  return most / std::sqrt(1 + least(piece.a) + least(piece.b));
}

// True if `most` is at most `bound` on the whole piece. Gives up after `pieces` parts.
template <class Most>
bool is_proved(const Piece& whole, double bound, bool of_directions, int pieces, const Most& most) {
  std::vector<Piece> open = {whole};
  for (; !open.empty() && pieces > 0; --pieces) {
    const Piece piece = open.back();
    open.pop_back();
    if (most(piece) <= bound - 1e-9) continue;
    for (const Piece& half : piece.halves(of_directions)) open.push_back(half);
  }
  return open.empty();
}

}  // namespace

TEST_CASE("noise is its definition's, in double and in float", "[number][noise]") {
  vm::Workspace workspace;
  Random random(1);
  const vm::VerifiedProgram program = noise_program();
  double worst = 0;
  for (const double reach : {2.0, 40.0, 1000.0, 4e6}) {
    const Cloud cloud = noise_points(random, reach, static_cast<std::size_t>(scaled_cases(40000)));
    const std::vector<float> values = distances(program, cloud, workspace);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const dvec3 p(cloud.x[i], cloud.y[i], cloud.z[i]);
      const double truth = judge_noise(p);
      INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
      REQUIRE(std::abs(vm::evaluate_distance(program, p, workspace) - truth) <= 1e-14);
      worst = std::max(worst, std::abs(values[i] - truth));
    }
  }
  CAPTURE(worst / 0x1p-24);
  CHECK(worst <= vm::kNoiseUnits / 2 * 0x1p-24);
}

TEST_CASE("noise is within its range, and no steeper than its slope, whatever the hash",
          "[number][noise][released]") {
  CHECK(is_proved({}, kNoiseRange, false, 3'000'000, max_value));
  CHECK(is_proved({}, kNoiseSlope, true, 4'000'000, max_slope));
  // The bounds are nearly tight: in the middle of a cell the gradients can be such that the slope is 3.75.
  CHECK_FALSE(is_proved({}, 1.0363, false, 100'000, max_value));
  CHECK_FALSE(is_proved({}, 3.7499, true, 100'000, max_slope));
}

TEST_CASE("noise is gentler near the planes of its lattice, whatever the hash", "[number][noise][heavy]") {
  for (std::size_t i = 0; i < vm::kNoiseSlopes.size(); ++i) {
    // Axis 0: the coordinate near an integer is the dominant axis of the direction. Axis 1: the coordinate is
    // another.
    for (const std::size_t axis : {0, 1}) {
      Piece piece;
      piece.at[axis] = {static_cast<double>(i) / 16, static_cast<double>(i + 1) / 16};
      CAPTURE(i, axis);
      CHECK(is_proved(piece, vm::kNoiseSlopes[i], true, 8'000'000, max_slope));
      CHECK(vm::noise_slope(piece.at[axis].hi) == vm::kNoiseSlopes[i]);
    }
  }
}

TEST_CASE("noise and its first two derivatives have no jumps at the lattice", "[number][noise]") {
  vm::Workspace workspace;
  Random random(2);
  const vm::VerifiedProgram program = noise_program();
  for (int n = 0; n < scaled_cases(2000); ++n) {
    dvec3 p = random.in_box(20), step(0);
    const int axis = random.below(3);
    p[axis] = std::round(p[axis]);
    step[axis] = 1e-7;
    const auto below = vm::evaluate_surface(program, p - step, workspace);
    const auto above = vm::evaluate_surface(program, p + step, workspace);
    const auto below2 = vm::evaluate_surface(program, p - 2.0 * step, workspace);
    const auto above2 = vm::evaluate_surface(program, p + 2.0 * step, workspace);
    CHECK(std::abs(above.distance - below.distance) <= 2e-7 * kNoiseSlope);
    const double curvature = 40;  // upper bound of all second derivatives
    CHECK(glm::length(above.gradient - below.gradient) <= 2e-7 * curvature);
    const dvec3 curve_below = (below.gradient - below2.gradient) / 1e-7;
    const dvec3 curve_above = (above2.gradient - above.gradient) / 1e-7;
    CHECK(glm::length(curve_above - curve_below) <= 1e-4);
  }
}

TEST_CASE("the gradient of noise is the slope of its values", "[number][noise]") {
  vm::Workspace workspace;
  Random random(3);
  const vm::VerifiedProgram program = noise_program();
  for (int n = 0; n < scaled_cases(2000); ++n) {
    const dvec3 p = random.in_box(50);
    const dvec3 gradient = vm::evaluate_surface(program, p, workspace).gradient;
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 step(0);
      step[axis] = 1e-5;
      CHECK(std::abs((judge_noise(p + step) - judge_noise(p - step)) / 2e-5 - gradient[axis]) <= 1e-7);
    }
  }
}

TEST_CASE("noise is 0 at whole points, repeats after 289 and ends at its reach", "[number][noise]") {
  using vm::real::noise;
  constexpr double kInfinite = std::numeric_limits<double>::infinity(), kFar = vm::kNoiseReach;
  CHECK(noise(3, -7, 12) == 0);
  CHECK(noise(0.25, 0.5, -3.75) == noise(289.25, 0.5 - 2 * 289, -3.75));
  for (const double far : {kFar, kFar + 0.5, 1e300, kInfinite}) {
    CHECK(noise(far, 0.25, 0.5) == noise(kFar, 0.25, 0.5));
    CHECK(noise(0.25, -far, 0.5) == noise(0.25, -kFar, 0.5));
    CHECK(std::isfinite(noise(far, -far, far)));
  }
  CHECK(std::abs(noise(kFar, 0.25, 0.5) - judge_noise({kFar, 0.25, 0.5})) < 1e-15);
  for (int i = 0; i < 3; ++i) {
    double at[3] = {0.5, 0.25, 0.75};
    at[i] = std::nan("");
    CHECK(std::isnan(noise(at[0], at[1], at[2])));
  }
}

TEST_CASE("noise has the same bits on every instruction set, as far as floats go", "[number][noise][isa]") {
  const IsaGuard guard;
  vm::Workspace workspace;
  Random random(4);
  Cloud cloud;
  const float spice[] = {0.f,        -0.f,  1e-40f, -1e-20f, 8388608.f,    4194303.5f,
                         -4194304.f, 3e38f, kInf,   -kInf,   std::nanf("")};
  for (int n = 0; n < 3000; ++n) {
    float p[3];
    for (float& x : p) {
      x = static_cast<float>(random.uniform(-1, 1) * std::exp(random.uniform(0, 16)));
      if (random.chance(0.1)) x = spice[random.below(11)];
    }
    cloud.add(p[0], p[1], p[2]);
  }
  const vm::VerifiedProgram program = noise_program();
  std::vector<std::uint32_t> first;
  for (std::string_view isa : vm::available_isas()) {
    REQUIRE(vm::force_isa(isa));
    const std::vector<std::uint32_t> bits = distance_bits(program, cloud.from(0), cloud.size(), workspace);
    if (first.empty()) first = bits;
    INFO(isa);
    CHECK(bits == first);
  }
}

TEST_CASE("the twelve directions come about equally often", "[number][noise]") {
  int count[3][3][3] = {};
  constexpr int kSide = 60;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const dvec3 g = judge_noise_direction(i % kSide, i / kSide % kSide - 30, i / kSide / kSide - 500);
    ++count[std::lround(g.x) + 1][std::lround(g.y) + 1][std::lround(g.z) + 1];
  }
  int directions = 0;
  for (const auto& plane : count) {
    for (const auto& row : plane) {
      for (const int here : row) {
        directions += here > 0;
        if (here > 0) CHECK(std::abs(here - kSide * kSide * kSide / 12) < kSide * kSide * kSide / 120);
      }
    }
  }
  CHECK(directions == 12);
}

TEST_CASE("what is said of noise over boxes holds, and of small ones it is close", "[number][noise][range]") {
  vm::Workspace workspace;
  Random random(5);
  const vm::VerifiedProgram program = noise_program();
  double width = 0, spread = 0, said = 0, met = 0;
  for (int n = 0; n < scaled_cases(6000); ++n) {
    static const double kSides[] = {0, 1e-3, 0.03, 0.03, 0.5, 1.5};
    dvec3 lo = random.in_box(30), hi;
    const double side = kSides[n % 6];
    for (int axis = 0; axis < 3; ++axis) {
      if (random.chance(0.2)) lo[axis] = std::round(lo[axis]);
      hi[axis] = lo[axis] + (random.chance(0.1) ? 0 : side);
    }
    const vm::SlopeBound bound = vm::evaluate_slope(program, lo, hi, workspace);
    const vm::Range range = vm::evaluate_range(program, lo, hi, workspace);
    const vm::AlongLine line = vm::evaluate_along(program, lo, hi - lo, 0, 1, workspace);
    double least = 9, most = -9, steepest = 0;
    for (int i = 0; i < 40; ++i) {
      dvec3 t{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
      if (i % 4 == 0) t = dvec3(t.x);  // every fourth point lies on the line
      const dvec3 p = lo + t * (hi - lo);
      const auto here = vm::evaluate_surface(program, p, workspace);
      const double slope = glm::length(here.gradient), along = glm::dot(here.gradient, hi - lo);
      CHECK((here.distance >= bound.value.lo - 1e-14 && here.distance <= bound.value.hi + 1e-14));
      CHECK((here.distance >= range.lo - 1e-14 && here.distance <= range.hi + 1e-14));
      CHECK(slope <= bound.lipschitz * (1 + 1e-12));
      if (i % 4 == 0) {
        CHECK((here.distance >= line.value.lo - 1e-14 && here.distance <= line.value.hi + 1e-14));
        CHECK((along >= line.derivative.lo - 1e-12 && along <= line.derivative.hi + 1e-12));
      }
      least = std::min(least, here.distance), most = std::max(most, here.distance);
      steepest = std::max(steepest, slope);
    }
    CHECK(bound.lipschitz <= kNoiseSlope * (1 + 1e-9));
    CHECK(bound.float_error <= (vm::kNoiseUnits + 1) * 0x1p-24);
    if (side != 0.03) continue;
    width += bound.value.hi - bound.value.lo, spread += most - least;
    said += bound.lipschitz, met += steepest;
  }
  CHECK(width < 1.5 * spread);
  CHECK(said < 1.25 * met);
}

TEST_CASE("enclosures of noise hold every float, and of small boxes they are small", "[number][noise][enclosure]") {
  vm::Workspace workspace;
  Random random(6);
  const vm::VerifiedProgram program = noise_program();
  for (int n = 0; n < scaled_cases(400); ++n) {
    BoxSet boxes = random_boxes(random);
    for (std::size_t i = 0; i < kEnclosedBoxes; i += 4) {
      for (int axis = 0; axis < 3; ++axis) {
        const float by = static_cast<float>(random.uniform(-1, 1) * std::exp(random.uniform(0, 17)));
        boxes.lo[axis][i] += by, boxes.hi[axis][i] += by;
      }
    }
    const Enclosed result = enclosed(program, boxes, workspace);
    const Cloud cloud = points_in(boxes, random, 24);
    count_outside(distances(program, cloud, workspace), cloud, result.lo, result.hi, "noise");
    // not the far boxes: there the boxes' centres are rounded, too
    for (std::size_t i = 1; i < kEnclosedBoxes; i += 2) {
      const dvec3 side(boxes.hi[0][i] - boxes.lo[0][i], boxes.hi[1][i] - boxes.lo[1][i],
                       boxes.hi[2][i] - boxes.lo[2][i]);
      CHECK(result.hi[i] - result.lo[i] <= std::min(2 * kNoiseRange, kNoiseSlope * glm::length(side)) + 1e-4);
    }
  }
}

}  // namespace fathom::test::noise_test
