#include "runtime/path/surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "runtime/field/field.h"
#include "runtime/field/pieces.h"
#include "runtime/path/jump_normals.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

// Some hits of a batch: those on one piece.
struct HitGroup {
  const Hit* all;
  std::span<const std::uint16_t> numbers;

  std::size_t size() const { return numbers.size(); }
  const Hit& operator[](std::size_t i) const { return all[numbers[i]]; }
};

void set_rows(const HitGroup& hits, SurfaceRows& rows) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    float size = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<float>(hit.position[axis]);
      rows.position[axis][i] = coordinate;
      rows.wo[axis][i] = hit.wo[axis];
      size = std::max(size, std::abs(coordinate));
    }
    rows.size[i] = size;
    rows.side[i] = static_cast<float>(hit.side);
    rows.width[i] = hit.width;
  }
}

float least_offset(const Field& field, float size) {
  return kDistanceError * (kOffsetErrors * size + kMagnitudeErrors * field.cancellation);
}

// Replaces the surfaces at hits whose coordinates are so coarse that float gives a coarse normal, perhaps of another
// surface.
void evaluate_coarse_hits(const Field& field, const HitGroup& hits, SurfaceRows& rows,
                          std::span<std::uint32_t> surface, vm::Workspace& workspace) {
  const float most = kMaxOffset * field.band;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!(least_offset(field, rows.size[i]) > most)) [[likely]]
      continue;
    const vm::SurfaceValue exact = field.regions ? field.regions->evaluate_surface(hits[i].position, workspace)
                                                 : vm::evaluate_surface(*field.surface, hits[i].position, workspace);
    for (int axis = 0; axis < 3; ++axis) rows.gradient[axis][i] = static_cast<float>(exact.gradient[axis]);
    surface[i] = exact.surface;
    rows.convex[i] = 0;
  }
}

void set_inverse_slopes(const Field& field, std::size_t count, SurfaceRows& rows) {
  if (!field.cells) {
    std::fill_n(rows.inverse_slope, count, field.inv_lipschitz);
    return;
  }
  field.cells->inverse_slopes({rows.position[0], rows.position[1], rows.position[2]}, count, rows.inverse_slope);
}

// Replaces the gradients of hits at which the field jumps by the normals of the surface. A field with a bound on its
// slope around a hit does not jump there.
void mend_jumps(const Field& field, const HitGroup& hits, SurfaceRows& rows, RealScratch& scratch) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (rows.inverse_slope[i] > 0) continue;
    const glm::dvec3 gradient(rows.gradient[0][i], rows.gradient[1][i], rows.gradient[2][i]);
    const float offset = std::max(2 * rows.width[i], least_offset(field, rows.size[i]));
    const auto normal = jump_normal(
        field, {hits[i].position, glm::dvec3(hits[i].wo), gradient, static_cast<double>(offset)}, scratch);
    for (int axis = 0; normal && axis < 3; ++axis) {
      rows.gradient[axis][i] = static_cast<float>((*normal)[axis]) * rows.side[i];
    }
  }
}

// Returns the field of what was hit: a piece's, or the whole.
const Field& field_of(const Field& whole, std::uint32_t piece) {
  return whole.pieces && piece != kNoPiece ? whole.pieces->fields[piece] : whole;
}

// The same as find_surfaces(), of hits that all have this field. `points`: of the whole batch.
void find_surfaces_of(const compiler::CompiledScene& scene, const Field& field, const HitGroup& hits,
                      std::span<SurfacePoint> points, vm::Workspace& workspace) {
  SurfaceRows rows;
  alignas(64) std::array<float, kSurfaceBatch> distance;
  alignas(64) std::array<std::uint32_t, kSurfaceBatch> surface;
  set_rows(hits, rows);
  const vm::Points places{rows.position[0], rows.position[1], rows.position[2]};
  const vm::SurfaceValues values{distance.data(),  rows.gradient[0], rows.gradient[1],
                                 rows.gradient[2], surface.data(),   rows.convex};
  field.evaluate_surface(places, hits.size(), values, workspace);
  evaluate_coarse_hits(field, hits, rows, surface, workspace);
  set_inverse_slopes(field, hits.size(), rows);
  if (field.may_jump()) {
    RealScratch scratch;
    mend_jumps(field, hits, rows, scratch);
  }
  set_surface_geometry(field, hits.size(), rows);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    CHECK(surface[i] < scene.surfaces.size(), "a tag of the surface program has no surface");
    SurfacePoint& point = points[hits.numbers[i]];
    for (int axis = 0; axis < 3; ++axis) point.normal[axis] = rows.normal[axis][i];
    point.surface = surface[i];
    point.material = scene.surfaces[surface[i]].material;
    point.offset = rows.offset[i];
    point.clear = rows.clear[i];
    point.steepness = rows.steepness[i];
  }
}

// Sorts the numbers of hits by piece, a byte of it at a time, from the lowest (LSD radix sort).
void sort_by_piece(std::span<const Hit> hits, std::span<std::uint16_t> numbers) {
  std::uint32_t used = 0;
  for (const Hit& hit : hits) used |= hit.piece + 1;  // kNoPiece becomes 0
  std::array<std::uint16_t, kSurfaceBatch> sorted;
  for (std::uint32_t shift = 0; shift < 32 && used >> shift != 0; shift += 8) {
    const auto digit = [&](std::uint16_t i) { return ((hits[i].piece + 1) >> shift) & 255; };
    std::array<std::uint16_t, 257> place{};
    for (const std::uint16_t i : numbers) ++place[digit(i) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    for (const std::uint16_t i : numbers) sorted[place[digit(i)]++] = i;
    std::copy_n(sorted.begin(), numbers.size(), numbers.begin());
  }
}

}  // namespace

void find_surfaces(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                   std::span<SurfacePoint> points, vm::Workspace& workspace) {
  CHECK(hits.size() <= kSurfaceBatch && points.size() >= hits.size(), "a batch of hits is too large");
  std::array<std::uint16_t, kSurfaceBatch> order;
  const std::span<std::uint16_t> numbers = std::span(order).first(hits.size());
  std::iota(numbers.begin(), numbers.end(), std::uint16_t{0});
  if (field.pieces) sort_by_piece(hits, numbers);
  for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
    const std::uint32_t piece = hits[numbers[begin]].piece;
    while (end < hits.size() && hits[numbers[end]].piece == piece) ++end;
    const HitGroup same{hits.data(), numbers.subspan(begin, end - begin)};
    find_surfaces_of(scene, field_of(field, piece), same, points, workspace);
    if (piece == kNoPiece) continue;
    for (const std::uint16_t i : same.numbers) points[i].clear = 0;  // other pieces may be nearer
  }
}

void find_object_points(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                        std::span<SurfacePoint> points, RealScratch& scratch) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!scene.surfaces[points[i].surface].placed) continue;
    const vm::SurfacePlace found =
        find_object_point(scene, field_of(field, hits[i].piece), hits[i].position, scratch);
    points[i].surface = found.surface;
    points[i].material = scene.surfaces[found.surface].material;
    points[i].place = found.place;
  }
}

vm::SurfacePlace find_object_point(const compiler::CompiledScene& scene, const Field& field, glm::dvec3 position,
                                   RealScratch& scratch) {
  vm::SurfacePlace found = field.regions ? field.regions->evaluate_place(position, scratch)
                                         : vm::evaluate_place(*field.surface, position, scratch.workspace);
  CHECK(found.surface < scene.surfaces.size(), "a tag of the surface program has no surface");
  found.place += scene.surfaces[found.surface].shift;
  return found;
}

vm::SurfaceShares find_blend_weights(const compiler::CompiledScene& scene, const Field& whole, const Hit& hit,
                                     RealScratch& scratch) {
  const Field& field = field_of(whole, hit.piece);
  const glm::dvec3 place = hit.position;
  const bool placed =
      std::any_of(scene.surfaces.begin(), scene.surfaces.end(), std::mem_fn(&compiler::Surface::placed));
  if (!placed) {
    if (field.regions) return field.regions->evaluate_shares(place, scratch);
    return vm::evaluate_shares(*field.surface, place, scratch.workspace);
  }
  vm::SurfaceShares shares = field.regions ? field.regions->evaluate_placed_shares(place, scratch)
                                           : vm::evaluate_placed_shares(*field.surface, place, scratch.workspace);
  for (int i = 0; i < shares.count; ++i) {
    vm::SurfaceShare& share = shares.all[static_cast<std::size_t>(i)];
    share.place += scene.surfaces[share.surface].shift;
  }
  return shares;
}

}  // namespace fathom::runtime
