// One picture of a scene: compiled, with all that it takes beside the scene, and ready to be rendered.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/frames/cli_frames_test.cpp,
// tests/runtime/cli/frames/cli_shutter_test.cpp
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/request/render_request.h"
#include "runtime/field/region_store.h"

namespace fathom::cli {

struct Picture {
  RenderRequest request;  // its options are those of the render
  compiler::CompiledScene scene;
  std::vector<compiler::CompiledScene> moments;  // that the shutter sees; the options point to them
};

// What the next picture of a scene need not make again, where it would be the same.
struct KeptWork {
  std::shared_ptr<runtime::RegionStore> regions = std::make_shared<runtime::RegionStore>();
  std::string background_file;
  std::shared_ptr<const runtime::EnvironmentImage> background;  // that was in it
  std::string messages;                                         // what the compiler said last
  bool begun = false;  // a picture was drawn, so what is always so has been said
};

// Or the exit code after a message.
std::variant<std::unique_ptr<Picture>, ExitCode> prepare_picture(const RenderRequest& request,
                                                                 const SceneInput& input, KeptWork& kept,
                                                                 const Streams& streams);

}  // namespace fathom::cli
