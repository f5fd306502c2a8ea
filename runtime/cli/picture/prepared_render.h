// One picture of a scene: the scene compiled and everything else prepared, ready to be rendered.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/frames/cli_frames_test.cpp,
// tests/runtime/cli/frames/cli_shutter_test.cpp
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/request/render_request.h"
#include "runtime/field/region_store.h"

namespace fathom::cli {

struct PreparedRender {
  RenderRequest request;  // request.options are the options of the render
  compiler::CompiledScene scene;
  std::vector<compiler::CompiledScene> moments;  // the scene during the open shutter; request.options point to them
};

// Work that the next picture of a scene reuses where the result would be the same.
struct RenderCache {
  std::shared_ptr<runtime::RegionStore> regions = std::make_shared<runtime::RegionStore>();
  std::string background_file;
  std::shared_ptr<const runtime::EnvironmentMap> background;    // of the image in background_file
  std::string messages;                                         // the compiler's last messages
  bool begun = false;  // a picture was drawn, so the notes common to all pictures have been printed
};

// Reads the environment map in `file`, which scenes call `name`. Returns an exit code after a message.
std::optional<ExitCode> cache_background(const std::string& file, const std::string& name,
                                         const SceneArguments& arguments, RenderCache& cache, const Streams& streams);

// Returns the picture, or the exit code after a message.
std::variant<std::unique_ptr<PreparedRender>, ExitCode> prepare_render(const RenderRequest& request,
                                                                       const SceneInput& input, RenderCache& cache,
                                                                       const Streams& streams);

}  // namespace fathom::cli
