#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/shapes/node_table.h"
#include "tests/support/random/random_shapes.h"

namespace fathom::test {
namespace {

using compiler::Kind;

double size(Random& random) { return random.length(0.05, 1.5); }

// Random angle in degrees, sometimes a quarter turn, and a half turn if `closed`.
double angle(Random& random, bool closed) {
  const double special[] = {90, 45, 30, 135, 180};
  if (random.chance(0.4)) return special[random.below(closed ? 5 : 4)];
  return rounded(random.uniform(2, 178));
}

// Part of `outer`: all, nearly all, half, little.
double share(Random& random, double outer) {
  const double part[] = {1, 0.999, 0.5, 0.3, 0.1, 0.02};
  return rounded(outer * part[random.below(6)]);
}

// Arc whose round ends do not overlap. With overlap brute force would find the true depth, but the row promises only
// a bound.
std::vector<double> arc(Random& random) {
  const double radius = random.length(0.2, 1.5), half = angle(random, true);
  const double ends = half > 90 && half < 180 ? radius * std::sin(half * std::numbers::pi / 180) : radius;
  return {radius, half, std::max(0.001, rounded(0.999 * share(random, std::min(radius, ends))))};
}

std::vector<double> horseshoe(Random& random) {
  const double radius = random.length(0.2, 1.5), half = angle(random, false);
  const double length = random.chance(0.2) ? 0 : size(random),
               thickness = std::min(0.999 * radius, share(random, radius));
  return {radius, half, length, rounded(thickness)};
}

// Corners in all directions at radii about a mean: a simple polygon, clockwise or counter-clockwise.
std::vector<double> polygon(Random& random) {
  const int n = 3 + random.below(10);
  const bool reversed = random.chance(0.5);
  std::vector<double> k;
  for (int i = 0; i < n; ++i) {
    const double at = (i + random.uniform(-0.3, 0.3)) * 2 * std::numbers::pi / n * (reversed ? -1 : 1);
    const double radius = size(random);
    k.push_back(rounded(radius * std::cos(at)));
    k.push_back(rounded(radius * std::sin(at)));
  }
  return k;
}

std::vector<double> attempt(Kind kind, Random& random) {
  switch (kind) {
    case Kind::Rectangle:
    case Kind::RhombusOutline:
    case Kind::IsoscelesTriangle:
    case Kind::Ellipse:
      return {size(random), random.chance(0.1) ? 1.0 : size(random)};
    case Kind::RoundedRectangle: {
      const double x = size(random), y = size(random);
      return {x, y, random.chance(0.2) ? 0 : share(random, std::min(x, y))};
    }
    case Kind::Segment:
      return {rounded(random.uniform(-1, 1)), rounded(random.uniform(-1, 1)), rounded(random.uniform(-1, 1)),
              rounded(random.uniform(-1, 1)), random.length(0.02, 0.5)};
    case Kind::Polygon:
      return polygon(random);
    case Kind::RegularPolygon:
      return {random.chance(0.2) ? 64.0 : 3.0 + random.below(61), size(random)};
    case Kind::Star: {
      const double points = 3.0 + random.below(random.chance(0.5) ? 6 : 62), radius = size(random);
      // With the inner corners on the straight lines between the tips, the star is a regular polygon.
      const double flat = rounded(radius * std::cos(std::numbers::pi / points));
      return {points, radius, random.chance(0.2) ? flat : share(random, radius)};
    }
    case Kind::Trapezoid:
      return {random.chance(0.15) ? 0 : size(random), random.chance(0.15) ? 0 : size(random), size(random)};
    case Kind::Parallelogram:
      return {size(random), size(random), random.chance(0.2) ? 0 : rounded(random.uniform(-1.5, 1.5))};
    case Kind::UnevenCapsule:
      return random_params(Kind::RoundCone, random);
    case Kind::Arc:
      return arc(random);
    case Kind::Ring: {
      const double radius = random.length(0.1, 1), half = angle(random, true);
      return {radius, half, rounded(std::min(0.999 * radius, share(random, radius)))};
    }
    case Kind::Pie: {
      const double radius = size(random);
      return {radius, angle(random, true)};
    }
    case Kind::CutDisk: {
      const double radius = size(random);
      return {radius, random.chance(0.2) ? 0 : rounded(radius * random.uniform(-0.99, 0.99))};
    }
    case Kind::Horseshoe:
      return horseshoe(random);
    case Kind::VesicaOutline: {
      const double height = size(random);
      return {height, share(random, height)};
    }
    case Kind::Moon: {
      const double radius = size(random), cut = size(random);
      const double least = std::abs(radius - cut), most = radius + cut, t = random.uniform(0.01, 0.99);
      return {radius, cut, rounded(least + t * (most - least))};
    }
    case Kind::Egg: {
      const double bottom = size(random), top = share(random, bottom);
      return {bottom, top, rounded((bottom - top) * random.length(1.01, 8) + (top == bottom ? 1 : 0))};
    }
    case Kind::Cross: {
      const double length = size(random);
      return {length, share(random, length)};
    }
    case Kind::RoundedX: {
      const double half = size(random);
      return {half, share(random, half * 0.5857)};
    }
    default:
      return plain_params(compiler::spec(kind), random);
  }
}

}  // namespace

std::vector<double> random_outline_params(Kind kind, Random& random) {
  const auto check = compiler::spec(kind).check;
  for (;;) {
    std::vector<double> params = attempt(kind, random);
    if (check == nullptr || !check(params)) return params;
  }
}

}  // namespace fathom::test
