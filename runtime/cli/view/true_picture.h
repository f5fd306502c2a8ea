// The path-traced picture of the viewer: rendered in a thread of its own, first coarsely, then with more and more
// samples, and from the beginning whenever the scene or the camera changes.
//
// With all samples it has the bits of `fathom render --uniform` of the same size and camera.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "runtime/cli/view/viewed_scene.h"
#include "runtime/film/film.h"
#include "runtime/render.h"

namespace fathom::cli {

// A camera that the page has moved, in scene coordinates.
struct CameraPose {
  glm::dvec3 position, target, up;
  double half_width;  // of the image, at unit distance for a perspective camera
  bool orthographic;
};

// Returns the camera of a picture of that size. Without a pose it is the scene's own, which sees at least as much as
// in a picture of the scene's size.
compiler::Camera view_camera(const compiler::CompiledScene& scene, const std::optional<CameraPose>& pose, int width,
                             int height);

struct PictureView {
  int id = 0;                 // the page's number of this view
  int width = 0, height = 0;  // pixels
  std::optional<CameraPose> pose;
};

// A state of the picture. Does not change.
struct Picture {
  int number = 0;  // counts all states
  std::shared_ptr<const LoadedScene> scene;
  PictureView view;
  compiler::Camera camera;      // in the programs' coordinates
  int samples = 0;              // per pixel; 0 for a coarse picture
  int spp = 0;                  // samples of the finished picture
  double seconds = 0;           // of rendering
  std::optional<double> noise;  // as for `fathom render --noise-threshold`; needs two samples
  runtime::Film film;           // of a coarse picture: smaller than the view

  bool done() const { return samples == spp; }
};

class TruePicture {
 public:
  // Calls `on_change` from the rendering thread after each state. `threads`: 0 for one per processor.
  TruePicture(int threads, std::function<void()> on_change);
  ~TruePicture();
  TruePicture(const TruePicture&) = delete;
  TruePicture& operator=(const TruePicture&) = delete;

  void set_scene(std::shared_ptr<const LoadedScene> scene);
  void set_view(PictureView view);
  PictureView view() const;

  // Returns the newest state, or null before the first of this scene and view.
  std::shared_ptr<const Picture> latest() const;

 private:
  class Round;

  void run();
  void render(std::shared_ptr<const LoadedScene> scene, const PictureView& view,
              std::shared_ptr<const std::atomic<bool>> cancel);
  std::optional<runtime::RenderResult> in_background(std::function<runtime::RenderResult()> render);
  void publish(Picture picture);

  const int threads_;
  const std::function<void()> on_change_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::shared_ptr<const LoadedScene> scene_;
  PictureView view_;
  std::shared_ptr<const Picture> latest_;
  int number_ = 0;
  bool changed_ = false, over_ = false;
  std::shared_ptr<std::atomic<bool>> cancel_ = std::make_shared<std::atomic<bool>>(false);  // of the render that runs
  std::unique_ptr<Round> round_;                                                            // of the rendering thread
  std::thread thread_;
};

}  // namespace fathom::cli
