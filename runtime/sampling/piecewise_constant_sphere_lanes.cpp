// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/sampling/piecewise_constant_sphere_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/sampling/piecewise_constant_sphere_lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "runtime/sampling/warp-inl.h"
#include "vm/number/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

constexpr float kInverseTurn = kInversePi / 2;
using IntLanes = hn::RebindToSigned<hn::ScalableTag<float>>;
using Ints = hn::Vec<IntLanes>;

HWY_INLINE Ints integer(int value) { return hn::Set(IntLanes(), value); }
// Requires a value between the least and the greatest int.
HWY_INLINE Ints to_integer(Floats value) { return hn::ConvertTo(IntLanes(), value.v); }
// A NaN becomes `high`.
HWY_INLINE Floats clamped(Floats value, float low, float high) { return max(min(value, number(high)), number(low)); }

void direct_lanes(std::size_t count, const PolarRows& polar, DirectionRows& rows) {
  for (std::size_t i = 0; i < count; i += vm::HWY_NAMESPACE::kLanes) {
    const Floats turns = Floats::load(polar.turns + i), distance = Floats::load(polar.distance + i);
    const SinesAndCosines turn = sincos_turn(clamped(turns - floor(turns), 0, 1));
    const Floats sine = sqrt(max(distance * (number(2) - distance), number(0)));
    (-(sine * turn.sin)).store(rows.direction[0] + i);
    (Floats::load(polar.pole + i) * (number(1) - distance)).store(rows.direction[1] + i);
    (sine * turn.cos).store(rows.direction[2] + i);
  }
}

// The polar angle is that of the point (distance from the axis, height), because the height alone has few digits near
// the poles.
void find_lanes(const SphereTables& tables, float turn, std::size_t count, const DirectionRows& rows,
                SphereCellRows& places) {
  const float width = static_cast<float>(tables.width), height = static_cast<float>(tables.height);
  for (std::size_t i = 0; i < count; i += vm::HWY_NAMESPACE::kLanes) {
    const Floats x = Floats::load(rows.direction[0] + i), y = Floats::load(rows.direction[1] + i),
                 z = Floats::load(rows.direction[2] + i);
    const Floats turns = vm::HWY_NAMESPACE::atan2(-x, z) * number(kInverseTurn) - number(turn);
    const Floats polar = vm::HWY_NAMESPACE::atan2(sqrt(x * x + z * z), y) * number(kInversePi);
    const Floats across = (turns - floor(turns)) * number(width) - number(0.5f);
    const Floats down = polar * number(height) - number(0.5f);
    const Floats column = clamped(floor(across), -1, width - 1), row = clamped(floor(down), -1, height - 1);
    const auto line = hn::Mul(hn::Add(to_integer(row), integer(1)), integer(tables.width + 2));
    const auto cell = hn::Add(hn::Add(line, to_integer(column)), integer(1));
    const Floats along = clamped(across - column, 0, 1), below = clamped(down - row, 0, 1);
    hn::Store(cell, IntLanes(), places.cell + i);
    along.store(places.along + i);
    below.store(places.down + i);
    const auto step = [&](Floats share, int by) HWY_ATTR {
      const auto past = hn::RebindMask(IntLanes(), (share >= number(0.5f)).m);
      return hn::IfThenElseZero(past, integer(by));
    };
    hn::Store(hn::Add(hn::Add(cell, step(along, 1)), step(below, tables.width + 2)), IntLanes(), places.own + i);
  }
}

// A register holds the three channels of a cell, where it has four lanes.
void interpolate_lanes(const SphereTables& tables, std::size_t count, const SphereCellRows& places,
                       DirectionRows& rows) {
  const hn::CappedTag<float, 4> four;
  const auto one = hn::Set(four, 1.0f);
  const SphereCell* cells = tables.cells.data();
  for (std::size_t i = 0; i < count; ++i) {
    const SphereCell *upper = cells + places.cell[i], *lower = upper + tables.width + 2;
    const auto a = hn::Set(four, places.along[i]), b = hn::Set(four, places.down[i]);
    for (std::size_t c = 0; c < 4; c += hn::Lanes(four)) {
      const auto across = [&](const SphereCell* row) HWY_ATTR {
        return hn::Add(hn::Mul(hn::Sub(one, a), hn::Load(four, row[0].light + c)),
                       hn::Mul(a, hn::Load(four, row[1].light + c)));
      };
      const auto light = hn::Add(hn::Mul(hn::Sub(one, b), across(upper)), hn::Mul(b, across(lower)));
      hn::Store(light, four, rows.light[i] + c);
    }
    rows.light[i][3] = cells[places.own[i]].light[3];
  }
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(direct_lanes);
HWY_EXPORT(find_lanes);
HWY_EXPORT(interpolate_lanes);

void set_directions(std::size_t count, const PolarRows& polar, DirectionRows& rows) {
  HWY_DYNAMIC_DISPATCH(direct_lanes)(count, polar, rows);
}
void find_cells(const SphereTables& tables, float turn, std::size_t count, const DirectionRows& rows,
                SphereCellRows& places) {
  HWY_DYNAMIC_DISPATCH(find_lanes)(tables, turn, count, rows, places);
}
void interpolate_cells(const SphereTables& tables, std::size_t count, const SphereCellRows& places,
                       DirectionRows& rows) {
  HWY_DYNAMIC_DISPATCH(interpolate_lanes)(tables, count, places, rows);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
