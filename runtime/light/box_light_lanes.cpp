// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/light/box_light_lanes.h"

#include <cstddef>

#include "runtime/base/angle.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/light/box_light_lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = vm::HWY_NAMESPACE::RealBatch;
using DoublesMask = vm::HWY_NAMESPACE::BatchMaskOf<double>;
using Indices = hn::RebindToSigned<Doubles::Tag>;

HWY_INLINE Doubles real(double value) { return Doubles::broadcast(value); }
// Points of one register. The lanes past the last have zeros in place of numbers.
struct Points {
  std::size_t first;
  hn::Mask<Doubles::Tag> given;

  HWY_INLINE Doubles load(const double* row) const { return {hn::MaskedLoad(given, Doubles::Tag(), row + first)}; }
};

HWY_INLINE Doubles clamped(Doubles value, Doubles lo, Doubles hi) { return max(min(value, hi), lo); }

// A rectangle in the plane at distance z from the origin.
struct Rectangle {
  Doubles x0, x1, y0, y1, z;
  Doubles z2, c2, g0, widths;

  HWY_INLINE Rectangle(Doubles left, Doubles right, Doubles bottom, Doubles top, Doubles distance)
      : x0(left), x1(right), y0(bottom), y1(top), z(distance), z2(z * z) {
    const Doubles nearest = max(max(y0, -y1), real(0));
    c2 = z2 + nearest * nearest;
    g0 = sine(x0, c2);
    widths = sine(x1, c2) - g0;
  }

  struct Sample {
    Doubles x, y, pdf;  // per solid angle
  };

  HWY_INLINE Sample sample(Doubles u, Doubles v) const {
    const Doubles g = g0 + u * widths;
    const Doubles x = clamped(g * sqrt(c2 / max(real(1) - g * g, real(kLeast))), x0, x1);
    const Doubles d2 = x * x + z2, h0 = sine(y0, d2), heights = sine(y1, d2) - h0;
    const Doubles h = h0 + v * heights;
    return {x, clamped(h * sqrt(d2 / max(real(1) - h * h, real(kLeast))), y0, y1), pdf(x, d2, heights)};
  }
  // Returns the density at any point with this x.
  HWY_INLINE Doubles pdf(Doubles x) const {
    const Doubles d2 = x * x + z2;
    return pdf(x, d2, sine(y1, d2) - sine(y0, d2));
  }

 private:
  static constexpr double kLeast = 1e-12;

  // Returns a / sqrt(a^2 + b2): the integral of b2 (t^2 + b2)^(-3/2) up to a.
  HWY_INLINE static Doubles sine(Doubles a, Doubles b2) { return a / sqrt(a * a + b2); }
  // Converts (c2 r^-3 / widths) (d2 s^-3 / heights) per area, with r^2 = x^2 + c2 and s^2 = x^2 + y^2 + z^2, to solid
  // angle. 0 if the rectangle is too small or seen from its edge.
  HWY_INLINE Doubles pdf(Doubles x, Doubles d2, Doubles heights) const {
    const Doubles r2 = x * x + c2;
    const Doubles density = c2 * d2 / (r2 * sqrt(r2) * widths * heights * z);
    return select((widths > real(kLeast)) & (heights > real(kLeast)), density, real(0));
  }
};

// Boxes as seen from shading points, in the boxes' spaces.
struct SeenBoxes {
  Doubles turn[3][3];       // the boxes' axes
  Doubles low[3], high[3];  // corners from the shading point
  Doubles depth[3];         // distance of the face towards the point across an axis, negative within the slab
  Doubles weight[3];        // of that face

  // number(n): the n-th number of the boxes.
  template <class Number>
  HWY_INLINE void set(const Number& number, const BoxLightRows& rows, Points points) {
    Doubles off[3], place[3], middle2[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 3; ++k) turn[axis][k] = number(3 * axis + k);
      off[axis] = points.load(rows.from[axis]) - number(9 + axis);
    }
    turn_back(off, place);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = number(12 + axis) - place[axis];
      high[axis] = number(15 + axis) - place[axis];
      depth[axis] = max(low[axis], -high[axis]);
      const Doubles middle = real(0.5) * (low[axis] + high[axis]);
      middle2[axis] = middle * middle;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
      const Doubles z = depth[axis], d2 = z * z + middle2[j] + middle2[k];
      const Doubles flat = (high[j] - low[j]) * (high[k] - low[k]) * z;
      const Doubles solid_angle = real(1) / (d2 * sqrt(d2) / flat + real(1 / (2 * kPi)));
      weight[axis] = select(z > real(0), number(18 + axis) * solid_angle, real(0));
    }
  }
  // Turns a vector into the boxes' spaces.
  HWY_INLINE void turn_back(const Doubles* vector, Doubles* local) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      local[axis] = turn[axis][0] * vector[0] + turn[axis][1] * vector[1] + turn[axis][2] * vector[2];
  }
  HWY_INLINE Doubles sum() const { return weight[0] + weight[1] + weight[2]; }
};

// An axis for each lane.
struct Axes {
  DoublesMask first, second;

  HWY_INLINE Doubles pick(Doubles a, Doubles b, Doubles c) const { return select(first, a, select(second, b, c)); }
  HWY_INLINE Doubles pick(const Doubles* of) const { return pick(of[0], of[1], of[2]); }
  HWY_INLINE Rectangle face(const SeenBoxes& seen) const {
    const Doubles *lo = seen.low, *hi = seen.high;
    return {pick(lo[1], lo[2], lo[0]), pick(hi[1], hi[2], hi[0]), pick(lo[2], lo[0], lo[1]),
            pick(hi[2], hi[0], hi[1]), pick(seen.depth)};
  }
};

// Chooses an axis by a number, and makes the number uniform again.
HWY_INLINE Axes choose(const SeenBoxes& seen, Doubles& u) {
  const Doubles none = real(0), *w = seen.weight;
  Doubles rest = u * seen.sum();
  const DoublesMask first = (rest < w[0]) | !((w[1] > none) | (w[2] > none));
  rest = select(first, rest, rest - w[0]);
  const Axes axes{first, (!first) & ((rest < w[1]) | !(w[2] > none))};
  rest = select(first | axes.second, rest, rest - w[1]);
  u = clamped(rest / axes.pick(w), none, real(1));
  return axes;
}

template <class Number>
HWY_INLINE void sample_register(const Number& number, Points points, BoxLightRows& rows) {
  SeenBoxes seen;
  seen.set(number, rows, points);
  Doubles u = points.load(rows.u);
  const Axes axes = choose(seen, u);
  const Rectangle face = axes.face(seen);
  const Rectangle::Sample at = face.sample(u, points.load(rows.v));
  const std::size_t i = points.first;
  Doubles ahead[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    ahead[axis] = select(seen.low[axis] > real(0), seen.low[axis], seen.high[axis]);
  const Doubles way[3] = {axes.pick(ahead[0], at.y, at.x), axes.pick(at.x, ahead[1], at.y),
                          axes.pick(at.y, at.x, ahead[2])};
  for (std::size_t k = 0; k < 3; ++k)
    (seen.turn[0][k] * way[0] + seen.turn[1][k] * way[1] + seen.turn[2][k] * way[2]).store(rows.way[k] + i);
  const Doubles distance = sqrt(at.x * at.x + at.y * at.y + face.z2), sum = seen.sum();
  distance.store(rows.distance + i);
  (face.z / distance).store(rows.cosine + i);
  const Indices integers;
  hn::StoreU(hn::ConvertTo(integers, axes.pick(real(0), real(1), real(2)).v), integers, rows.axis + i);
  select(sum > real(0), axes.pick(seen.weight) / sum * at.pdf, real(0)).store(rows.pdf + i);
}

// The face of a point is the nearest. It is sampled only from its own side.
template <class Number>
HWY_INLINE void pdf_register(const Number& number, Points points, BoxLightRows& rows) {
  SeenBoxes seen;
  seen.set(number, rows, points);
  Doubles way[3], outside[3], same_side[3];
  const Doubles turned[3] = {points.load(rows.way[0]), points.load(rows.way[1]), points.load(rows.way[2])};
  seen.turn_back(turned, way);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Doubles below = seen.low[axis] - way[axis], above = way[axis] - seen.high[axis];
    outside[axis] = max(below, above);
    const DoublesMask low = below > above, from_low = seen.low[axis] > real(0);
    same_side[axis] = select((low & from_low) | ((!low) & (!from_low)), real(1), real(0));
  }
  const DoublesMask first = (outside[0] >= outside[1]) & (outside[0] >= outside[2]);
  const Axes axes{first, (!first) & (outside[1] >= outside[2])};
  const Doubles weight = axes.pick(seen.weight), pdf = axes.face(seen).pdf(axes.pick(way[1], way[2], way[0]));
  select(weight > real(0), axes.pick(same_side) * (weight / seen.sum() * pdf), real(0))
      .store(rows.pdf + points.first);
}

// Calls act(number, points, rows) for each register of points, with the numbers of their lights.
template <class Act>
HWY_INLINE void for_registers(std::span<const BoxLight> lights, std::size_t count, BoxLightRows& rows,
                              const Act& act) {
  constexpr std::size_t kNumbers = sizeof(BoxLight) / sizeof(double);
  static_assert(kNumbers == 21 && offsetof(BoxLight, translation) == 9 * sizeof(double));
  const double* const numbers = &lights[0].rotation[0][0];
  const Indices integers;
  for (std::size_t i = 0; i < count; i += vm::HWY_NAMESPACE::kLanesOf<double>) {
    const Points points{i, hn::FirstN(Doubles::Tag(), count - i)};
    if (lights.size() == 1) {
      act([&](std::size_t n) HWY_ATTR { return real(numbers[n]); }, points, rows);
      continue;
    }
    const auto given = hn::FirstN(integers, count - i);
    const auto at = hn::Mul(hn::MaskedLoad(given, integers, rows.light + i), hn::Set(integers, kNumbers));
    act([&](std::size_t n) HWY_ATTR { return Doubles{hn::GatherIndex(Doubles::Tag(), numbers + n, at)}; }, points,
        rows);
  }
}

void sample_boxes(std::span<const BoxLight> lights, std::size_t count, BoxLightRows& rows) {
  for_registers(lights, count, rows, [](const auto& number, Points points, BoxLightRows& own) HWY_ATTR {
    sample_register(number, points, own);
  });
}

void set_box_pdfs(std::span<const BoxLight> lights, std::size_t count, BoxLightRows& rows) {
  for_registers(lights, count, rows, [](const auto& number, Points points, BoxLightRows& own) HWY_ATTR {
    pdf_register(number, points, own);
  });
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(sample_boxes);
HWY_EXPORT(set_box_pdfs);

void sample_box_lights(std::span<const BoxLight> lights, std::size_t count, BoxLightRows& rows) {
  HWY_DYNAMIC_DISPATCH(sample_boxes)(lights, count, rows);
}

void set_box_light_pdfs(std::span<const BoxLight> lights, std::size_t count, BoxLightRows& rows) {
  HWY_DYNAMIC_DISPATCH(set_box_pdfs)(lights, count, rows);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
