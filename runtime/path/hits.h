// The stage of hits: takes the results of a marcher, and finds the surfaces and materials that the rays hit.
// Tested by: tests/runtime/path/stages_test.cpp, tests/runtime/render_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/march/ray.h"
#include "runtime/path/path_state.h"
#include "runtime/path/render_context.h"
#include "runtime/path/surface.h"
#include "runtime/path/vertex_batch.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

// The results of a marcher, grouped by the next stage of their paths.
struct RayHitGroups {
  std::span<const RayHit> ended_shadow_rays;  // unoccluded, or occluded for good
  std::span<const RayHit> shadow_hits;        // of surfaces that may let the light pass straight through
  std::span<const RayHit> surface_hits;       // of the paths' own rays
  std::span<const RayHit> escaped_rays;       // the paths' own rays that hit nothing
};
// Moves the results to `grouped`, in order within each group. `has_null_transmission`: true if there are surfaces
// that light may pass straight through.
RayHitGroups group_ray_hits(std::span<const RayHit> ray_hits, std::span<const PathState> paths,
                            bool has_null_transmission, std::vector<RayHit>& grouped);

// Adds the evaluations of the rays to their paths.
void add_costs(std::span<const RayHit> ray_hits, std::span<PathState> paths);

// Up to kSurfaceBatch hits of one field.
struct HitBatch {
  std::span<const RayHit> ray_hits;
  std::array<Hit, kSurfaceBatch> hits;
  std::array<SurfacePoint, kSurfaceBatch> points;
};
// Set the positions of the hits, of the paths' own rays or of shadow rays.
void set_path_hit_positions(std::span<const RayHit> ray_hits, std::span<const PathState> paths, HitBatch& batch);
void set_shadow_hit_positions(std::span<const RayHit> ray_hits, std::span<const ShadowRay> rays, HitBatch& batch);
// Finds the surfaces at the hits of field number `field`.
void find_surface_points(const RenderContext& context, std::size_t field, HitBatch& batch, vm::Workspace& workspace,
                         RealScratch& scratch);

// Begin a vertex for each of `count` hits from number `first` on. The vertices point into `hits`, `paths` and `rays`.
void begin_vertices(const HitBatch& hits, std::size_t first, std::size_t count, std::span<PathState> paths,
                    VertexBatch& batch);
void begin_shadow_vertices(const HitBatch& hits, std::size_t first, std::size_t count, std::span<PathState> paths,
                           std::span<ShadowRay> rays, VertexBatch& batch);

// Finds the materials. A blend that mixes materials counts each by its share.
void find_materials(const RenderContext& context, VertexBatch& batch, RealScratch& scratch);

// Records the first hits of paths for the film's layers. Returns their number.
std::uint64_t record_first_hits(const RenderContext& context, VertexBatch& batch);

}  // namespace fathom::runtime
