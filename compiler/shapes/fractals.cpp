// Rows of the periodic surfaces and the fractals, whose distances are bounds or estimates.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using glm::dvec3;
using vm::Opcode;

constexpr PrimitiveFacts kBound{Exactness::Bound, Exactness::Bound};
constexpr PrimitiveFacts kSymmetricBound{Exactness::Bound, Exactness::Bound, kAllAxes};
constexpr PrimitiveFacts kEstimate{Exactness::Estimate, Exactness::Estimate};

// Returns radians per scene unit, and the factor that brings the largest slope, sqrt 3 times that number, to 1.
std::vector<double> periodic_immediates(Params p) {
  const double k = 2 * std::numbers::pi / p[0];
  return {k, 1 / (std::numbers::sqrt3 * k)};
}
Box everywhere(Params) { return Box::everything(); }
ParamSpec period() { return length("period", "of one cell along each axis"); }

NodeSpec gyroid_row() {
  return {.kind = Kind::Gyroid,
          .name = "gyroid",
          .category = kPrimitive,
          .params = {period()},
          .doc = "one side of Schoen's gyroid, everywhere; onion makes a sheet of it",
          .code = code_of<Opcode::Gyroid, periodic_immediates>,
          .bound = everywhere,
          .facts = kBound};
}

NodeSpec schwarz_p_row() {
  return {.kind = Kind::SchwarzP,
          .name = "schwarz_p",
          .category = kPrimitive,
          .params = {period()},
          .doc = "one side of Schwarz' primitive surface, everywhere; onion makes a sheet of it",
          .code = code_of<Opcode::SchwarzP, periodic_immediates>,
          .bound = everywhere,
          .facts = kSymmetricBound};
}

NodeSpec schwarz_d_row() {
  return {.kind = Kind::SchwarzD,
          .name = "schwarz_d",
          .category = kPrimitive,
          .params = {period()},
          .doc = "one side of Schwarz' diamond surface, everywhere; onion makes a sheet of it",
          .code = code_of<Opcode::SchwarzD, periodic_immediates>,
          .bound = everywhere,
          .facts = kBound};
}

ErrorText check_menger_sponge(Params p) {
  if (p[1] <= 8) return std::nullopt;
  return fmt::format("`iterations` is {}; it must be a whole number from 1 to 8", p[1]);
}
NodeSpec menger_sponge_row() {
  return {.kind = Kind::MengerSponge,
          .name = "menger_sponge",
          .category = kPrimitive,
          .params = {length("half_size", "half the side of the cube"),
                     {"iterations", ParamType::Integer, Rule::Positive, 4.0, "levels of holes, 1 to 8"}},
          .doc = "a cube with square holes, and holes beside them, and so on",
          .check = check_menger_sponge,
          .code = code_of<Opcode::MengerSponge>,
          .bound = [](Params p) { return Box::centred(dvec3(p[0])); },
          .facts = kSymmetricBound};
}

ParamSpec detail() {
  return length_or_zero("detail", "the surface lies where the estimate is this; finer features go", 0.001);
}

// Returns the radius of a ball that contains the Mandelbulb: beyond |p| = 2^(1/(n-1)) <= 2 every orbit w -> w^n + p
// escapes, because |w| >= |p| grows. Uses Newton's method on r^(n-1) = 2, because libm's pow differs between
// machines.
double escape_radius(double power) {
  double r = 2;
  for (int i = 0; i < 64; ++i) {
    double rest = 1;  // r^(n-2)
    for (int k = 0; k < static_cast<int>(power) - 2; ++k) rest *= r;
    r -= (r - 2 / rest) / (power - 1);
  }
  return r;
}
// Returns the largest whole number whose `power`-th power is at most 10^18. Divides whole numbers, which is exact.
double largest_bailout(double power) {
  const auto fits = [&](std::uint64_t bailout) {
    std::uint64_t rest = 1'000'000'000'000'000'000;
    for (int i = 0; i < static_cast<int>(power); ++i) rest /= bailout;
    return rest > 0;
  };
  std::uint64_t fitting = 1, beyond = 1'000'000'001;
  while (beyond - fitting > 1) {
    const std::uint64_t middle = (fitting + beyond) / 2;
    (fits(middle) ? fitting : beyond) = middle;
  }
  return static_cast<double>(fitting);
}
ErrorText check_mandelbulb(Params p) {
  if (p[0] < 2 || p[0] > 24) return fmt::format("`power` is {}; it must be a whole number from 2 to 24", p[0]);
  if (p[1] > 256) return fmt::format("`iterations` is {}; it must be a whole number from 1 to 256", p[1]);
  // |w|^2 after the escaping iteration is about bailout^(2 power) and must fit into a float.
  const double largest = largest_bailout(p[0]);
  if (p[2] < 2 || p[2] > largest) {
    return fmt::format("`bailout` is {}; for power {} it must be between 2 and {}", p[2], p[0], largest);
  }
  return std::nullopt;
}
// The estimate is at least about a quarter of the distance from the set.
Box mandelbulb_bound(Params p) { return Box::centred(dvec3(escape_radius(p[0]) + 4 * p[3])); }

Code mandelbulb_code(Params p) { return one(Opcode::Mandelbulb, {p[0], p[1], p[2], escape_radius(p[0]), p[3]}); }
NodeSpec mandelbulb_row() {
  return {.kind = Kind::Mandelbulb,
          .name = "mandelbulb",
          .category = kPrimitive,
          .params = {{"power", ParamType::Integer, Rule::Positive, 8.0, "of the iteration, 2 to 24"},
                     {"iterations", ParamType::Integer, Rule::Positive, 8.0, "at most, 1 to 256"},
                     length("bailout", "radius beyond which a point has escaped, 2 or more", 4.0),
                     detail()},
          .doc = "a fractal about the y axis; its distance is an estimate",
          .check = check_mandelbulb,
          .code = mandelbulb_code,
          .bound = mandelbulb_bound,
          .facts = kEstimate};
}

// Returns R with R^2 - |c| = R. No orbit of q -> q^2 + c returns from beyond |q| = R, because |q^2 + c| >= |q|^2 -
// |c| > |q| there.
double julia_escape_radius(Params p) {
  const double c = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
  return (1 + std::sqrt(1 + 4 * c)) / 2;
}
ErrorText check_julia(Params p) {
  if (p[4] > 256) return fmt::format("`iterations` is {}; it must be a whole number from 1 to 256", p[4]);
  // |q|^2 after the escaping iteration is about bailout^4 and must fit into a float.
  constexpr double kLargestRadius = 1e6;
  const double radius = julia_escape_radius(p);
  if (radius > kLargestRadius) return fmt::format("`c` is too large; every orbit escapes from beyond {:.3g}", radius);
  if (p[5] < radius || p[5] > kLargestRadius) {
    return fmt::format("`bailout` is {}; for this `c` it must be between {:.6g} and {}", p[5], radius,
                       kLargestRadius);
  }
  return std::nullopt;
}
Code julia_code(Params p) {
  return one(Opcode::Julia, {p[0], p[1], p[2], p[3], p[4], julia_escape_radius(p), p[5], p[6]});
}
// The estimate is at least the distance from the ball.
Box julia_bound(Params p) { return Box::centred(dvec3(julia_escape_radius(p) + p[6])); }

NodeSpec julia_row() {
  return {.kind = Kind::Julia,
          .name = "julia",
          .category = kPrimitive,
          .params = {{"c", ParamType::Vec3, Rule::Any, kRequired, "first three parts of the quaternion added"},
                     number("c_w", "its fourth part", 0.0),
                     {"iterations", ParamType::Integer, Rule::Positive, 12.0, "at most, 1 to 256"},
                     length("bailout", "radius beyond which a point has escaped", 8.0),
                     detail()},
          .doc = "a fractal, the filled Julia set of q^2 + c in the quaternions, cut; its distance is an estimate",
          .check = check_julia,
          .code = julia_code,
          .bound = julia_bound,
          .facts = kEstimate};
}

}  // namespace

std::vector<NodeSpec> fractal_rows() {
  return {gyroid_row(), schwarz_p_row(), schwarz_d_row(), menger_sponge_row(), mandelbulb_row(), julia_row()};
}

}  // namespace fathom::compiler
