// The viewer without HTTP: the scene, its true picture, and the answers about both.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/cli/view/picture_files.h"
#include "runtime/cli/view/relevance.h"
#include "runtime/cli/view/true_picture.h"
#include "runtime/cli/view/viewed_scene.h"

namespace fathom::cli {

struct Answer {
  int status = 200;  // of HTTP
  std::string type = "application/json";
  std::string body = {};
  int picture = 0;  // number of the picture that the answer shows; 0: none
};

class ViewSession {
 public:
  ViewSession(const RenderRequest& request, int threads);
  ~ViewSession();

  // Value of a parameter of the request's address; empty without one.
  using Query = std::function<std::string(const char* name)>;

  // Each returns an answer; `name` is the path after the token.
  Answer get(std::string_view name, const Query& query);
  Answer post(std::string_view name, const std::string& body);

  // Waits until something has changed since `seen`, which it brings up to date, or `seconds` are over. Returns the
  // events as server-sent events: a comment alone if nothing has changed.
  struct Seen {
    int scene = 0, picture = 0;
  };
  std::string wait_for_events(Seen& seen, double seconds);
  // Ends all waiting.
  void stop();
  bool is_over() const { return over_; }
  SceneState state() const { return scene_.state(); }

 private:
  Answer scene_answer() const;
  Answer picture_answer(const Query& query);
  Answer pixel_answer_at(const Query& query);
  Answer pixels_answer(const Query& query);
  Answer listing_answer(const Query& query);
  Answer set_camera(const std::string& body);
  Answer set_parameters(const std::string& body);
  Answer keep(const std::string& body);
  void on_scene();
  void on_picture();

  const SceneArguments arguments_;
  std::mutex mutex_;  // of the events
  std::condition_variable changed_;
  std::atomic<bool> over_ = false;
  std::mutex asking_;                           // held while an answer is computed that may take long: one at a time
  std::pair<int, int> relevance_view_;          // id of the view and version of the scene
  std::unique_ptr<const Relevance> relevance_;  // of that view
  PictureFiles files_;
  TruePicture picture_;
  ViewedScene scene_;  // last: its thread uses the others
};

}  // namespace fathom::cli
