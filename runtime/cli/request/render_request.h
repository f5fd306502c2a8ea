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
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/options/unit_options.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// Ending of a checkpoint's default name.
inline constexpr const char* kCheckpointEnding = ".checkpoint";

struct RenderRequest {
  SceneArguments scene;
  std::vector<Output> outputs;  // at least one
  int format = -1;              // index of --format; -1: not given; see apply_format()
  bool default_output = false;  // true if the output's name comes from the scene's name
  bool albedo = false, depth = false, normal = false;
  std::optional<double> aspect, fov;  // width over height; radians
  CameraOptions camera;
  std::optional<int> resolution;  // width, pixels
  std::optional<PixelSize> size;
  std::optional<CropSides> crop;
  int bits = 0;                    // an index into 8, 16
  runtime::RenderOptions options;  // without width and height; override_scene() sets crop
  int method = -1;                 // an index into runtime::kMethods; -1: not given
  std::optional<double> epsilon, relaxation;
  std::optional<int> steps;
  bool no_regions = false;
  bool no_native = false;
  std::optional<int> region_memory;  // MB
  int precision = -1;                // a runtime::Precision; -1: not given
  std::optional<std::string> stats_json, cost_map;
  int verbosity = 0;
  bool denoise = false;  // after resolve_options(): also for --preview without --no-denoise
  bool no_denoise = false;
  std::optional<std::string> checkpoint;      // --checkpoint FILE
  std::optional<double> checkpoint_interval;  // seconds
  bool resume = false;
  FrameOptions frames;
  UnitOptions units;
  // In a request for one of several frames: the frame's number, its index among the frames, and the number of frames.
  struct Frame {
    int number, index, count;
  };
  std::optional<Frame> frame;
  // In a request for one unit of a plan: the unit's number.
  std::optional<std::uint64_t> unit;
  bool preview = false, watch = false;
  bool quiet = false;
};

// Returns the checkpoint's default name, next to the first output that is a file; nullopt if standard output is the
// only output.
std::optional<std::string> default_checkpoint(const RenderRequest& request);

// Combines the options. Prints a message and returns an exit code if options conflict, whatever the scene.
std::optional<ExitCode> resolve_options(RenderRequest& request, const Streams& streams);

// Overrides the scene's settings, camera, size and crop with the request's. Prints a message and returns an exit code
// if they do not fit together.
std::optional<ExitCode> override_scene(RenderRequest& request, compiler::CompiledScene& scene,
                                       const Streams& streams);

// Overrides the scene's field of view and camera with the request's. The size of the scene's film must be final.
// Prints a message and returns an exit code if they do not fit together.
std::optional<ExitCode> override_camera(const RenderRequest& request, compiler::CompiledScene& scene,
                                        const Streams& streams);

}  // namespace fathom::cli
