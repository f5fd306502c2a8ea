// The measuring half of chart B: small pictures of a scene drawn in several ways, at several numbers of samples and
// with several seeds, against a reference whose rays were all searched in double. Tested by:
// tests/runtime/chart/chart_measure_test.cpp
#pragma once

#include <span>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/chart/measurements.h"
#include "runtime/path/options.h"

namespace fathom::runtime {

// How a picture is drawn, as far as it makes a difference to its error.
struct ImageWay {
  Marching marching = {};
  compiler::SamplerKind sampler = compiler::SamplerKind::Blue;
  LightSampling light_sampling = LightSampling::Both;
};

struct ImagePlan {
  int width = 64, height = 36;  // pixels
  int spp = 64;                 // at most; the curve's other points have a quarter of the next
  int seeds = 16;               // pictures for each point; the reference has seeds of its own
  int reference_spp = 1024;
  ImageWay reference_way = {.marching = {.method = Method::Certified}};
};

// The default, and sphere tracing at several eps; of a scene with lamps, lights, a sky or a picture round it also
// other samplers and ways to find light.
std::vector<ImageWay> painted_ways(const compiler::CompiledScene& scene);

// Linear sRGB, [y][x][rgb].
using Channels = std::vector<double>;
Channels reference_picture(const compiler::CompiledScene& scene, const ImagePlan& plan);

struct ImagePoint {
  ImageWay way;
  int spp;
};

// One row for each point, seed by seed so that all share the machine's moods. A picture takes one thread, the
// reference all. Of the plan size and seeds count.
std::vector<ImageMeasurement> measure_points(const compiler::CompiledScene& scene, std::span<const ImagePoint> points,
                                             const ImagePlan& plan, const Channels& reference,
                                             const std::string& scene_name);

// Of every way the plan's numbers of samples.
std::vector<ImageMeasurement> measure_images(const compiler::CompiledScene& scene, std::span<const ImageWay> ways,
                                             const ImagePlan& plan, const std::string& scene_name);

}  // namespace fathom::runtime
