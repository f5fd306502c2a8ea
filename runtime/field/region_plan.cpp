#include "runtime/field/region_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "vm/prune/def_use_graph.h"
#include "vm/prune/pruned_program.h"

namespace fathom::runtime {
namespace {

// Minimum cost, in multiply-adds, of a program that is faster with regions (bench/culling.cpp).
constexpr std::uint64_t kMinCost = 2500;
// kExtraLevels: levels below the one with as many cells as the program has choices. kMaxLevels: maximum number of
// levels, without RegionPlan::room.
constexpr int kExtraLevels = 3, kMaxLevels = 10;
// FarLevels::first, in edges of a cell: the edge is the largest power of two for which the volume of the contents
// holds at least as many cells as there are choices. The edge is computed by products alone, because it decides bits
// of images.
constexpr double kFirstLevel = 0.5;
// Minimum side of the contents, relative to their longest side, in the volume that is divided among the choices.
constexpr double kFlattest = 1.0 / 1024;
// FarLevels::most, the maximum distance outside the contents, in edges of the root.
constexpr float kHighest = 0.1f;

// True if both operands of some function are constants. The compiler folds such functions, and vm/prune/program_template.h
// relies on that.
bool is_unfolded(const vm::Code& code) {
  for (std::size_t at = 0; at < code.size; at += vm::instruction_length(code.words[at])) {
    if (vm::find_opcode(code.words[at] & 0xff)->form != vm::Form::Binary) continue;
    const vm::Sources sources = vm::sources_of(code.words[at]);
    if (sources.a == vm::Source::Constant && sources.b == vm::Source::Constant) return true;
  }
  return false;
}

std::uint64_t cost_of(const vm::Code& code) {
  std::uint64_t cost = 0;
  for (std::size_t at = 0; at < code.size; at += vm::instruction_length(code.words[at])) {
    cost += vm::instruction_cost(code.words[at]);
  }
  return cost;
}

FarLevels far_levels(const compiler::Box& contents, const RegionPlan& plan) {
  const glm::dvec3 extents = contents.hi - contents.lo;
  const double edge = std::max({extents.x, extents.y, extents.z});
  double volume = 1;
  for (int axis = 0; axis < 3; ++axis) volume *= std::max(extents[axis], kFlattest * edge);
  double cell = std::ldexp(1.0, std::ilogb(edge));
  while (cell * cell * cell * static_cast<double>(plan.choices) > volume) cell /= 2;
  FarLevels far;
  far.first = static_cast<float>(kFirstLevel * cell);
  far.most = std::max(far.first, kHighest * plan.size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    far.lo[axis] = static_cast<float>(contents.lo[static_cast<int>(axis)]);
    far.hi[axis] = static_cast<float>(contents.hi[static_cast<int>(axis)]);
  }
  return far;
}

}  // namespace

// Plans a cube around the contents as the root, with room around them. The contents alone decide how small cells are.
std::optional<RegionPlan> plan_regions(const vm::Code& program, const compiler::Box& contents, int room,
                                       bool always) {
  if (contents.empty() || !contents.finite()) return std::nullopt;
  const glm::dvec3 middle = (contents.lo + contents.hi) / 2.0, extents = contents.hi - contents.lo;
  const double edge = std::max({extents.x, extents.y, extents.z});
  if (!(edge > 0) || (!always && cost_of(program) < kMinCost)) return std::nullopt;
  vm::DefUseGraph expression;
  if (!expression.read(program) || is_unfolded(program)) return std::nullopt;
  RegionPlan plan{};
  plan.choices = std::max<std::size_t>(1, expression.choices().size());
  plan.instructions = expression.nodes().size();
  plan.room = room;
  plan.size = static_cast<float>(edge * 1.001 * (1 << room));
  for (int axis = 0; axis < 3; ++axis) {
    plan.lo[static_cast<std::size_t>(axis)] = static_cast<float>(middle[axis] - static_cast<double>(plan.size) / 2);
  }
  const int cubes = (static_cast<int>(std::bit_width(plan.choices - 1)) + 2) / 3;  // least n with 8^n >= choices
  const int levels = kExtraLevels + cubes;
  plan.levels = std::min(levels, kMaxLevels) + room;
  plan.far = far_levels(contents, plan);
  if (!(plan.far.first > 0)) return std::nullopt;
  return plan;
}

}  // namespace fathom::runtime
