// --position, --look-at and --frame: where a picture is taken from, said on the command line.
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
  std::optional<glm::dvec3> position, look_at;  // in the scene's coordinates
  bool frame = false;
};

void add_camera_options(Arguments& arguments, CameraOptions& options);

// Places the scene's camera for its film, whose size is settled, and for its field of view. A camera that the scene
// does not have frames the scene; then come the options. An ExitCode after a message where they make no camera.
std::optional<ExitCode> place_camera(const CameraOptions& options, compiler::CompiledScene& scene,
                                     const Streams& streams);

// The camera as a scene file has it, in the scene's coordinates: `"camera": {"position": [0, 1, 4], ...}`.
std::string camera_text(const compiler::CompiledScene& scene);

}  // namespace fathom::cli
