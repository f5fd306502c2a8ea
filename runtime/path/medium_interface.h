// The stage of media: attenuates paths on their way through a medium, and finds the media on both sides of surfaces.
// Tested by: tests/runtime/path/media_test.cpp
#pragma once

#include "runtime/field/field.h"
#include "runtime/path/render_context.h"
#include "runtime/path/vertex_batch.h"

namespace fathom::runtime {

// Multiplies the paths' throughput by the transmittance of their current rays.
void attenuate_paths(VertexBatch& batch);

// Sets SurfaceInteraction::inside and medium_beyond, from the medium of the ray and the material.
void find_media(const RenderContext& context, VertexBatch& batch, RealScratch& scratch);

}  // namespace fathom::runtime
