#include "runtime/field/regions.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vm/program/check.h"

namespace fathom::runtime {
Regions::RegionLookup Regions::find(float x, float y, float z) const {
  const float p[3] = {x, y, z};
  std::array<std::uint32_t, 3> cell;
  const float most = static_cast<float>(1u << tree_.levels);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float at = (p[axis] - tree_.lo[axis]) * tree_.scale;
    const std::uint32_t below = static_cast<std::uint32_t>(2 * axis);
    if (!(at >= 0)) return {outside_[below], -1, {below, 0, 0}};
    if (!(at < most)) return {outside_[below + 1], -1, {below + 1, 0, 0}};
    cell[axis] = static_cast<std::uint32_t>(at);
  }
  int level = tree_.grid_level, shift = tree_.levels - tree_.grid_level;
  std::uint32_t index = ((cell[2] >> shift) << level | cell[1] >> shift) << level | cell[0] >> shift;
  Node node = nodes_[index];
  while (node.kind() == Kind::Inner) {
    --shift;
    index = node.payload() + ((cell[0] >> shift & 1) | (cell[1] >> shift & 1) << 1 | (cell[2] >> shift & 1) << 2);
    node = nodes_[index];
    ++level;
  }
  return {node, level, cell};
}

void Regions::evaluate(vm::Points points, std::size_t count, float* distance, RegionScratch& s,
                       vm::Workspace& workspace) const {
  static_assert(static_cast<std::uint32_t>(Kind::Program) << 30 == kFirstNear);
  CHECK(count <= kMaxPoints, "a batch of points is too large");
  LookupResult found = find_regions(tree_, points, count, distance, {s.point.data(), s.ref.data(), s.limit.data()});
  std::fill_n(s.instructions.data(), count, 0);
  s.counters.far += count - found.near;
  if (found.outside) [[unlikely]]
    found.near = evaluate_outside(points, found.near, distance, s, workspace);
  s.counters.specialised += found.near;
  sort(points, found.near, s);
  for (const std::uint32_t number : s.active) {
    const vm::ProgramTemplate& program_template = templates_[number];
    std::vector<vm::TemplateJob>& jobs = s.jobs[number];
    for (const vm::TemplateJob& job : jobs) s.instructions[job.point] = program_template.instructions;
    vm::evaluate_template(program_template, *constants_, pool_.data(), jobs, distance, workspace);
    jobs.clear();
  }
  s.active.clear();
  far_.apply(points, count, distance);
}

// Sorts the first `near` points by the templates of their programs.
void Regions::sort(vm::Points points, std::size_t near, RegionScratch& s) const {
  s.jobs.resize(templates_.size());
  if (tree_.beyond_cache) {
    for (std::size_t j = 0; j < near; ++j) __builtin_prefetch(pool_.data() + Node{0, s.ref[j]}.payload());
  }
  for (std::size_t j = 0; j < near; ++j) {
    const std::uint32_t i = s.point[j], at = Node{0, s.ref[j]}.payload(), number = pool_[at];
    std::vector<vm::TemplateJob>& jobs = s.jobs[number];
    if (jobs.empty()) s.active.push_back(number);
    jobs.push_back({points.x[i], points.y[i], points.z[i], s.limit[j], at, i});
    if (tree_.beyond_cache) templates_.prefetch(*constants_, pool_.data(), at);
  }
}

// Finds the leaves of the points outside the root. Points whose leaf needs the whole program, as outside a bounded
// scene's root, are evaluated at once. Returns the number of points left.
std::size_t Regions::evaluate_outside(vm::Points points, std::size_t near, float* distance, RegionScratch& s,
                                      vm::Workspace& workspace) const {
  std::size_t left = 0;
  for (std::size_t j = 0; j < near; ++j) {
    const std::uint32_t i = s.point[j];
    std::uint32_t ref = s.ref[j];
    float limit = s.limit[j];
    if (ref == kOutside) {
      const RegionLookup found = find(points.x[i], points.y[i], points.z[i]);
      ref = found.node.ref, limit = found.node.value;
    }
    if (Node{0, ref}.payload() == kWhole) {
      vm::evaluate_distance(whole_, {points.x + i, points.y + i, points.z + i}, 1, distance + i, workspace);
      s.instructions[i] = static_cast<std::uint32_t>(whole_part_.sources.size());
      continue;
    }
    s.point[left] = i, s.ref[left] = ref, s.limit[left] = limit;
    ++left;
  }
  return left;
}

void Regions::part_of(const Node& node, vm::PrunedProgram& part) const {
  if (node.kind() != Kind::Program) {
    part = {};
  } else if (node.payload() == kWhole) {
    part = whole_part_;
  } else {
    templates_.unpack(whole_, *constants_, pool_.data(), node.payload(), part);
  }
}

const vm::PrunedProgram& Regions::part_of(const Node& node, RealScratch& scratch) const {
  if (node.kind() == Kind::Program && node.payload() == kWhole) return whole_part_;
  RealScratch::Slot& slot = scratch.slots[node.ref * 0x9e3779b9u >> (32 - RealScratch::kSlotBits)];
  if (slot.of != this || slot.ref != node.ref) {
    part_of(node, slot.part);
    slot.of = this, slot.ref = node.ref;
  }
  return slot.part;
}

double Regions::evaluate(glm::dvec3 p, RealScratch& scratch, std::uint64_t& instructions) const {
  const glm::vec3 f(p);
  const RegionLookup found = find(f.x, f.y, f.z);
  const double limit = static_cast<double>(found.node.value);
  if (found.node.kind() == Kind::Far) return far_(limit, f.x, f.y, f.z);
  const vm::PrunedProgram& part = part_of(found.node, scratch);
  instructions += part.sources.size();
  return far_(std::min(vm::evaluate_distance(part, p, scratch.workspace), limit), f.x, f.y, f.z);
}

Regions::Region Regions::region(glm::dvec3 p) const {
  static constexpr const char* kNames[] = {"inner", "far", "program"};
  const glm::vec3 f(p);
  const RegionLookup found = find(f.x, f.y, f.z);
  Region region{
      {glm::dvec3(-std::numeric_limits<double>::infinity()), glm::dvec3(std::numeric_limits<double>::infinity())},
      kNames[static_cast<std::size_t>(found.node.kind())],
      static_cast<double>(found.node.value),
      {}};
  if (found.level >= 0) {
    const double edge = static_cast<double>(tree_.size) / (1u << found.level);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      region.cell.lo[axis] =
          static_cast<double>(tree_.lo[a]) + edge * (found.cell[a] >> (tree_.levels - found.level));
      region.cell.hi[axis] = region.cell.lo[axis] + edge;
    }
  }
  part_of(found.node, region.part);
  return region;
}

void Regions::evaluate_surface(vm::Points points, std::size_t count, vm::SurfaceValues out,
                               vm::Workspace& workspace) const {
  CHECK(count <= kMaxHits, "a batch of hits is too large");
  std::array<std::pair<std::uint32_t, std::uint32_t>, kMaxHits> leaves;  // {word of the leaf, point}
  for (std::uint32_t i = 0; i < count; ++i) {
    leaves[i] = {find(points.x[i], points.y[i], points.z[i]).node.ref, i};
  }
  std::sort(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(count));
  vm::PrunedProgram part;
  for (std::size_t first = 0; first < count;) {
    std::size_t last = first;
    while (last < count && leaves[last].first == leaves[first].first) ++last;
    part_of({0, leaves[first].first}, part);
    evaluate_surfaces_of(part, std::span(leaves).subspan(first, last - first), points, out, workspace);
    first = last;
  }
}

// Evaluates points whose leaves have the same program, `part`. A point that rounding put into a far leaf, and so not
// near the surface at all, is evaluated by the whole program.
void Regions::evaluate_surfaces_of(const vm::PrunedProgram& part,
                                   std::span<const std::pair<std::uint32_t, std::uint32_t>> same, vm::Points points,
                                   vm::SurfaceValues out, vm::Workspace& workspace) const {
  alignas(64) std::array<float, kMaxHits> x, y, z, d, gx, gy, gz, convex;
  alignas(64) std::array<std::uint32_t, kMaxHits> surface;
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::uint32_t point = same[i].second;
    x[i] = points.x[point], y[i] = points.y[point], z[i] = points.z[point];
  }
  vm::evaluate_surface(part.words.empty() ? whole_ : vm::Code(part), {x.data(), y.data(), z.data()}, same.size(),
                       {d.data(), gx.data(), gy.data(), gz.data(), surface.data(), convex.data()}, workspace);
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::uint32_t point = same[i].second;
    out.distance[point] = d[i], out.surface[point] = surface[i];
    out.gradient_x[point] = gx[i], out.gradient_y[point] = gy[i], out.gradient_z[point] = gz[i];
    if (out.convex != nullptr) out.convex[point] = convex[i];
  }
}

vm::SurfaceValue Regions::evaluate_surface(glm::dvec3 p, vm::Workspace& workspace) const {
  const glm::vec3 f(p);
  const Node node = find(f.x, f.y, f.z).node;
  vm::PrunedProgram part;
  part_of(node, part);
  return vm::evaluate_surface(part.words.empty() ? whole_ : vm::Code(part), p, workspace);
}

// Returns the program of the point's leaf, or the whole program if the leaf has none.
vm::Code Regions::code_at(glm::dvec3 p, RealScratch& scratch) const {
  const glm::vec3 f(p);
  const vm::PrunedProgram& part = part_of(find(f.x, f.y, f.z).node, scratch);
  return part.words.empty() ? whole_ : vm::Code(part);
}

vm::SurfaceShares Regions::evaluate_shares(glm::dvec3 p, RealScratch& scratch) const {
  return vm::evaluate_shares(code_at(p, scratch), p, scratch.workspace);
}

vm::SurfaceShares Regions::evaluate_placed_shares(glm::dvec3 p, RealScratch& scratch) const {
  return vm::evaluate_placed_shares(code_at(p, scratch), p, scratch.workspace);
}

vm::SurfacePlace Regions::evaluate_place(glm::dvec3 p, RealScratch& scratch) const {
  return vm::evaluate_place(code_at(p, scratch), p, scratch.workspace);
}

}  // namespace fathom::runtime
