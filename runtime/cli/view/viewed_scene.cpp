#include "runtime/cli/view/viewed_scene.h"

#include <sstream>
#include <utility>

#include "runtime/live/live_scene.h"

namespace fathom::cli {
namespace {

// Time between polls: a change counts after two, so that it shows within a tenth of a second.
constexpr std::chrono::milliseconds kPoll{8};

}  // namespace

ViewedScene::ViewedScene(const RenderRequest& request, std::function<void()> on_change)
    : request_(request), on_change_(std::move(on_change)), files_({request.scene.path}) {
  load();
  thread_ = std::thread([this] { run(); });
}

ViewedScene::~ViewedScene() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

SceneState ViewedScene::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void ViewedScene::define(compiler::Definitions values) {
  {
    const std::lock_guard lock(mutex_);
    values_ = std::move(values);
    redefined_ = true;
  }
  wake_.notify_one();
}

void ViewedScene::run() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    const bool redefined = wake_.wait_for(lock, kPoll, [this] { return over_ || redefined_; });
    if (over_) return;
    lock.unlock();
    if (redefined || files_.settled()) {
      load();
      on_change_();
    }
    lock.lock();
  }
}

void ViewedScene::load() {
  RenderRequest request = request_;
  SceneState state;
  {
    const std::lock_guard lock(mutex_);
    redefined_ = false;
    state.version = state_.version + 1;
    state.loaded = state_.loaded;
    request.scene.definitions.insert(request.scene.definitions.end(), values_.begin(), values_.end());
  }
  request.scene.on_import = [&](const std::string& path) { files_.add(path); };
  cache_.background = nullptr;  // its file may have changed
  cache_.messages.clear();
  std::istringstream in;
  std::ostringstream out, err;
  read_into(state, request, {in, out, err});
  state.messages = std::move(err).str();
  if (state.good && !state.loaded->scene().background.image.file.empty()) {
    files_.add(state.loaded->scene().background.image.file);
  }
  const std::lock_guard lock(mutex_);
  state_ = std::move(state);
}

// Reads and compiles the scene. `state` receives its text, and the scene if there is no error.
void ViewedScene::read_into(SceneState& state, const RenderRequest& request, const Streams& streams) {
  auto read = read_scene(request.scene, streams);
  if (std::holds_alternative<ExitCode>(read)) return;
  auto& input = std::get<SceneInput>(read);
  state.text = input.source.text();
  auto prepared = prepare_render(request, input, cache_, streams);
  if (std::holds_alternative<ExitCode>(prepared)) return;
  auto& picture = std::get<std::unique_ptr<PreparedRender>>(prepared);
  auto defaults = defaults_of(input, *picture, state.loaded.get());
  // Made here, before the true picture occupies all processors.
  nlohmann::json live = runtime::live_scene(picture->scene);
  state.good = true;
  state.loaded = std::make_shared<const LoadedScene>(LoadedScene{
      state.version, std::move(input), request.scene, std::move(picture), std::move(defaults), std::move(live)});
}

// Returns the parameters with the file's values. A scene whose values were replaced is compiled once more without
// them, unless its text is that of the version before.
std::vector<compiler::Parameter> ViewedScene::defaults_of(const SceneInput& input, const PreparedRender& picture,
                                                          const LoadedScene* before) const {
  if (picture.request.scene.definitions.size() == request_.scene.definitions.size()) return picture.scene.parameters;
  if (before && before->input.source.text() == input.source.text()) return before->defaults;
  std::istringstream in;
  std::ostringstream out, err;
  const auto compiled = compile_scene(input, request_.scene, {in, out, err});
  const auto* scene = std::get_if<compiler::CompiledScene>(&compiled);
  return scene ? scene->parameters : picture.scene.parameters;
}

}  // namespace fathom::cli
