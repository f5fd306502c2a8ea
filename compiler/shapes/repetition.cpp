// Rows of the domain operators that repeat a child, by the technique that domain.cpp calls a limit.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "compiler/shapes/about_axis.h"
#include "compiler/shapes/rows.h"
#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

// Repetition. Parameters: period, count, jitter (three each). Derived per axis: the number of evaluated copies to
// either side of a point (0: the nearest alone; kAll: every copy), and the distance of the other copies from the
// plane through the middle of the nearest copy. Derived after them: the child's reach and box.

constexpr double kAll = -1;
constexpr double kMaxCells = 8388608;  // 2^23: a float can still count the cells
constexpr int kMaxCopies = 512;

struct RepeatedAxis {
  double period, count, jitter;
  double sides, apart;  // derived
  double lo, hi;        // the child's box

  bool repeated() const { return period > 0; }
  bool endless() const { return count == 0; }
  double half() const { return !endless() && std::fmod(count, 2) == 0 ? 0.5 : 0; }
  double first() const { return endless() ? -kMaxCells : -std::floor(count / 2); }
  double last() const { return endless() ? kMaxCells - 1 : first() + count - 1; }
  double position(double number) const { return (number + half()) * period; }
  // Number of copies evaluated at each point: a whole number, which exceeds any `int` if the period is next to
  // nothing.
  double copies() const {
    if (!repeated()) return 1;
    return sides == kAll ? count : std::max(1.0, 2 * sides);
  }
};

struct Repeated {
  std::array<RepeatedAxis, 3> axes;
  double reach;
  bool jitters() const { return axes[0].jitter > 0 || axes[1].jitter > 0 || axes[2].jitter > 0; }
  bool limited() const {
    return std::any_of(axes.begin(), axes.end(), [](const RepeatedAxis& a) { return a.repeated() && a.sides > 0; });
  }
};

Repeated repeated(Params p) {
  Repeated r{};
  for (std::size_t i = 0; i < 3; ++i) {
    r.axes[i] = {p[i], p[3 + i], p[6 + i], p[9 + i], p[12 + i], p[16 + i], p[19 + i]};
  }
  r.reach = p[15];
  return r;
}

std::vector<double> derive_repetition(Params p, std::span<const NodeFacts> children) {
  const NodeFacts& child = children[0];
  std::vector<double> sides(3, 0), apart(3, 0);
  const bool jitters = p[6] > 0 || p[7] > 0 || p[8] > 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double period = p[i], count = p[3 + i], jitter = p[6 + i];
    if (period == 0) continue;
    const auto axis = static_cast<int>(i);
    const double lo = child.box.lo[axis] - jitter, hi = child.box.hi[axis] + jitter;
    const double extent = std::max({hi, -lo, 0.0});
    // The neighbour is then the mirror image and further away, unless jitter moves copies along any axis.
    const bool mirrored = child.symmetric[i] && !jitters && 2 * extent <= period;
    if (mirrored) continue;
    // Keeps the copies left out at least a quarter of a period away, so that steps are not too short.
    sides[i] = std::ceil((extent + std::max({0.0, lo, -hi})) / period + 0.25);
    if (count > 0 && count <= 2 * sides[i]) sides[i] = kAll;
    if (sides[i] > 0) apart[i] = sides[i] * period - extent;
  }
  std::vector<double> derived = sides;
  derived.insert(derived.end(), apart.begin(), apart.end());
  // The reach of an estimate is unknown. A quarter is what the estimates of fractals keep.
  derived.push_back(child.reach > 0 ? child.reach : 0.25);
  for (int i = 0; i < 3; ++i) derived.push_back(std::clamp(child.box.lo[i], -kNoLimit, kNoLimit));
  for (int i = 0; i < 3; ++i) derived.push_back(std::clamp(child.box.hi[i], -kNoLimit, kNoLimit));
  return derived;
}

ErrorText check_repetition(Params p) {
  if (!(p[0] >= 0 && p[1] >= 0 && p[2] >= 0) || p[0] + p[1] + p[2] == 0) {
    return "`period` must hold the distance between copies along each axis, 0 where there is one only; give at least "
           "one above 0";
  }
  for (std::size_t i = 3; i < 6; ++i) {
    if (p[i] < 0 || p[i] != std::floor(p[i]) || p[i] > 1e6) {
      return fmt::format("`count` holds {}; give whole numbers up to 1000000, 0 for copies without end", p[i]);
    }
  }
  if (p[6] < 0 || p[7] < 0 || p[8] < 0) return "`jitter` holds a negative number; give how far copies may be moved";
  return std::nullopt;
}

ErrorText check_repetition_child(Params p, std::span<const NodeFacts> children) {
  const Box& box = children[0].box;
  for (int i = 0; i < 3; ++i) {
    if (p[static_cast<std::size_t>(i)] == 0 || (std::isfinite(box.lo[i]) && std::isfinite(box.hi[i]))) continue;
    return fmt::format("the node has no end along {}, where it is repeated; cut it with an intersection first",
                       "xyz"[i]);
  }
  const Repeated r = repeated(spec(Kind::Repetition).with_derived(p, children));
  const double copies = r.axes[0].copies() * r.axes[1].copies() * r.axes[2].copies();
  if (copies <= kMaxCopies) return std::nullopt;
  return fmt::format(
      "the node reaches across so many cells that {} copies count at every point; at most {} are "
      "evaluated: make `period` larger or the node smaller",
      copies, kMaxCopies);
}

NodeFacts know_repetition(Params p, std::span<const NodeFacts> children) {
  const Repeated r = repeated(p);
  NodeFacts k = mapped(children[0]);
  double moved = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const RepeatedAxis& a = r.axes[i];
    const auto axis = static_cast<int>(i);
    const double inf = std::numeric_limits<double>::infinity();
    k.symmetric[i] = children[0].symmetric[i] && !r.jitters();
    if (!a.repeated() && a.jitter == 0) continue;
    // A copy may be as far from its cell's middle as the child reaches, and that distance cancels.
    const double reach = std::max(std::abs(a.lo), std::abs(a.hi)) + a.jitter;
    moved = std::max(moved, reach * std::max(1.0, children[0].lipschitz));
    k.box.lo[axis] = a.endless() && a.repeated() ? -inf : k.box.lo[axis] + a.position(a.first()) - a.jitter;
    k.box.hi[axis] = a.endless() && a.repeated() ? inf : k.box.hi[axis] + a.position(a.last()) + a.jitter;
  }
  k.cancellation += moved;
  k.inside = std::max(k.inside, Exactness::Bound);
  if (!r.limited()) return k;
  k = only_bound(k);
  k.lipschitz = std::max(k.lipschitz, r.reach);
  k.reach = std::min(k.reach, r.reach);
  k.reach_max = std::min(k.reach_max, k.reach);
  return k;
}

// Returns the six numbers of in_cell() in vm/interpret/domain-inl.h for the copy nearest to a point.
std::vector<double> nearest_cell(const RepeatedAxis& a) {
  if (!a.repeated()) return {0, 0, 0, 0, 0, 0};
  return {1 / a.period, 0.5 - a.half(), a.first(), a.last(), a.half(), a.period};
}

// Returns the difference between the number of the evaluated copy `index` and the number of the cell.
double copy_number(const RepeatedAxis& a, int index) {
  if (!a.repeated() || a.sides == 0) return 0;
  return a.sides == kAll ? a.first() + index : index + 1 - a.sides;
}

// Returns the six numbers of in_cell() for the copy `index`. Beyond the last copies the cell is the last cell with
// `sides` copies on either side, so that the program evaluates the same number of copies everywhere, all of which
// exist.
std::vector<double> cell_immediates(const RepeatedAxis& a, int index) {
  if (!a.repeated() || a.sides == 0) return nearest_cell(a);
  const double offset = copy_number(a, index) + a.half();
  if (a.sides == kAll) return {0, 0, 0, 0, offset, a.period};
  return {1 / a.period, -a.half(), a.first() + a.sides - 1, a.last() - a.sides, offset, a.period};
}

std::vector<Instruction> cell_chain(const Repeated& r, const std::array<int, 3>& index) {
  const auto fixed = [](const RepeatedAxis& a) { return !a.repeated() || a.sides == kAll; };
  if (!r.jitters() && std::all_of(r.axes.begin(), r.axes.end(), fixed)) {
    std::vector<double> by;
    for (std::size_t i = 0; i < 3; ++i) {
      by.push_back(r.axes[i].repeated() ? r.axes[i].position(r.axes[i].first() + index[i]) : 0);
    }
    return {{Opcode::Translate, by}};
  }
  std::vector<double> immediates;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> six = cell_immediates(r.axes[i], index[i]);
    immediates.insert(immediates.end(), six.begin(), six.end());
  }
  if (!r.jitters()) return {{Opcode::Cell, immediates}};
  for (const RepeatedAxis& a : r.axes) immediates.push_back(a.jitter);
  for (std::size_t i = 0; i < 3; ++i) immediates.push_back(copy_number(r.axes[i], index[i]));
  return {{Opcode::CellJitter, immediates}};
}

std::vector<double> limit_immediates(const Repeated& r) {
  std::vector<double> immediates;
  for (const RepeatedAxis& a : r.axes) {
    const std::vector<double> six = nearest_cell(a);
    immediates.insert(immediates.end(), six.begin(), six.end());
    const bool copies = a.repeated() && !a.endless();
    immediates.push_back(a.repeated() && a.sides > 0 ? a.apart : kNoLimit);
    immediates.push_back(a.repeated() && a.endless() ? -kNoLimit
                                                     : a.lo - a.jitter + (copies ? a.position(a.first()) : 0));
    immediates.push_back(a.repeated() && a.endless() ? kNoLimit
                                                     : a.hi + a.jitter + (copies ? a.position(a.last()) : 0));
  }
  return immediates;
}

Code repetition_code(Params p) {
  const Repeated r = repeated(p);
  Code code{.points = {}};
  for (int x = 0; x < r.axes[0].copies(); ++x) {
    for (int y = 0; y < r.axes[1].copies(); ++y) {
      for (int z = 0; z < r.axes[2].copies(); ++z) code.points.push_back(cell_chain(r, {x, y, z}));
    }
  }
  if (!r.limited()) return code;
  code.after = {{Opcode::CellLimit, limit_immediates(r)}};
  if (r.reach != 1) code.after.push_back({Opcode::Scale, {r.reach}});
  code.after.push_back({Opcode::Min});
  return code;
}

// Polar repetition. Parameter: count. Derived: the number of evaluated copies to either side (kAll: every copy), the
// angle of the child's middle about the y axis, the angle between the copies left out and the half-plane through the
// middle of the nearest copy (radians), the child's reach, its lowest and highest y, and its largest and smallest
// distance from the axis.

struct Wedge {
  double middle, half;  // radians
};

// Returns the wedge about the y axis that contains the box, or the whole turn if the box meets the axis.
Wedge wedge_of(const Box& box) {
  if (box.lo.x <= 0 && box.hi.x >= 0 && box.lo.z <= 0 && box.hi.z >= 0) return {0, std::numbers::pi};
  const double middle = vm::real::atan2(box.lo.z + box.hi.z, box.lo.x + box.hi.x);
  double half = 0;
  for (double x : {box.lo.x, box.hi.x}) {
    for (double z : {box.lo.z, box.hi.z}) {
      half = std::max(half, std::abs(std::remainder(vm::real::atan2(z, x) - middle, 2 * std::numbers::pi)));
    }
  }
  return {middle, half};
}

std::vector<double> derive_polar(Params p, std::span<const NodeFacts> children) {
  const NodeFacts& child = children[0];
  const Wedge wedge = wedge_of(child.box);
  const double sector = 2 * std::numbers::pi / p[0];
  double sides = std::ceil(wedge.half / sector + 0.25);
  if (2 * sides >= p[0] || wedge.half >= std::numbers::pi) sides = kAll;
  const double radius = radius_about_y(child.box) * (1 + kAside), margin = kAside * radius;
  return {sides,
          wedge.middle,
          sides == kAll ? 0 : sides * sector - wedge.half,
          child.reach > 0 ? child.reach : 0.25,
          std::clamp(child.box.lo.y - margin, -kNoLimit, kNoLimit),
          std::clamp(child.box.hi.y + margin, -kNoLimit, kNoLimit),
          radius,
          distance_from_axis(std::max({0.0, child.box.lo.x, -child.box.hi.x}),
                             std::max({0.0, child.box.lo.z, -child.box.hi.z}))};
}

ErrorText check_polar(Params p) {
  if (p[0] <= 100000) return std::nullopt;
  return fmt::format("`count` is {}; at most 100000 copies are possible", p[0]);
}

ErrorText check_polar_child(Params p, std::span<const NodeFacts> children) {
  if (ErrorText complaint = check_bounded_about_y(children, "a polar repetition")) return complaint;
  const double sides = derive_polar(p, children)[0], copies = sides == kAll ? p[0] : 2 * sides;
  if (copies <= kMaxCopies) return std::nullopt;
  return fmt::format(
      "{} copies count at every point, for the node reaches across them; at most {} are evaluated: use "
      "fewer or move the node further from the axis",
      copies, kMaxCopies);
}

NodeFacts know_polar(Params p, std::span<const NodeFacts> children) {
  NodeFacts k = mapped(children[0]);
  const double radius = radius_about_y(k.box);
  k.box = tube(radius, k.box.lo.y, k.box.hi.y);
  k.symmetric[1] = children[0].symmetric[1];
  k.inside = std::max(k.inside, Exactness::Bound);
  k.reach_max = std::min(k.reach_max, k.reach);
  if (p[1] == kAll) return k;
  k.box = tube(p[7], children[0].box.lo.y - kAside * p[7], children[0].box.hi.y + kAside * p[7]);
  k.cancellation += radius;   // the angle's sine and cosine are rounded
  k.reach = k.reach_max = 1;  // the box's own distance is part of the result
  k.lipschitz = std::max(1.0, k.lipschitz);
  return only_bound(k);
}

Code polar_code(Params p) {
  const double count = p[0], sides = p[1], middle = p[2], apart = p[3], reach = p[4];
  const double angle = 2 * std::numbers::pi / count;
  Code code{.points = {}};
  if (sides == kAll) {
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const double c = vm::real::cos(i * angle), s = vm::real::sin(i * angle);
      code.points.push_back({{Opcode::Affine, {c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0}}});
    }
    return code;
  }
  for (double i = 1 - sides; i <= sides; ++i) {
    code.points.push_back({{Opcode::Sector, {1 / angle, -middle / angle, angle, i}}});
  }
  code.after = {{Opcode::SectorLimit, {1 / angle, 0.5 - middle / angle, angle, middle, apart, p[8], p[5], p[6]}}};
  if (reach != 1) code.after.push_back({Opcode::Scale, {reach}});
  // From afar the neighbours' wedges seem close, but the box gives the distance of all copies.
  const double radius = p[7];
  code.after.insert(
      code.after.end(),
      {{Opcode::Min}, {Opcode::BoxBetween, {-radius, p[5], -radius, radius, p[6], radius}}, {Opcode::Max}});
  return code;
}

}  // namespace

std::vector<NodeSpec> repetition_rows() {
  constexpr auto kAlteration = Category::Alteration;
  return {
      {.kind = Kind::Repetition,
       .name = "repetition",
       .category = kAlteration,
       .params = {{"period", ParamType::Vec3, Rule::Any, kRequired, "from copy to copy along each axis; 0: one only"},
                  {"count", ParamType::Counts, Rule::Any, 0.0,
                   "copies along each axis, centred; 0: without end (2^23 copies to either side)"},
                  {"jitter", ParamType::Vec3, Rule::Any, 0.0, "how far each copy may be moved at random"}},
       .doc = "a node again and again",
       .check = check_repetition,
       .code = repetition_code,
       .derive_facts = know_repetition,
       .derive = derive_repetition,
       .check_children = check_repetition_child},
      {.kind = Kind::PolarRepetition,
       .name = "polar_repetition",
       .category = kAlteration,
       .params = {{"count", ParamType::Integer, Rule::Positive, kRequired, "copies in a full turn about the y axis"}},
       .doc = "a node again and again around the y axis",
       .operand = Sort::Solid,
       .check = check_polar,
       .code = polar_code,
       .derive_facts = know_polar,
       .derive = derive_polar,
       .check_children = check_polar_child},
  };
}

}  // namespace fathom::compiler
