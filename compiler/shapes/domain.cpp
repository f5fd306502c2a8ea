// Rows of the domain operators: they fold, repeat or bend the space a child is evaluated in.
//
// Each keeps three promises whatever the child: its zero set is the folded, repeated or bent solid; it changes nowhere
// faster than its Lipschitz constant; outside it never exceeds that constant times the distance. What makes that
// possible is the child's box, known before. Two devices recur:
//
//   meet   The map is evaluated at the nearest point of a convex region K that holds the solid (clamp_tube, clamp_box),
//          where its slope is bounded, and the distance to K is added at a right angle: for q nearest to p in K and s
//          in K the angle at q is at least a right one, so |p - s|^2 >= |p - q|^2 + |q - s|^2.
//   limit  Of endless copies only those near p are evaluated; the way to the others, known by the child's box, bounds
//          the result from above. It is chosen so that nothing jumps where the set of evaluated copies changes: there
//          it equals the least that any of them can be.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "compiler/affine.h"
#include "compiler/make_node.h"
#include "compiler/shapes/rows.h"
#include "vm/real.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

constexpr double kRadians = std::numbers::pi / 180;

// The largest singular value of [[a, b], [0, c]]: how much the map (x, y) -> (a x + b y, c y) stretches.
double largest_stretch(double a, double b, double c) {
  const double sum = a * a + b * b + c * c, determinant = a * c;
  return std::sqrt((sum + std::sqrt(std::max(0.0, sum * sum - 4 * determinant * determinant))) / 2);
}

double distance_from_axis(double x, double z) { return std::sqrt(x * x + z * z); }

// The greatest distance of the box from the y axis.
double radius_about_y(const Box& box) {
  return distance_from_axis(std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
                    std::max(std::abs(box.lo.z), std::abs(box.hi.z)));
}

// A box whose distance is part of a result is larger than the solid by this part of its size, so that on the solid's
// surface it is the solid's own distance that counts, and its material.
constexpr double kAside = 1e-3;

Box tube(double radius, double y0, double y1) { return {{-radius, y0, -radius}, {radius, y1, radius}}; }

Complaint check_bounded_about_y(std::span<const Knowledge> children, const char* what) {
  if (std::isfinite(radius_about_y(children[0].box))) return std::nullopt;
  return fmt::format("{} needs a node that ends in x and z; cut it with an intersection first", what);
}

Knowledge know_mirror(Params p, std::span<const Knowledge> children) {
  const Knowledge& child = children[0];
  Knowledge k = mapped(child);
  const glm::dvec3 n = glm::normalize(glm::dvec3(p[0], p[1], p[2]));
  for (int i = 0; i < 3; ++i) {
    if (std::abs(n[i]) != 1) continue;
    const double plane = p[3] * n[i];
    Box kept = child.box;
    (n[i] > 0 ? kept.lo : kept.hi)[i] = n[i] > 0 ? std::max(kept.lo[i], plane) : std::min(kept.hi[i], plane);
    const bool whole = kept.lo == child.box.lo && kept.hi == child.box.hi;
    k.box = kept;
    k.box.lo[i] = std::min(kept.lo[i], 2 * plane - kept.hi[i]);
    k.box.hi[i] = std::max(kept.hi[i], 2 * plane - kept.lo[i]);
    k.symmetric = child.symmetric;
    k.symmetric[static_cast<std::size_t>(i)] = p[3] == 0;
    k.inside = std::max(k.inside, Exactness::Bound);
    return whole ? k : only_bound(k);
  }
  // The two-fold image of the box; per-axis distances do not survive the reflection.
  const glm::dvec3 centre = (child.box.lo + child.box.hi) * 0.5, half = child.box.hi - centre;
  glm::dvec3 spread(0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) spread[i] += std::abs((i == j ? 1 : 0) - 2 * n[i] * n[j]) * half[j];
  }
  const glm::dvec3 moved = centre - 2 * (glm::dot(centre, n) - p[3]) * n;
  k.box = child.box.finite() ? unite(child.box, {moved - spread, moved + spread}) : Box::everything();
  k.reach_max = std::min(k.reach_max, k.reach);
  return only_bound(k);
}

std::vector<double> mirror_immediates(Params p) {
  const glm::dvec3 n = glm::normalize(glm::dvec3(p[0], p[1], p[2]));
  return {n.x, n.y, n.z, p[3]};
}
Code mirror_code(Params p) { return {.points = {{{Opcode::Mirror, mirror_immediates(p)}}}}; }

// Repetition. Parameters: period, count, jitter (three each). Derived for each axis: how many copies to either side of
// a point are evaluated (0: the nearest alone; kAll: every one), and how far the others keep from the plane through
// the middle of the nearest; then the child's reach and box.

constexpr double kAll = -1;
constexpr double kEndless = 8388608;  // 2^23: a float still counts the cells
constexpr double kNoLimit = 1e18;
constexpr int kMostCopies = 512;

struct RepeatedAxis {
  double period, count, jitter;
  double sides, apart;  // derived
  double lo, hi;        // the child's box

  bool repeated() const { return period > 0; }
  bool endless() const { return count == 0; }
  double half() const { return !endless() && std::fmod(count, 2) == 0 ? 0.5 : 0; }
  double first() const { return endless() ? -kEndless : -std::floor(count / 2); }
  double last() const { return endless() ? kEndless - 1 : first() + count - 1; }
  double position(double number) const { return (number + half()) * period; }
  // Copies evaluated at each point.
  int copies() const {
    if (!repeated()) return 1;
    if (sides == kAll) return static_cast<int>(count);
    return std::max(1, 2 * static_cast<int>(sides));
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

std::vector<double> derive_repetition(Params p, std::span<const Knowledge> children) {
  const Knowledge& child = children[0];
  std::vector<double> sides(3, 0), apart(3, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const double period = p[i], count = p[3 + i], jitter = p[6 + i];
    if (period == 0) continue;
    const auto axis = static_cast<int>(i);
    const double lo = child.box.lo[axis] - jitter, hi = child.box.hi[axis] + jitter;
    const double extent = std::max({hi, -lo, 0.0});
    const bool mirrored = child.symmetric[i] && jitter == 0 && 2 * extent <= period;
    if (mirrored) continue;
    // At least a quarter of a period to what is left out, so that steps are not too short.
    sides[i] = std::ceil((extent + std::max({0.0, lo, -hi})) / period + 0.25);
    if (count > 0 && count <= 2 * sides[i]) sides[i] = kAll;
    if (sides[i] > 0) apart[i] = sides[i] * period - extent;
  }
  std::vector<double> derived = sides;
  derived.insert(derived.end(), apart.begin(), apart.end());
  // Of an estimate nothing is known; a quarter is what fractals' estimates hold to.
  derived.push_back(child.reach > 0 ? child.reach : 0.25);
  for (int i = 0; i < 3; ++i) derived.push_back(std::clamp(child.box.lo[i], -kNoLimit, kNoLimit));
  for (int i = 0; i < 3; ++i) derived.push_back(std::clamp(child.box.hi[i], -kNoLimit, kNoLimit));
  return derived;
}

Complaint check_repetition(Params p) {
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

Complaint check_repetition_child(Params p, std::span<const Knowledge> children) {
  const Box& box = children[0].box;
  for (int i = 0; i < 3; ++i) {
    if (p[static_cast<std::size_t>(i)] == 0 || (std::isfinite(box.lo[i]) && std::isfinite(box.hi[i]))) continue;
    return fmt::format("the node has no end along {}, where it is repeated; cut it with an intersection first",
                       "xyz"[i]);
  }
  std::vector<double> all(p.begin(), p.end());
  const std::vector<double> derived = derive_repetition(p, children);
  all.insert(all.end(), derived.begin(), derived.end());
  const Repeated r = repeated(all);
  const double copies = 1.0 * r.axes[0].copies() * r.axes[1].copies() * r.axes[2].copies();
  if (copies <= kMostCopies) return std::nullopt;
  return fmt::format("the node reaches across so many cells that {} copies count at every point; at most {} are "
                     "evaluated: make `period` larger or the node smaller",
                     copies, kMostCopies);
}

Knowledge know_repetition(Params p, std::span<const Knowledge> children) {
  const Repeated r = repeated(p);
  Knowledge k = mapped(children[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const RepeatedAxis& a = r.axes[i];
    const auto axis = static_cast<int>(i);
    const double inf = std::numeric_limits<double>::infinity();
    k.symmetric[i] = children[0].symmetric[i] && !r.jitters();
    if (!a.repeated() && a.jitter == 0) continue;
    k.box.lo[axis] = a.endless() && a.repeated() ? -inf : k.box.lo[axis] + a.position(a.first()) - a.jitter;
    k.box.hi[axis] = a.endless() && a.repeated() ? inf : k.box.hi[axis] + a.position(a.last()) + a.jitter;
  }
  k.inside = std::max(k.inside, Exactness::Bound);
  if (!r.limited()) return k;
  k = only_bound(k);
  k.reach = std::min(k.reach, r.reach);
  k.reach_max = std::min(k.reach_max, k.reach);
  return k;
}

// The six numbers of in_cell in vm/domain-inl.h for the copy `index` of those evaluated.
std::vector<double> cell_immediates(const RepeatedAxis& a, int index) {
  if (!a.repeated()) return {0, 0, 0, 0, 0, 0};
  const double inverse = 1 / a.period;
  if (a.sides == kAll) {
    const double number = a.first() + index;
    return {0, 0, number, number, a.half(), a.period};
  }
  if (a.sides == 0) return {inverse, 0.5 - a.half(), a.first(), a.last(), a.half(), a.period};
  return {inverse, index + 1 - a.sides - a.half(), a.first(), a.last(), a.half(), a.period};
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
  return {{Opcode::CellJitter, immediates}};
}

std::vector<double> limit_immediates(const Repeated& r) {
  std::vector<double> immediates;
  for (const RepeatedAxis& a : r.axes) {
    RepeatedAxis nearest = a;
    nearest.sides = 0;
    const std::vector<double> six = cell_immediates(nearest, 0);
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

// Polar repetition. Parameter: count. Derived: copies evaluated to either side (kAll: every one), the angle of the
// child's middle about the y axis, the angle that copies left out keep from the half-plane through the nearest's
// middle (radians), the child's reach, its lowest and highest y, and its distance from the axis.

struct Wedge {
  double middle, half;  // radians
};

// The wedge about the y axis that holds the box; the whole turn when the box meets the axis.
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

std::vector<double> derive_polar(Params p, std::span<const Knowledge> children) {
  const Knowledge& child = children[0];
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
          radius};
}

Complaint check_polar(Params p) {
  if (p[0] <= 100000) return std::nullopt;
  return fmt::format("`count` is {}; at most 100000 copies are possible", p[0]);
}

Complaint check_polar_child(Params p, std::span<const Knowledge> children) {
  if (Complaint complaint = check_bounded_about_y(children, "a polar repetition")) return complaint;
  const double sides = derive_polar(p, children)[0], copies = sides == kAll ? p[0] : 2 * sides;
  if (copies <= kMostCopies) return std::nullopt;
  return fmt::format("{} copies count at every point, for the node reaches across them; at most {} are evaluated: use "
                     "fewer or move the node further from the axis",
                     copies, kMostCopies);
}

Knowledge know_polar(Params p, std::span<const Knowledge> children) {
  Knowledge k = mapped(children[0]);
  const double radius = radius_about_y(k.box);
  k.box = tube(radius, k.box.lo.y, k.box.hi.y);
  k.symmetric[1] = children[0].symmetric[1];
  k.inside = std::max(k.inside, Exactness::Bound);
  k.reach_max = std::min(k.reach_max, k.reach);
  if (p[1] == kAll) return k;
  k.box = tube(p[7], children[0].box.lo.y - kAside * p[7], children[0].box.hi.y + kAside * p[7]);
  k.magnitude += radius;  // the angle's sine and cosine are rounded
  k.reach = k.reach_max = 1;  // the box's own distance is part of the result
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
    code.points.push_back({{Opcode::Sector, {1 / angle, i - middle / angle, angle}}});
  }
  code.after = {{Opcode::SectorLimit, {1 / angle, 0.5 - middle / angle, angle, middle, apart, p[5], p[6]}}};
  if (reach != 1) code.after.push_back({Opcode::Scale, {reach}});
  // From afar the neighbours' wedges seem close: the box says how far all of it is.
  const double radius = p[7];
  code.after.insert(code.after.end(), {{Opcode::Min},
                                       {Opcode::BoxBetween, {-radius, p[5], -radius, radius, p[6], radius}},
                                       {Opcode::Max}});
  return code;
}

// Twist. Parameter: turn (degrees per unit of y). Derived: the tube's radius, the Lipschitz constant.
// For points of the tube, |T(p) - T(q)|^2 <= (a + k R b)^2 + b^2 with a, b their distances across and along the axis
// and R the tube's radius: the largest stretch of [[1, kR], [0, 1]].

std::vector<double> derive_twist(Params p, std::span<const Knowledge> children) {
  const double radius = radius_about_y(children[0].box);
  return {radius, children[0].lipschitz * largest_stretch(1, std::abs(p[0]) * kRadians * radius, 1)};
}

Complaint check_twist_child(Params, std::span<const Knowledge> children) {
  return check_bounded_about_y(children, "a twist");
}

// A child evaluated within a tube, by its parts across and along the axis.
Knowledge in_tube(const Knowledge& child, double radius, double lipschitz, double reach) {
  Knowledge k = only_bound(mapped(child));
  k.box = tube(radius, child.box.lo.y, child.box.hi.y);
  k.lipschitz = lipschitz;
  k.reach = k.reach_max = reach;
  return k;
}

Knowledge know_twist(Params p, std::span<const Knowledge> children) {
  const double rate = std::abs(p[0]) * kRadians, radius = p[1];
  const Box& box = children[0].box;
  Knowledge k = in_tube(children[0], radius, p[2], children[0].reach);
  // The angle is rounded in proportion to itself; an endless column is judged by its first thousand units.
  const double highest = std::min(1000.0, std::max(std::abs(box.lo.y), std::abs(box.hi.y)));
  k.magnitude = (k.magnitude + radius * (1 + 0.2 * rate * highest)) * children[0].lipschitz;
  return k;
}

std::vector<Instruction> meet_tube(double radius, double lipschitz) {
  std::vector<Instruction> after = {{Opcode::InfiniteCylinder, {radius}}};
  if (lipschitz != 1) after.push_back({Opcode::Scale, {lipschitz}});
  after.push_back({Opcode::Meet});
  return after;
}

Code twist_code(Params p) {
  return {.points = {{{Opcode::ClampTube, {p[1]}}, {Opcode::Twist, {-p[0] * kRadians}}}},
          .after = meet_tube(p[1], p[2])};
}

// Taper. Parameters: bottom and top scale, half height. Derived: the tube's radius, the Lipschitz constant. With
// q = x / s(y): dq = dx / s - q s' / s dy, and |q| <= R / s_least in the tube of radius R.

struct Scales {
  double least, most, slope;
};
Scales scales(Params p) { return {std::min(p[0], p[1]), std::max(p[0], p[1]), (p[1] - p[0]) / (2 * p[2])}; }

std::vector<double> derive_taper(Params p, std::span<const Knowledge> children) {
  const Scales s = scales(p);
  const double radius = radius_about_y(children[0].box) * s.most;
  const double shear = std::abs(s.slope) * radius / (s.least * s.least);
  return {radius, children[0].lipschitz * largest_stretch(1 / s.least, shear, 1)};
}

Complaint check_taper_child(Params, std::span<const Knowledge> children) {
  return check_bounded_about_y(children, "a taper");
}

Knowledge know_taper(Params p, std::span<const Knowledge> children) {
  const Scales s = scales(p);
  return in_tube(children[0], p[3], p[4], children[0].reach * std::min(1.0, 1 / s.most));
}

Code taper_code(Params p) {
  const Scales s = scales(p);
  return {.points = {{{Opcode::ClampTube, {p[3]}},
                      {Opcode::Taper, {(p[0] + p[1]) / 2, s.slope, s.least, s.most}}}},
          .after = meet_tube(p[3], p[4])};
}

// Bend. Parameter: turn (degrees per unit of x, towards +y). Derived: the inner radius, the Lipschitz constant, how far
// the solid keeps from the inner circle and from the seam (in the child's distance), z range, reach, the box.
// The map keeps radii and multiplies lengths across them by (1/k) / rho.

struct Arc {
  double radius, side;        // of the x axis when bent; +1 towards +y
  double innermost, outermost;  // radii of the solid
  double farthest;            // |x| of the child
};
Arc arc(double turn, const Box& box) {
  const double radius = 1 / (std::abs(turn) * kRadians);
  const bool up = turn > 0;
  return {radius, up ? 1.0 : -1.0, radius - (up ? box.hi.y : -box.lo.y), radius + (up ? -box.lo.y : box.hi.y),
          std::max(std::abs(box.lo.x), std::abs(box.hi.x))};
}

// The box around the sector of a ring that the child's box becomes.
Box bent_box(const Arc& a, const Box& box) {
  const double from = box.lo.x / a.radius, to = box.hi.x / a.radius;
  std::vector<double> angles = {from, to};
  for (double quarter = -2; quarter <= 2; ++quarter) {
    const double angle = quarter * std::numbers::pi / 2;
    if (angle > from && angle < to) angles.push_back(angle);
  }
  Box bent;
  for (double angle : angles) {
    for (double rho : {a.innermost, a.outermost}) {
      const double x = rho * vm::real::sin(angle), y = (a.radius - rho * vm::real::cos(angle)) * a.side;
      bent = unite(bent, {{x, y, box.lo.z}, {x, y, box.hi.z}});
    }
  }
  return bent;
}

std::vector<double> derive_bend(Params p, std::span<const Knowledge> children) {
  // Closer to the solid's inner edge: a smaller constant but shorter steps near the centre.
  constexpr double kInner = 0.8;
  const Knowledge& child = children[0];
  const Arc a = arc(p[0], child.box);
  const double inner = kInner * a.innermost, reach = child.reach > 0 ? child.reach : 0.25;
  const Box exact = bent_box(a, child.box);
  const Box box = exact.grown(kAside * std::max(exact.hi.x - exact.lo.x, exact.hi.y - exact.lo.y));
  return {a.radius,
          a.side,
          inner,
          child.lipschitz * std::max(1.0, a.radius / inner),
          reach * (a.innermost - inner),
          reach * (std::numbers::pi * a.radius - a.farthest),
          std::clamp(box.lo.z, -kNoLimit, kNoLimit),
          std::clamp(box.hi.z, -kNoLimit, kNoLimit),
          reach,
          box.lo.x,
          box.lo.y,
          box.hi.x,
          box.hi.y};
}

Complaint check_bend(Params p) {
  if (p[0] != 0) return std::nullopt;
  return "`turn` is 0, which bends nothing; leave the bend out or give degrees per unit of x";
}

Complaint check_bend_child(Params p, std::span<const Knowledge> children) {
  const Box& box = children[0].box;
  for (int i = 0; i < 2; ++i) {
    if (!std::isfinite(box.lo[i]) || !std::isfinite(box.hi[i])) {
      return fmt::format("a bend needs a node that ends in x and y, and this has no end along {}", "xy"[i]);
    }
  }
  const Arc a = arc(p[0], box);
  if (a.farthest >= std::numbers::pi * a.radius) {
    return fmt::format("the node reaches to x = {:.4g} and would bend round more than a full turn; `turn` must be less "
                       "than {:.4g}",
                       a.farthest, 180 / a.farthest);
  }
  if (a.innermost <= 1e-3 * a.radius) {
    return fmt::format("the node is thicker than the bend's radius of {:.4g} on the inner side; make `turn` smaller",
                       a.radius);
  }
  return std::nullopt;
}

Knowledge know_bend(Params p, std::span<const Knowledge> children) {
  const Knowledge& child = children[0];
  Knowledge k = only_bound(mapped(child));
  k.box.lo.x = p[10], k.box.lo.y = p[11], k.box.hi.x = p[12], k.box.hi.y = p[13];
  k.box.lo.z = p[7] <= -kNoLimit ? k.box.lo.z : p[7];
  k.box.hi.z = p[8] >= kNoLimit ? k.box.hi.z : p[8];
  k.symmetric = {child.symmetric[0], false, child.symmetric[2]};
  k.lipschitz = p[4];
  k.reach = k.reach_max = 1;  // the box's own distance is part of the result
  k.magnitude = (child.magnitude + 2 * p[1]) * child.lipschitz;
  return k;
}

Code bend_code(Params p) {
  const double radius = p[1], side = p[2], inner = p[3];
  Code code{.points = {{{Opcode::Bend, {radius, side, inner}}}}};
  code.after = {{Opcode::BendLimit, {radius, side, inner, p[5], p[6], p[7], p[8], p[9]}},
                {Opcode::Min},
                {Opcode::BoxBetween, {p[10], p[11], p[7], p[12], p[13], p[8]}},
                {Opcode::Max}};
  return code;
}

// Shear moves x and z by a multiple of y: a Transform like any other.

NodeId build_shear(NodeMaker& maker, Params p, std::span<const NodeId> children, const Origin& origin) {
  std::vector<double> params = {1, -p[0], 0, 0, 0, 1, 0, 0, 0, -p[1], 1, 0};
  // The least a distance shrinks by, so that it stays one from below.
  params.push_back(1 / stretch(Affine::from_params(params)).most);
  return maker.make(Kind::Transform, params, children, origin);
}

}  // namespace

std::vector<NodeSpec> domain_rows() {
  constexpr auto kAlteration = Category::Alteration;
  return {
      {.kind = Kind::Mirror,
       .name = "mirror",
       .category = kAlteration,
       .params = {{"normal", ParamType::Vec3, Rule::NotZero, kRequired, "of the plane, towards the side that is kept"},
                  number("offset", "of the plane from the origin, along the normal", 0.0)},
       .doc = "one side of a plane, and its mirror image",
       .code = mirror_code,
       .know = know_mirror},
      {.kind = Kind::Repetition,
       .name = "repetition",
       .category = kAlteration,
       .params = {{"period", ParamType::Vec3, Rule::Any, kRequired, "from copy to copy along each axis; 0: one only"},
                  {"count", ParamType::Counts, Rule::Any, 0.0, "copies along each axis, centred; 0: without end"},
                  {"jitter", ParamType::Vec3, Rule::Any, 0.0, "how far each copy may be moved at random"}},
       .doc = "a node again and again",
       .check = check_repetition,
       .code = repetition_code,
       .know = know_repetition,
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
       .know = know_polar,
       .derive = derive_polar,
       .check_children = check_polar_child},
      {.kind = Kind::Shear,
       .name = "shear",
       .category = kAlteration,
       .params = {{"shift", ParamType::Vec2, Rule::Any, kRequired, "how far x and z move per unit of y"}},
       .doc = "a node whose higher parts are moved aside",
       .operand = Sort::Solid,
       .build = build_shear},
      {.kind = Kind::Twist,
       .name = "twist",
       .category = kAlteration,
       .params = {number("turn", "degrees per unit of y")},
       .doc = "a node turned about the y axis, more the higher",
       .operand = Sort::Solid,
       .code = twist_code,
       .know = know_twist,
       .derive = derive_twist,
       .check_children = check_twist_child},
      {.kind = Kind::Bend,
       .name = "bend",
       .category = kAlteration,
       .params = {number("turn", "degrees per unit of x, towards +y")},
       .doc = "a node bent along x into a circular arc",
       .operand = Sort::Solid,
       .check = check_bend,
       .code = bend_code,
       .know = know_bend,
       .derive = derive_bend,
       .check_children = check_bend_child},
      {.kind = Kind::Taper,
       .name = "taper",
       .category = kAlteration,
       .params = {length("bottom", "scale in x and z at y = -half_height"),
                  length("top", "scale in x and z at y = half_height"),
                  length("half_height", "where the scale stops changing")},
       .doc = "a node made thinner or thicker along y",
       .operand = Sort::Solid,
       .code = taper_code,
       .know = know_taper,
       .derive = derive_taper,
       .check_children = check_taper_child},
  };
}

}  // namespace fathom::compiler
