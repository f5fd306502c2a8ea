#include "runtime/material/pattern.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/sampling/sampler.h"

namespace fathom::runtime {
namespace {

using compiler::Pattern;

bool beyond(double cell) { return !(std::abs(cell) <= kLargestCell); }
bool beyond(glm::dvec3 p) { return beyond(p.x) || beyond(p.y) || beyond(p.z); }

double fraction(double x) { return x - std::floor(x); }
std::int64_t cell(double x) { return static_cast<std::int64_t>(std::floor(x)); }

// Returns 0 below 0, 1 above 1, and 3 u^2 - 2 u^3 between.
double cubic_step(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

// Perlin's 6 u^5 - 15 u^4 + 10 u^3.
double fade(double u) { return u * u * u * (u * (u * 6 - 15) + 10); }

// Mixes a coordinate of a lattice point into scattered bits, by SplitMix64's finalizer (sampler.h).
std::uint64_t mix_in(std::uint64_t bits, std::int64_t coordinate) {
  return mix64(bits ^ static_cast<std::uint64_t>(coordinate)) + kGoldenGamma;
}

// Vectors from a cube's centre to the middles of its twelve edges, of which four count twice, so that four bits
// choose. Branches on random bits would be predicted wrong.
constexpr glm::dvec3 kEdges[16] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                   {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                   {1, 1, 0},  {0, -1, 1},  {-1, 1, 0}, {0, -1, -1}};

double edge_dot(std::uint64_t bits, glm::dvec3 v) {
  const glm::dvec3& edge = kEdges[bits >> 60];
  return v.x * edge.x + v.y * edge.y + v.z * edge.z;
}

double mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double checker(glm::dvec3 p) {
  p += kOffset;
  if (beyond(p)) return 0.5;
  return static_cast<double>((cell(p.x) + cell(p.y) + cell(p.z)) & 1);
}

double stripes(const Pattern::Stripes& s, glm::dvec3 p) {
  const double along = glm::dot(p, s.axis) + kOffset;
  if (beyond(along)) return 0.5;
  const double place = fraction(along), half = s.softness * std::min(s.width, 1 - s.width) / 2;
  if (!(half > 0)) return place < s.width ? 0 : 1;
  // The edge at 0 falls, and the edge at `width` rises. Either is within reach from both sides of the period's end.
  const auto edge = [&](double at) { return cubic_step((place - at) / (2 * half) + 0.5); };
  return edge(s.width) - edge(1) + (1 - edge(0));
}

double gradient(const Pattern::Gradient& g, glm::dvec3 p) {
  const glm::dvec3 way = g.to - g.from;
  return std::clamp(glm::dot(p - g.from, way) / glm::dot(way, way), 0.0, 1.0);
}

double gradient_noise(glm::dvec3 p, std::uint64_t seed) {
  if (beyond(p)) return 0;
  const std::int64_t x = cell(p.x), y = cell(p.y), z = cell(p.z);
  const glm::dvec3 f = p - glm::floor(p);
  const double u = fade(f.x), v = fade(f.y), w = fade(f.z);
  const std::uint64_t bits = mix64(seed + kGoldenGamma);
  // The corners of a cell share the bits of the coordinates mixed in first.
  double edges[2][2][2];
  for (int i = 0; i < 2; ++i) {
    const std::uint64_t of_x = mix_in(bits, x + i);
    for (int j = 0; j < 2; ++j) {
      const std::uint64_t of_y = mix_in(of_x, y + j);
      for (int k = 0; k < 2; ++k) {
        edges[i][j][k] = edge_dot(mix64(mix_in(of_y, z + k)), f - glm::dvec3(i, j, k));
      }
    }
  }
  const auto side = [&](int j, int k) { return mix(edges[0][j][k], edges[1][j][k], u); };
  return mix(mix(side(0, 0), side(1, 0), v), mix(side(0, 1), side(1, 1), v), w);
}

double noise(const Pattern::Noise& n, glm::dvec3 p) {
  // Noise is 0 at an octave's whole coordinates. The octaves are moved apart by fractions of multiples of irrational
  // numbers, so that no plane of the scene meets the zeros of all octaves.
  constexpr glm::dvec3 kApart(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  double sum = 0, strength = 1, all = 0;
  for (int octave = 0; octave < n.octaves; ++octave) {
    const auto number = static_cast<std::uint64_t>(octave);
    sum += strength * gradient_noise(p + kApart * (octave + 1.0), mix64(n.seed) + number);
    all += strength;
    strength *= n.gain;
    p *= n.lacunarity;
  }
  return std::clamp(0.5 + 0.5 * n.contrast * sum / all, 0.0, 1.0);
}

double bricks(const Pattern::Bricks& b, glm::dvec3 p) {
  const double row = p.y / b.height + kOffset;
  if (beyond(row) || beyond(p.x / b.width)) return 0.5;
  const double column = p.x / b.width + kOffset - b.shift * (std::floor(row) - 2 * std::floor(row / 2));
  // Half of the mortar lies on either side of a cell's edge.
  const auto off_edge = [](double place, double size) {
    const double part = fraction(place);
    return std::min(part, 1 - part) * size;
  };
  return std::min(off_edge(row, b.height), off_edge(column, b.width)) < b.mortar / 2 ? 1 : 0;
}

double pattern_value(const Pattern& pattern, glm::dvec3 position) {
  const glm::dvec3 p = pattern.to_pattern(position);
  if (!std::isfinite(p.x + p.y + p.z)) return std::nan("");
  struct Value {
    glm::dvec3 p;
    double operator()(const Pattern::Checker&) const { return checker(p); }
    double operator()(const Pattern::Stripes& s) const { return stripes(s, p); }
    double operator()(const Pattern::Gradient& g) const { return gradient(g, p); }
    double operator()(const Pattern::Noise& n) const { return noise(n, p); }
    double operator()(const Pattern::Bricks& b) const { return bricks(b, p); }
  };
  return std::visit(Value{p}, pattern.kind);
}

}  // namespace fathom::runtime
