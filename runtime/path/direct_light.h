// The stage of direct light: next-event estimation. Samples a light at each vertex, and follows shadow rays through
// surfaces that let light pass straight through.
//
// A shadow ray has an entry in `rays`, [id], only if there are such surfaces. Otherwise `rays` is empty: a shadow ray
// that hits anything is occluded.
// Tested by: tests/runtime/light/light_transport_test.cpp
#pragma once

#include <span>

#include "runtime/field/field.h"
#include "runtime/march/ray.h"
#include "runtime/path/path_state.h"
#include "runtime/path/render_context.h"
#include "runtime/path/vertex_batch.h"

namespace fathom::runtime {

// Samples a light and a point on it.
void sample_lights(const RenderContext& context, VertexBatch& batch);

// Makes the shadow ray to the sampled light, and sets the light that it brings to the path if it is unoccluded.
void sample_direct_light(const RenderContext& context, VertexBatch& batch, RealScratch& scratch);

// Adds the light of shadow rays of field number `field` that have ended, if they are unoccluded.
void end_shadow_rays(const RenderContext& context, std::size_t field, std::span<const RayHit> ray_hits,
                     std::span<PathState> paths, std::span<const ShadowRay> rays);

// Ends shadow rays at the vertices that let no light pass. These vertices are no longer active.
void end_occluded_rays(std::span<const ShadowRay> rays, VertexBatch& batch);

// Makes the shadow rays that go on behind the vertices, with the light that is left.
void continue_shadow_rays(std::span<const ShadowRay> rays, VertexBatch& batch);

}  // namespace fathom::runtime
