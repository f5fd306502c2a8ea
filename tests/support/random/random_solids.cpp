#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/shapes/node_table.h"
#include "tests/support/random/random_shapes.h"

namespace fathom::test {
namespace {

using compiler::Kind;
using glm::dvec3;

// Rings from a thin wire to nearly a ball with a pinhole, and spindle tori.
std::vector<double> torus(Random& random) {
  const double major = random.length(0.2, 1.5);
  const double ratio[] = {1.5, 1, 0.999, 0.5, 0.1, 0.01};
  return {major, rounded(major * ratio[random.below(6)])};
}

std::vector<double> cone(Random& random) {
  const double a = random.length(0.05, 1.5), b = random.length(0.05, 1.5), h = random.length(0.05, 1.5);
  switch (random.below(5)) {
    case 0:
      return {a, 0, h};
    case 1:
      return {0, b, h};
    case 2:
      return {a, a, h};
    default:
      return {a, b, h};
  }
}

// Random balls, some of whose reaches nearly or exactly touch: |r1 - r2| = height (1 - tiny).
std::vector<double> round_cone(Random& random) {
  const double height = random.length(0.1, 1.5), small = random.length(0.05, 1);
  const double difference[] = {1, 1 - 1e-6, 0.99, 0.5, 0};
  double large = rounded(small + height * difference[random.below(5)]);
  while (large - small > height) large = static_cast<double>(std::nextafter(static_cast<float>(large), 0.f));
  if (random.chance(0.5)) return {large, small, height};
  return {small, large, height};
}

double eighths(Random& random, int reach) { return (random.below(2 * reach + 1) - reach) / 8.0; }
dvec3 corner(Random& random) { return {eighths(random, 12), eighths(random, 12), eighths(random, 12)}; }

// Corners on a grid of eighths, far from collinear. The fourth corner is a + s u + t v, exactly in the plane, and
// convex for s, t > 0, s + t > 1.
std::vector<double> sheet(Random& random, bool quad) {
  dvec3 a, u, v;
  double area;
  do {
    a = corner(random), u = corner(random) - a, v = corner(random) - a;
    area = glm::length(glm::cross(u, v));
  } while (area < 0.25 * glm::length(u) * glm::length(v) || area < 0.2);
  const double st[4][2] = {{1, 1}, {0.5, 1}, {1, 0.75}, {0.75, 0.75}};
  const double* w = st[random.below(4)];
  const dvec3 b = a + u, c = a + w[0] * u + w[1] * v, d = a + v;
  std::vector<double> params{a.x, a.y, a.z, b.x, b.y, b.z};
  if (quad) params.insert(params.end(), {c.x, c.y, c.z});
  params.insert(params.end(), {d.x, d.y, d.z, random.length(0.01, 0.3)});
  return params;
}

}  // namespace

std::vector<double> random_solid_params(Kind kind, Random& random) {
  const auto size = [&] { return random.length(0.05, 1.5); };
  // Rounding radius up to `outer`, sometimes 0 and sometimes all of `outer`.
  const auto rounding = [&](double outer) {
    const double share[] = {0, 1, 0.5, 0.1};
    return rounded(outer * share[random.below(4)]);
  };
  switch (kind) {
    case Kind::RoundBox: {
      const double x = size(), y = size(), z = size();
      return {x, y, z, rounding(std::min({x, y, z}))};
    }
    case Kind::Torus:
      return torus(random);
    case Kind::Plane: {
      const dvec3 n =
          random.chance(0.3) ? dvec3(0, random.chance(0.5) ? 2 : -1, 0) : random.in_box(2) + dvec3(0, 3, 0);
      return {rounded(n.x), rounded(n.y), rounded(n.z), rounded(random.uniform(-1, 1))};
    }
    case Kind::RoundedCylinder: {
      const double radius = size(), half_height = size();
      return {radius, half_height, rounding(std::min(radius, half_height))};
    }
    case Kind::Cone:
      return cone(random);
    case Kind::RoundCone:
      return round_cone(random);
    case Kind::BoxFrame: {
      const double x = size(), y = size(), z = size(), share[] = {0.5, 0.25, 0.1, 0.01};
      return {x, y, z, rounded(std::min({x, y, z}) * share[random.below(4)])};
    }
    case Kind::CappedTorus: {
      const double major = random.length(0.2, 1.5), ratio[] = {0.9, 0.5, 0.1, 0.01};
      const double angle[] = {180, 90, 30, rounded(random.uniform(1, 179))};
      return {major, rounded(major * ratio[random.below(4)]), angle[random.below(4)]};
    }
    case Kind::Ellipsoid:
      return {size(), size(), size()};
    case Kind::Link: {
      std::vector<double> ring = torus(random);
      ring.push_back(size());
      return ring;
    }
    case Kind::InfiniteCone:
      return {rounded(random.uniform(2, 88))};
    case Kind::Gyroid:
    case Kind::SchwarzP:
    case Kind::SchwarzD:
      return {random.length(0.2, 4)};
    case Kind::MengerSponge:
      return {size(), 1.0 + random.below(5)};
    case Kind::Julia: {
      const dvec3 c = random.in_box(0.6);
      const double detail[] = {0, 0x1p-10, 0x1p-6};
      const double w = rounded(random.uniform(-0.6, 0.6)), iterations = 1.0 + random.below(12);
      return {c.x, c.y, c.z, w, iterations, 2.0 + random.below(7), detail[random.below(3)]};
    }
    case Kind::Triangle:
      return sheet(random, false);
    case Kind::Quad:
      return sheet(random, true);
    case Kind::Mandelbulb: {
      const double detail[] = {0, 0x1p-10, 0x1p-6};
      const double power = 2.0 + random.below(8), iterations = 1.0 + random.below(10);
      const double bailout = 2.0 + random.below(7);
      return {power, iterations, bailout, detail[random.below(3)]};
    }
    default:
      return plain_params(compiler::spec(kind), random);
  }
}

}  // namespace fathom::test
