#include "tests/fuzz/check_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "tests/fuzz/target.h"
#include "tests/vm/number/float_bits.h"
#include "vm/encoding/disassemble.h"
#include "vm/interpret/trace.h"
#include "vm/prune/specialise.h"
#include "vm/range/slope.h"

namespace fathom::fuzz {
namespace {

using glm::dvec3;
using test::Cloud;
using test::Random;

constexpr std::size_t kCheckedPoints = 37;  // not a multiple of any register's lanes
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Points near the origin. Now and then a coordinate is an extreme float.
Cloud random_cloud(Random& random, double reach) {
  static const float kSpice[] = {0.f, -0.f, 1e-45f, 1e-20f, 1e19f, -1e30f, 3.4e38f, kInfinity, -kInfinity};
  Cloud cloud;
  for (std::size_t i = 0; i < kCheckedPoints; ++i) {
    float p[3];
    for (float& c : p) c = static_cast<float>(random.uniform(-reach, reach));
    if (random.chance(0.15)) p[random.below(3)] = kSpice[random.below(9)];
    cloud.add(p[0], p[1], p[2]);
  }
  return cloud;
}

dvec3 point_of(const Cloud& cloud, std::size_t i) { return {cloud.x[i], cloud.y[i], cloud.z[i]}; }

std::string place(const Cloud& cloud, std::size_t i) {
  return fmt::format("at {} {} {}", cloud.x[i], cloud.y[i], cloud.z[i]);
}

// All results of the batch evaluators at the points: distance, gradient, convexity, surface. [point][7]
std::vector<std::uint64_t> batch_bits(const vm::Code& program, const Cloud& cloud, std::size_t first,
                                      std::size_t count, vm::Workspace& workspace) {
  std::vector<float> d(count), gx(count), gy(count), gz(count), convex(count), alone(count);
  std::vector<std::uint32_t> s(count);
  vm::evaluate_surface(program, cloud.from(first), count,
                       {d.data(), gx.data(), gy.data(), gz.data(), s.data(), convex.data()}, workspace);
  vm::evaluate_distance(program, cloud.from(first), count, alone.data(), workspace);
  std::vector<double> x(count), y(count), z(count), real(count);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = cloud.x[first + i], y[i] = cloud.y[first + i], z[i] = cloud.z[first + i];
  }
  vm::evaluate_distance(program, vm::RealPoints{x.data(), y.data(), z.data()}, count, real.data(), workspace);
  std::vector<std::uint64_t> bits;
  for (std::size_t i = 0; i < count; ++i) {
    promise(test::bits_of(d[i]) == test::bits_of(alone[i]),
            "the surface's distance is not the distance " + place(cloud, first + i));
    for (float f : {d[i], gx[i], gy[i], gz[i], convex[i]}) bits.push_back(test::bits_of(f));
    bits.push_back(s[i]);
    bits.push_back(std::isnan(real[i]) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(real[i]));
  }
  return bits;
}

// Compares evaluation of one point at a time on the scalar instruction set with batches on every instruction set.
void check_bits(const vm::VerifiedProgram& program, const Cloud& cloud, vm::Workspace& workspace) {
  static const std::vector<std::string_view> isas = vm::available_isas();
  const test::IsaGuard guard;
  vm::force_isa("scalar");
  std::vector<std::uint64_t> scalar;
  for (std::size_t i = 0; i < kCheckedPoints; ++i) {
    const auto one = batch_bits(program, cloud, i, 1, workspace);
    scalar.insert(scalar.end(), one.begin(), one.end());
    const dvec3 p = point_of(cloud, i);
    const double real = vm::evaluate_distance(program, p, workspace);
    const double with = vm::evaluate_surface(program, p, workspace).distance;
    const auto bits = std::isnan(real) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(real);
    promise(one.back() == bits, "many points in double differ from one " + place(cloud, i));
    promise(std::bit_cast<std::uint64_t>(with) == bits || (std::isnan(with) && std::isnan(real)),
            "in double the surface's distance is not the distance " + place(cloud, i));
  }
  for (const std::string_view isa : isas) {
    vm::force_isa(isa);
    const auto many = batch_bits(program, cloud, 0, kCheckedPoints, workspace);
    for (std::size_t i = 0; i < many.size(); ++i) {
      promise(many[i] == scalar[i],
              fmt::format("{} differs from scalar in number {} {}", isa, i % 7, place(cloud, i / 7)));
    }
  }
}

struct BoxSet {
  float lo[3][vm::kEnclosedBoxes], hi[3][vm::kEnclosedBoxes];
  dvec3 least(std::size_t box) const { return {lo[0][box], lo[1][box], lo[2][box]}; }
  dvec3 most(std::size_t box) const { return {hi[0][box], hi[1][box], hi[2][box]}; }
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

BoxSet random_boxes(Random& random, double reach) {
  static const double kSizes[] = {0, 1e-3, 0.03, 0.3, 1, 3};
  BoxSet boxes;
  for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
    const double size = kSizes[random.below(6)];
    for (int axis = 0; axis < 3; ++axis) {
      boxes.lo[axis][i] = static_cast<float>(random.uniform(-reach, reach));
      boxes.hi[axis][i] = boxes.lo[axis][i] + static_cast<float>(size * random.uniform(0.2, 1));
    }
  }
  return boxes;
}

Cloud points_in(const BoxSet& boxes, std::size_t box, Random& random) {
  Cloud cloud;
  for (int n = 0; n < 8; ++n) {
    float p[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float lo = boxes.lo[axis][box], hi = boxes.hi[axis][box];
      const auto within = static_cast<float>(random.uniform(static_cast<double>(lo), static_cast<double>(hi)));
      p[axis] = random.chance(0.2) ? (random.chance(0.5) ? lo : hi) : std::min(hi, std::max(lo, within));
    }
    cloud.add(p[0], p[1], p[2]);
  }
  return cloud;
}

std::vector<float> distances(const vm::Code& program, const Cloud& cloud, vm::Workspace& workspace) {
  std::vector<float> d(cloud.size());
  vm::evaluate_distance(program, cloud.from(0), cloud.size(), d.data(), workspace);
  return d;
}

struct Enclosed {
  alignas(64) float lo[vm::kEnclosedBoxes], hi[vm::kEnclosedBoxes];
  std::vector<vm::ChoiceBounds> choices;
};

// True if the bounds of the result and of all operands of choices are equal bit for bit.
bool same_bits(const Enclosed& a, const Enclosed& b) {
  const auto same = [](const float* x, const float* y) {
    return std::equal(x, x + vm::kEnclosedBoxes, y,
                      [](float one, float other) { return test::bits_of(one) == test::bits_of(other); });
  };
  return same(a.lo, b.lo) && same(a.hi, b.hi) &&
         std::equal(a.choices.begin(), a.choices.end(), b.choices.begin(), b.choices.end(),
                    [&](const vm::ChoiceBounds& one, const vm::ChoiceBounds& other) {
                      return same(one.a_lo, other.a_lo) && same(one.a_hi, other.a_hi) && same(one.b_lo, other.b_lo) &&
                             same(one.b_hi, other.b_hi);
                    });
}

// Computes enclosures, which must be equal on every instruction set.
Enclosed enclosed(const vm::VerifiedProgram& program, const BoxSet& boxes, vm::Workspace& workspace) {
  static const std::vector<std::string_view> isas = vm::available_isas();
  const test::IsaGuard guard;
  Enclosed first;
  vm::enclose(program, boxes.view(), first.lo, first.hi, first.choices, workspace);
  for (const std::string_view isa : isas) {
    vm::force_isa(isa);
    Enclosed other;
    vm::enclose(program, boxes.view(), other.lo, other.hi, other.choices, workspace);
    promise(same_bits(first, other), fmt::format("{} encloses other ranges", isa));
  }
  return first;
}

// Checks that every value of the f32 machine lies in its enclosure. A value may be NaN only if the enclosure is
// unbounded on both sides.
void check_enclosures(const vm::VerifiedProgram& program, const BoxSet& boxes, Random& random,
                      vm::Workspace& workspace) {
  const Enclosed whole = enclosed(program, boxes, workspace);
  for (std::size_t box = 0; box < vm::kEnclosedBoxes; ++box) {
    const Cloud cloud = points_in(boxes, box, random);
    const std::vector<float> values = distances(program, cloud, workspace);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float lo = whole.lo[box], hi = whole.hi[box];
      const bool inside =
          std::isnan(values[i]) ? lo == -kInfinity && hi == kInfinity : lo <= values[i] && values[i] <= hi;
      promise(inside, fmt::format("{} is not in the enclosure {} .. {} {}", values[i], lo, hi, place(cloud, i)));
    }
  }
}

// True if an operation is undefined at the point (e.g. the root of a negative number), even if a min or max hides it:
// the program's value in double, `value`, is NaN, or any f32 value is. The f32 machine also computes NaN from
// infinities of numbers that overflow.
bool is_undefined_at(const vm::Code& program, dvec3 point, double value) {
  bool undefined = std::isnan(value);
  vm::trace(program, point, [&](const vm::TraceStep& step) {
    for (const float number : step.values) undefined |= std::isnan(number);
  });
  return undefined;
}

// Checks that ranges contain the values in double. Ranges say nothing about points at which an operation is
// undefined.
void check_ranges(const vm::VerifiedProgram& program, const BoxSet& boxes, Random& random, vm::Workspace& workspace) {
  for (std::size_t box = 0; box < vm::kEnclosedBoxes; box += 3) {
    const vm::Range range = vm::evaluate_range(program, boxes.least(box), boxes.most(box), workspace);
    const Cloud cloud = points_in(boxes, box, random);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const dvec3 point = point_of(cloud, i);
      const double value = vm::evaluate_distance(program, point, workspace);
      promise((range.lo <= value && value <= range.hi) || is_undefined_at(program, point, value),
              fmt::format("{} is not in the range {} .. {} {}", value, range.lo, range.hi, place(cloud, i)));
    }
  }
}

bool says_nothing(double bound) { return std::isinf(bound); }

// Distance between two numbers; 0 for infinities of one sign.
double apart(double a, double b) { return a == b ? 0 : std::abs(a - b); }

// Checks that two values never differ by more than the Lipschitz constant allows, and that f32 and double values
// never differ by more than the error bound.
void check_slopes(const vm::VerifiedProgram& program, const BoxSet& boxes, Random& random, vm::Workspace& workspace) {
  for (std::size_t box = 0; box < vm::kEnclosedBoxes; box += 7) {
    const vm::SlopeBound bound = vm::evaluate_slope(program, boxes.least(box), boxes.most(box), workspace);
    const Cloud cloud = points_in(boxes, box, random);
    const std::vector<float> rounded = distances(program, cloud, workspace);
    std::optional<dvec3> last;
    double last_value = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const dvec3 point = point_of(cloud, i);
      const double value = vm::evaluate_distance(program, point, workspace), slack = 1e-12 * (1 + std::abs(value));
      const double error = apart(static_cast<double>(rounded[i]), value);
      const double moved = last ? apart(value, last_value) : 0, path = last ? glm::distance(point, *last) : 0;
      const bool near = says_nothing(bound.float_error) || error <= bound.float_error + slack;
      const bool slow = says_nothing(bound.lipschitz) || moved <= bound.lipschitz * path * (1 + 1e-12) + slack;
      promise((near && slow) || is_undefined_at(program, point, value) ||
                  (last && is_undefined_at(program, *last, last_value)),
              fmt::format("{} in double, {} in float with an error up to {}; {} over {} at most {} times that, {}",
                          value, rounded[i], bound.float_error, moved, path, bound.lipschitz, place(cloud, i)));
      last = point, last_value = value;
    }
  }
}

// True if a part's value may replace the whole program's: equal (ignoring the sign of zero), or beyond the same
// limit.
bool agrees(float whole, float part, float least, float most) {
  if (whole < least) return part < least;
  if (whole > most) return part > most;
  return part == whole || (std::isnan(part) && std::isnan(whole));
}

void check_part(const vm::VerifiedProgram& whole, const vm::PrunedProgram& part, const Cloud& cloud, float least,
                float most, vm::Workspace& workspace) {
  vm::Program program;
  program.words = part.words, program.doubles = part.doubles, program.locals = part.locals;
  const auto verified = vm::verify(std::move(program));
  if (const auto* error = std::get_if<vm::VerifyError>(&verified)) throw BrokenPromise("a part: " + error->reason);
  const std::vector<float> a = distances(whole, cloud, workspace), b = distances(part, cloud, workspace);
  for (std::size_t i = 0; i < a.size(); ++i) {
    promise(agrees(a[i], b[i], least, most), fmt::format("{} of a part is not {} of the whole, for {} .. {}, {}",
                                                         b[i], a[i], least, most, place(cloud, i)));
  }
}

void check_parts(const vm::VerifiedProgram& program, const BoxSet& boxes, Random& random, vm::Workspace& workspace) {
  const vm::PrunedProgram whole = vm::whole(program);
  vm::Specialiser specialiser;
  if (!specialiser.enclose_choices(whole, boxes.view(), workspace)) return;
  static const float kLimits[][2] = {{-kInfinity, kInfinity}, {-kInfinity, 0.25f}, {0, 0}};
  for (const auto& [least, most] : kLimits) {
    specialiser.resolve(least, most);
    for (std::size_t box = 0; box < vm::kEnclosedBoxes; box += 5) {
      vm::PrunedProgram part;
      specialiser.prune(box, part);
      check_part(program, part, points_in(boxes, box, random), least, most, workspace);
    }
  }
}

}  // namespace

void check_evaluation(const vm::VerifiedProgram& program, Random& random, double reach) {
  vm::Workspace workspace;
  check_bits(program, random_cloud(random, reach), workspace);
}

void check_program(const vm::VerifiedProgram& program, Random& random, double reach) {
  vm::Workspace workspace;
  const auto again = vm::verify(program.program());
  promise(std::holds_alternative<vm::VerifiedProgram>(again), "a verified program is not verified again");
  promise(!vm::disassemble(program).empty(), "a program has a listing");
  check_bits(program, random_cloud(random, reach), workspace);
  const BoxSet boxes = random_boxes(random, reach);
  check_enclosures(program, boxes, random, workspace);
  check_ranges(program, boxes, random, workspace);
  check_slopes(program, boxes, random, workspace);
  check_parts(program, boxes, random, workspace);
}

}  // namespace fathom::fuzz
