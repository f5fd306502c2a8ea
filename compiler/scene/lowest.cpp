#include "compiler/scene/lowest.h"

#include <algorithm>
#include <array>
#include <optional>

#include "vm/interpret/evaluate.h"

namespace fathom::compiler {
namespace {

constexpr int kPoints = 64;  // grid points along each axis

double place(double lo, double hi, int i) { return lo + (hi - lo) * (i + 0.5) / kPoints; }

// Returns the lowest layer of the box's grid that has a point inside the solid.
std::optional<int> lowest_layer(const vm::Code& program, const Box& box, vm::Workspace& workspace) {
  using Layer = std::array<float, kPoints * kPoints>;
  Layer x, y, z, distance;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    x[static_cast<std::size_t>(i)] = static_cast<float>(place(box.lo.x, box.hi.x, i % kPoints));
    z[static_cast<std::size_t>(i)] = static_cast<float>(place(box.lo.z, box.hi.z, i / kPoints));
  }
  for (int layer = 0; layer < kPoints; ++layer) {
    y.fill(static_cast<float>(place(box.lo.y, box.hi.y, layer)));
    vm::evaluate_distance(program, {x.data(), y.data(), z.data()}, x.size(), distance.data(), workspace);
    if (std::any_of(distance.begin(), distance.end(), [](float d) { return d < 0; })) return layer;
  }
  return std::nullopt;
}

}  // namespace

double lowest(const vm::Code& program, const Box& box) {
  vm::Workspace workspace;
  const std::optional<int> found = lowest_layer(program, box, workspace);
  if (!found) return box.lo.y;
  Box below = box;
  below.hi.y = place(box.lo.y, box.hi.y, *found);
  below.lo.y = *found == 0 ? box.lo.y : place(box.lo.y, box.hi.y, *found - 1);
  const std::optional<int> finer = lowest_layer(program, below, workspace);
  return finer ? below.lo.y + (below.hi.y - below.lo.y) * *finer / kPoints : below.hi.y;
}

}  // namespace fathom::compiler
