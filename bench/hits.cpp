// How far off are the hits? Rays by area on a sphere, a plane, a box and a torus of unit scale, followed for ten
// units, against closed forms (the torus against bisection in long double on a fine grid).
//
//     build/release/bench_hits [rays]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <optional>
#include <random>

#include "compiler/compile.h"
#include "runtime/march.h"

namespace {

using namespace fathom;
using glm::dvec3;
using Real = long double;

struct Line {
  Real o[3], d[3];  // d of unit length to float precision
  Real at(int axis, Real t) const { return o[axis] + t * d[axis]; }
};

std::optional<Real> sphere(const Line& line) {
  Real a = 0, b = 0, c = -1;
  for (int i = 0; i < 3; ++i) {
    a += line.d[i] * line.d[i];
    b += line.o[i] * line.d[i];
    c += line.o[i] * line.o[i];
  }
  const Real discriminant = b * b - a * c;
  if (discriminant < 0) return std::nullopt;
  return c / (-b + std::sqrt(discriminant));
}

std::optional<Real> plane(const Line& line) {
  if (line.d[1] >= 0) return std::nullopt;
  return -line.o[1] / line.d[1];
}

constexpr double kFar = 10;  // scene units; beyond it a plane under a flat ray is not at unit scale
constexpr Real kHalf[3] = {0.75L, 0.5L, 1.0L};

std::optional<Real> box(const Line& line) {
  Real begin = 0, end = 1e9L;
  for (int i = 0; i < 3; ++i) {
    const Real a = (-kHalf[i] - line.o[i]) / line.d[i], b = (kHalf[i] - line.o[i]) / line.d[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (begin > end) return std::nullopt;
  return begin;
}

Real torus_field(const Line& line, Real t) {
  const Real ring = std::hypot(line.at(0, t), line.at(2, t)) - 0.75L;
  return std::hypot(ring, line.at(1, t)) - 0.25L;
}

std::optional<Real> torus(const Line& line) {
  constexpr int kCells = 20000;
  const auto t_of = [](int i) { return 3 + 4 * Real(i) / kCells; };  // the ring lies between 4 and 6 from the origins
  for (int i = 1; i <= kCells; ++i) {
    if (torus_field(line, t_of(i)) > 0) continue;
    Real lo = t_of(i - 1), hi = t_of(i);
    for (int k = 0; k < 80; ++k) {
      const Real middle = (lo + hi) / 2;
      (torus_field(line, middle) > 0 ? lo : hi) = middle;
    }
    return hi;
  }
  return std::nullopt;
}

// From a sphere of radius 5, towards points spread evenly over a disc of radius `reach` across the line of sight.
runtime::Ray random_ray(std::mt19937_64& random, double reach, bool above) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  dvec3 from = 5.0 * glm::normalize(dvec3(normal(random), normal(random), normal(random)));
  if (above) from.y = std::abs(from.y);
  const dvec3 side = glm::normalize(glm::cross(from, dvec3(normal(random), normal(random), normal(random))));
  const dvec3 target = reach * std::sqrt(uniform(random)) * side;
  const dvec3 direction = glm::normalize(target - from);
  return {dvec3(glm::vec3(from)), dvec3(glm::vec3(direction))};  // what a float renderer is given
}

void measure(const char* name, const char* node, std::optional<Real> (*truth)(const Line&), double reach, int count) {
  compiler::Diagnostics diagnostics;
  const auto scene = compiler::compile(
      compiler::Source(name, fmt::format(R"({{"version": 1, "objects": [{}]}})", node)), diagnostics);
  if (!scene) std::exit(1);
  std::mt19937_64 random(7);
  std::vector<runtime::Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(random_ray(random, reach, name[0] == 'p'));
  const runtime::Field field = runtime::make_field(*scene, kFar);
  const runtime::MarchResult result = runtime::march(field, rays);
  std::vector<double> errors;
  int false_hits = 0, false_misses = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Line line{};
    for (int k = 0; k < 3; ++k) line.o[k] = rays[i].origin[k], line.d[k] = rays[i].direction[k];
    const auto t = truth(line);
    const bool hit = result.arrivals[i].status == runtime::Arrival::Status::Hit;
    const bool expected = t && *t <= kFar;
    false_hits += hit && !expected;
    false_misses += !hit && expected;
    if (hit && expected)
      errors.push_back(std::abs(static_cast<double>(static_cast<Real>(result.arrivals[i].t) - *t)));
  }
  std::sort(errors.begin(), errors.end());
  fmt::print("{:<8} {:8} {:8} {:9.1e} {:9.1e} {:9.1e} {:6} {:7} {:9} {:6} {:7.2f}\n", name, rays.size(),
             errors.size(), errors[errors.size() / 2], errors[errors.size() * 99 / 100], errors.back(), false_hits,
             false_misses, result.counters.certified, result.counters.exhausted,
             static_cast<double>(result.counters.evaluations) / static_cast<double>(rays.size()));
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200000;
  fmt::print("{:<8} {:>8} {:>8} {:>9} {:>9} {:>9} {:>6} {:>7} {:>9} {:>6} {:>7}\n", "shape", "rays", "hits", "p50",
             "p99", "max", "false", "missed", "in double", "lost", "evals");
  measure("sphere", R"({"type": "sphere", "radius": 1})", sphere, 1.05, count);
  measure("plane", R"({"type": "plane", "normal": [0, 1, 0]})", plane, 4.9, count);
  measure("box", R"({"type": "box", "half_size": [0.75, 0.5, 1]})", box, 1.2, count);
  measure("torus", R"({"type": "torus", "major_radius": 0.75, "minor_radius": 0.25})", torus, 1.05, count / 10);
}
