// The command line's camera: --position, --look-at and --frame.
// Tested by: tests/runtime/cli/options/cli_camera_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "compiler/scene/compiled_scene.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/exit_code.h"
#include "runtime/cli/options/streams.h"

namespace fathom::cli {

struct CameraOptions {
  std::optional<glm::dvec3> position, look_at;  // in scene coordinates
  bool frame = false;
};

void add_camera_options(Arguments& arguments, CameraOptions& options);

// Places the scene's camera for its film, whose size must be settled, and for its field of view. If the scene has no
// camera, a default camera first frames the whole scene. The options then override the camera. Prints a message and
// returns an exit code if the options make no valid camera.
std::optional<ExitCode> place_camera(const CameraOptions& options, compiler::CompiledScene& scene,
                                     const Streams& streams);

// Returns the camera as in a scene file, in scene coordinates: `"camera": {"position": [0, 1, 4], ...}`.
std::string camera_text(const compiler::CompiledScene& scene);

}  // namespace fathom::cli
