// The command line of `fathom render` as data, and how it changes a scene.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/options/camera_options.h"
#include "runtime/cli/options/frame_options.h"
#include "runtime/cli/options/long_render.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/options/unit_options.h"
#include "runtime/path/options.h"

namespace fathom::cli {

struct RenderRequest {
  SceneArguments scene;
  std::vector<Output> outputs;  // at least one
  int format = -1;              // of -o -, see put_formats()
  bool default_output = false;  // the name was made from the scene's
  bool albedo = false, depth = false, normal = false;
  std::optional<double> aspect, fov;  // width over height; radians
  CameraOptions camera;
  std::optional<int> resolution;  // width, pixels
  std::optional<PixelSize> size;
  std::optional<CropSides> crop;
  std::optional<double> exposure;  // stops
  int tone = -1;                   // a compiler::ToneCurve; -1: not given
  int bits = 0;                    // an index into 8, 16
  std::optional<int> threads;
  int sampler = -1, filter = -1;   // a SamplerKind, a FilterKind; -1: not given
  runtime::RenderOptions options;  // width and height are not set; crop is by override_scene()
  int method = -1;                 // an index into runtime::kMethods; -1: not given
  std::optional<double> epsilon, relaxation;
  std::optional<int> steps;
  bool no_regions = false;
  std::optional<int> region_memory;  // MB
  int precision = -1;                // a runtime::Precision; -1: not given
  bool reference = false;
  std::optional<std::string> stats_json, cost_map;
  int verbosity = 0;
  int light_sampling = -1;  // a runtime::LightSampling; -1: not given
  bool denoise = false;  // settled: of --denoise, --no-denoise and --preview
  bool no_denoise = false;
  LongRender long_render;
  FrameOptions frames;
  UnitOptions units;
  // Of a request for one frame of several: its number, and which it is of how many.
  struct Frame {
    int number, index, count;
  };
  std::optional<Frame> frame;
  // Of a request for one unit of a plan: its number.
  std::optional<std::uint64_t> unit;
  bool preview = false, watch = false;
  bool quiet = false;
};

// The name of the checkpoint when the command line does not say it: beside the first output that is a file. None
// when standard output is the only one.
std::optional<std::string> default_checkpoint(const RenderRequest& request);

// Puts what was asked for together. An ExitCode, after a message, when some of it does not go with other of it,
// whatever the scene.
std::optional<ExitCode> settle(RenderRequest& request, const Streams& streams);

// Puts the request's camera, size, tone and crop over the scene's. An ExitCode, after a message, when they do not fit
// together.
std::optional<ExitCode> override_scene(RenderRequest& request, compiler::CompiledScene& scene,
                                       const Streams& streams);

// Puts the request's field of view and camera over those of the scene, whose film is settled. Likewise.
std::optional<ExitCode> override_camera(const RenderRequest& request, compiler::CompiledScene& scene,
                                        const Streams& streams);

}  // namespace fathom::cli
