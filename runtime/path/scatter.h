// The stage of scattering: samples the BSDF for the next direction of each path, and plays Russian roulette.
//
// Source of the roulette: Arvo and Kirk, "Particle Transport and Image Synthesis", 1990.
// Tested by: tests/runtime/render_test.cpp, tests/runtime/light/light_transport_test.cpp
#pragma once

#include "runtime/path/options.h"
#include "runtime/path/vertex_batch.h"

namespace fathom::runtime {

// Makes the BSDFs: a Bsdf for each vertex except those of diffuse and emissive materials.
void make_bsdfs(VertexBatch& batch);

// Returns the BSDF's value at vertex i, as Bsdf::evaluate().
BsdfValue evaluate_bsdf(const VertexBatch& batch, std::size_t i, glm::vec3 wi);

// Draws the random numbers that every vertex needs, and samples the BSDFs. This stage comes before every other that
// draws random numbers, so that its numbers are the same dimensions in all samples.
void sample_bsdfs(const Settings& settings, VertexBatch& batch);

// Applies the BSDF samples: sets the next rays of the paths, or ends the paths.
void apply_bsdf_samples(const Settings& settings, VertexBatch& batch);

}  // namespace fathom::runtime
