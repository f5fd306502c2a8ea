// The stage of scattering: samples the BSDF for the next direction of each path, and plays Russian roulette.
//
// Source of the roulette: Arvo and Kirk, "Particle Transport and Image Synthesis", 1990.
// Tested by: tests/runtime/render_test.cpp, tests/runtime/light/light_transport_test.cpp
#pragma once

#include <span>

#include "runtime/path/options.h"
#include "runtime/path/path_vertex.h"

namespace fathom::runtime {

void make_bsdfs(std::span<PathVertex> vertices);

// Draws the random numbers that every vertex needs, and samples the BSDFs. This stage comes before every other that
// draws random numbers, so that its numbers are the same dimensions in all samples.
void sample_bsdfs(const Settings& settings, std::span<PathVertex> vertices);

// Applies the BSDF samples: sets the next rays of the paths, or ends the paths.
void apply_bsdf_samples(const Settings& settings, std::span<PathVertex> vertices);

}  // namespace fathom::runtime
