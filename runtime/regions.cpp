#include "runtime/regions.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vm/check.h"

namespace fathom::runtime {
namespace {

constexpr std::size_t kGathered = 128;  // points of one program evaluated together

}  // namespace

Regions::Found Regions::find(float x, float y, float z) const {
  const float p[3] = {x, y, z};
  std::array<std::uint32_t, 3> cell;
  const float most = static_cast<float>(1u << tree_.levels);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float at = (p[axis] - tree_.lo[axis]) * tree_.scale;
    if (!(at >= 0)) return {outside_[2 * axis], -1, {}};
    if (!(at < most)) return {outside_[2 * axis + 1], -1, {}};
    cell[axis] = static_cast<std::uint32_t>(at);
  }
  int level = tree_.grid_level, shift = tree_.levels - tree_.grid_level;
  std::uint32_t index = grid_[(((cell[2] >> shift) << level | cell[1] >> shift) << level) | cell[0] >> shift];
  Node node = nodes_[index];
  while (node.kind() == Kind::Inner) {
    --shift;
    index = node.payload() + ((cell[0] >> shift & 1) | (cell[1] >> shift & 1) << 1 | (cell[2] >> shift & 1) << 2);
    node = nodes_[index];
    ++level;
  }
  return {node, level, cell};
}

float Regions::far_value(const Found& found, float x, float y, float z) const {
  const int level = static_cast<int>(found.node.payload());
  const float edge = tree_.size / static_cast<float>(1u << level);
  const float p[3] = {x, y, z};
  float squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float centre =
        tree_.lo[axis] + (static_cast<float>(found.cell[axis] >> (tree_.levels - level)) + 0.5f) * edge;
    squared += (p[axis] - centre) * (p[axis] - centre);
  }
  return std::max(found.node.value - tree_.lipschitz * std::sqrt(squared), tree_.far * edge);
}

void Regions::group(std::uint32_t program, std::uint32_t point, RegionScratch& s) const {
  std::uint32_t& head = s.heads[program];
  if (head == vm::kNone) s.programs.push_back(program);
  s.next[point] = head;
  head = point;
}

// Copies the points waiting for a program, kGathered at most, into the scratch; those left stay.
std::size_t Regions::gather(std::uint32_t program, vm::Points points, RegionScratch& s) const {
  s.chosen.clear();
  std::uint32_t& head = s.heads[program];
  while (head != vm::kNone && s.chosen.size() < kGathered) {
    const std::size_t at = s.chosen.size();
    s.x[at] = points.x[head], s.y[at] = points.y[head], s.z[at] = points.z[head];
    s.chosen.push_back(head);
    head = s.next[head];
  }
  return s.chosen.size();
}

void Regions::evaluate(vm::Points points, std::size_t count, float* distance, RegionScratch& s,
                       vm::Workspace& workspace) const {
  CHECK(count <= kMostPoints, "a batch of points is too large");
  s.jobs.clear(), s.programs.clear(), s.far.clear();
  s.heads.resize(programs_.size(), vm::kNone);
  find_regions(tree_, points, count, s.refs.data(), s.limits.data(), s.bounds.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t ref = s.refs[i];
    if (ref == kOutside) {
      const Found found = find(points.x[i], points.y[i], points.z[i]);
      ref = found.node.ref, s.limits[i] = found.node.value;
    }
    const Node node{s.limits[i], ref};
    switch (node.kind()) {
      case Kind::Bundle:
        __builtin_prefetch(bundles_.data() + node.payload());
        __builtin_prefetch(bundles_.data() + node.payload() + 16);
        s.jobs.push_back({node.payload(), i});
        s.instructions[i] = vm::shapes_in(bundles_[node.payload()]);
        break;
      case Kind::Program:
        group(node.payload(), i, s);
        s.instructions[i] = static_cast<std::uint32_t>(programs_[node.payload()].sources.size());
        break;
      default:
        s.instructions[i] = 0;
        s.far.push_back(i);
        break;
    }
  }
  vm::evaluate_bundles(bundles_.data(), s.jobs, points, distance);
  for (const vm::BundleJob& job : s.jobs) distance[job.point] = std::min(distance[job.point], s.limits[job.point]);
  for (const std::uint32_t i : s.far) distance[i] = s.bounds[i];
  std::size_t specialised = 0;
  for (const std::uint32_t program : s.programs) {
    while (const std::size_t size = gather(program, points, s)) {
      specialised += size;
      vm::evaluate_distance(programs_[program], {s.x.data(), s.y.data(), s.z.data()}, size, s.distance.data(),
                            workspace);
      for (std::size_t j = 0; j < size; ++j) {
        distance[s.chosen[j]] = std::min(s.distance[j], s.limits[s.chosen[j]]);
      }
    }
  }
  s.counters.far += s.far.size(), s.counters.bundled += s.jobs.size(), s.counters.specialised += specialised;
}

void Regions::part_of(const Node& node, vm::Part& part) const {
  part = {};
  if (node.kind() == Kind::Program) part = programs_[node.payload()];
  if (node.kind() != Kind::Bundle) return;
  std::vector<std::uint32_t> shapes;
  vm::shapes_of_bundle(bundles_.data(), node.payload(), shapes);
  vm::unpack_bundle(whole_, surfaces_, bundles_.data(), node.payload(), shapes, part);
}

double Regions::evaluate(glm::dvec3 p, vm::Workspace& workspace, std::uint64_t& instructions) const {
  const glm::vec3 f(p);
  const Found found = find(f.x, f.y, f.z);
  if (found.node.kind() == Kind::Far) return static_cast<double>(far_value(found, f.x, f.y, f.z));
  vm::Part unpacked;
  if (found.node.kind() == Kind::Bundle) part_of(found.node, unpacked);
  const vm::Part& part = found.node.kind() == Kind::Bundle ? unpacked : programs_[found.node.payload()];
  instructions += part.sources.size();
  return std::min(vm::evaluate_distance(part, p, workspace), static_cast<double>(found.node.value));
}

std::optional<vm::AlongLine> Regions::along(glm::dvec3 origin, glm::dvec3 direction, double begin, double end,
                                            vm::Workspace& workspace, std::uint64_t& instructions) const {
  const glm::vec3 a(origin + begin * direction), b(origin + end * direction);
  const Found first = find(a.x, a.y, a.z), last = find(b.x, b.y, b.z);
  if (first.level < 0 || first.level != last.level) return std::nullopt;
  const int shift = tree_.levels - first.level;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (first.cell[axis] >> shift != last.cell[axis] >> shift) return std::nullopt;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  if (first.node.kind() == Kind::Far) return vm::AlongLine{{-infinity, infinity}, {-infinity, infinity}};
  vm::Part part;
  part_of(first.node, part);
  instructions += part.sources.size();
  vm::AlongLine line = vm::evaluate_along(part, origin, direction, begin, end, workspace);
  const double limit = static_cast<double>(first.node.value);
  line.value = {std::min(line.value.lo, limit), std::min(line.value.hi, limit)};
  line.derivative = {std::min(line.derivative.lo, 0.0), std::max(line.derivative.hi, 0.0)};
  return line;
}

Regions::Region Regions::region(glm::dvec3 p) const {
  static constexpr const char* kNames[] = {"inner", "far", "bundle", "program"};
  const glm::vec3 f(p);
  const Found found = find(f.x, f.y, f.z);
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
  CHECK(count <= kMostHits, "a batch of hits is too large");
  std::vector<std::uint32_t> shapes;
  vm::Part part;
  std::array<std::pair<std::uint32_t, std::uint32_t>, kMostHits> waiting;  // program, point
  std::size_t waits = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float p[3] = {points.x[i], points.y[i], points.z[i]};
    const Node node = find(p[0], p[1], p[2]).node;
    if (node.kind() == Kind::Program) {
      waiting[waits++] = {node.payload(), i};
      continue;
    }
    // Of a bundle the nearest shape is enough, or those that are as near. What is not near the surface at all, as
    // rounding may have it, asks the whole program.
    vm::Code code = whole_;
    if (node.kind() == Kind::Bundle) {
      vm::nearest_in_bundle(bundles_.data(), node.payload(), p, shapes);
      vm::unpack_bundle(whole_, surfaces_, bundles_.data(), node.payload(), shapes, part);
      code = part;
    }
    vm::evaluate_surface(
        code, {points.x + i, points.y + i, points.z + i}, 1,
        {out.distance + i, out.gradient_x + i, out.gradient_y + i, out.gradient_z + i, out.surface + i}, workspace);
  }
  std::sort(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(waits));
  for (std::size_t first = 0; first < waits;) {
    std::size_t last = first;
    while (last < waits && waiting[last].first == waiting[first].first) ++last;
    evaluate_surfaces_of(std::span(waiting).subspan(first, last - first), points, out, workspace);
    first = last;
  }
}

// Of points whose regions have the same program.
void Regions::evaluate_surfaces_of(std::span<const std::pair<std::uint32_t, std::uint32_t>> same, vm::Points points,
                                   vm::SurfaceValues out, vm::Workspace& workspace) const {
  alignas(64) std::array<float, kMostHits> x, y, z, d, gx, gy, gz;
  alignas(64) std::array<std::uint32_t, kMostHits> surface;
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::uint32_t point = same[i].second;
    x[i] = points.x[point], y[i] = points.y[point], z[i] = points.z[point];
  }
  vm::evaluate_surface(programs_[same[0].first], {x.data(), y.data(), z.data()}, same.size(),
                       {d.data(), gx.data(), gy.data(), gz.data(), surface.data()}, workspace);
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::uint32_t point = same[i].second;
    out.distance[point] = d[i], out.surface[point] = surface[i];
    out.gradient_x[point] = gx[i], out.gradient_y[point] = gy[i], out.gradient_z[point] = gz[i];
  }
}

vm::SurfaceValue Regions::evaluate_surface(glm::dvec3 p, vm::Workspace& workspace) const {
  const glm::vec3 f(p);
  const Node node = find(f.x, f.y, f.z).node;
  vm::Part part;
  part_of(node, part);
  return vm::evaluate_surface(part.words.empty() ? whole_ : vm::Code(part), p, workspace);
}

}  // namespace fathom::runtime
