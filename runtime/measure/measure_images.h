// Measures for chart B: small images of a scene, rendered with several settings, several numbers of samples and
// several seeds, against a reference whose rays were all searched in double. Tested by:
// tests/runtime/chart/chart_measure_test.cpp
#pragma once

#include <span>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/chart/measurements.h"
#include "runtime/path/options.h"

namespace fathom::runtime {

// Render settings that make a difference to an image's error.
struct ImageVariant {
  Marching marching = {};
  compiler::SamplerKind sampler = compiler::SamplerKind::Blue;
  LightSampling light_sampling = LightSampling::Mis;
};

struct ImagePlan {
  int width = 64, height = 36;  // pixels
  int spp = 64;                 // maximum; each further point of the curve has a quarter of the point before
  int seeds = 16;               // images per point; the reference has a seed of its own
  int reference_spp = 1024;
  ImageVariant reference_variant = {.marching = {.method = Method::Certified}};
};

// Returns the default, and sphere tracing at several eps. For a scene with lamps, lights, a sky or an environment map
// also returns other samplers and other methods of light sampling.
std::vector<ImageVariant> image_variants(const compiler::CompiledScene& scene);

// Linear sRGB, [y][x][rgb].
using PixelValues = std::vector<double>;
PixelValues reference_image(const compiler::CompiledScene& scene, const ImagePlan& plan);

struct ImagePoint {
  ImageVariant variant;
  int spp;
};

// Returns one row per point. Renders seed by seed, so that all points share the machine's fluctuations. An image
// takes one thread, the reference all. Only the plan's size and seeds are used.
std::vector<ImageMeasurement> measure_points(const compiler::CompiledScene& scene, std::span<const ImagePoint> points,
                                             const ImagePlan& plan, const PixelValues& reference,
                                             const std::string& scene_name);

// Measures every variant with each of the plan's numbers of samples.
std::vector<ImageMeasurement> measure_images(const compiler::CompiledScene& scene,
                                             std::span<const ImageVariant> variants, const ImagePlan& plan,
                                             const std::string& scene_name);

}  // namespace fathom::runtime
