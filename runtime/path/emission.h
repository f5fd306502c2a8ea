// The stage of emission: adds the light of emitters and of the background that rays hit.
// Tested by: tests/runtime/light/light_transport_test.cpp
#pragma once

#include <span>

#include "runtime/march/ray.h"
#include "runtime/path/path_state.h"
#include "runtime/path/render_context.h"
#include "runtime/path/vertex_batch.h"

namespace fathom::runtime {

// Adds light that a path of so many bounces brings. Clamps light of two bounces or more, if the settings say so.
void add_radiance(const Settings& settings, PathState& path, glm::vec3 radiance, int bounces);

// Adds the light that the surfaces emit.
void add_emission(const RenderContext& context, VertexBatch& batch);

// Adds the light of the background to paths whose rays hit nothing.
void add_background(const RenderContext& context, std::span<const RayHit> ray_hits, std::span<PathState> paths);

}  // namespace fathom::runtime
