// The scene that the viewer shows: read and compiled again whenever its file or the values of its parameters change.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "runtime/base/file_watch.h"
#include "runtime/cli/picture/prepared_render.h"

namespace fathom::cli {

// A version of the scene without errors. Does not change.
struct LoadedScene {
  int version;
  SceneInput input;
  SceneArguments arguments;  // with the parameters' values
  std::unique_ptr<PreparedRender> picture;
  std::vector<compiler::Parameter> defaults;  // the parameters with the values that the file gives them
  nlohmann::json live;                        // for the live picture (runtime/live/live_scene.h)

  const compiler::CompiledScene& scene() const { return picture->scene; }
};

struct SceneState {
  int version = 0;                            // number of times that the scene was read
  bool good = false;                          // false: the newest version has errors
  std::string messages;                       // errors and warnings of the newest version, as on a terminal
  std::string text;                           // of the scene's file
  std::shared_ptr<const LoadedScene> loaded;  // the newest version without errors, or null
};

class ViewedScene {
 public:
  // Reads the scene before it returns. Calls `on_change` after that, from a thread of its own, for every new version.
  ViewedScene(const RenderRequest& request, std::function<void()> on_change);
  ~ViewedScene();
  ViewedScene(const ViewedScene&) = delete;
  ViewedScene& operator=(const ViewedScene&) = delete;

  SceneState state() const;
  // Replaces the values of the scene's parameters. The command line's values stay where `values` has none.
  void define(compiler::Definitions values);

 private:
  void run();
  void load();
  void read_into(SceneState& state, const RenderRequest& request, const Streams& streams);
  std::vector<compiler::Parameter> defaults_of(const SceneInput& input, const PreparedRender& picture,
                                               const LoadedScene* before) const;

  const RenderRequest request_;
  const std::function<void()> on_change_;
  runtime::FileWatch files_;  // of the thread that loads
  RenderCache cache_;         // of the thread that loads
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  SceneState state_;
  compiler::Definitions values_;
  bool redefined_ = false, over_ = false;
  std::thread thread_;
};

}  // namespace fathom::cli
