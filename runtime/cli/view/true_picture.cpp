#include "runtime/cli/view/true_picture.h"

#ifdef __linux__
#include <sys/resource.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "runtime/film/adaptive.h"
#include "runtime/sampling/camera.h"
#include "vm/number/real.h"

namespace fathom::cli {
namespace {

using Clock = std::chrono::steady_clock;

// Shares of the view's size that coarse pictures have, and the time that a coarse picture may take for the next to be
// drawn: beyond, the picture itself is not far.
constexpr int kCoarse[] = {8, 3};
constexpr double kCoarseSeconds = 0.1;
// Samples are taken in rounds, each of twice as many as the one before until a round takes this long, seconds.
constexpr double kRoundSeconds = 0.5;

constexpr int kNice = 10;

// Lets the page and the editor go first on a busy machine. Threads that the calling thread starts have its priority.
// Only Linux has priorities of single threads.
void lower_priority() {
#ifdef __linux__
  setpriority(PRIO_PROCESS, 0, kNice);
#endif
}

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// The scene of one view, with its moments, and the options of its render.
class ViewRender {
 public:
  ViewRender(std::shared_ptr<const LoadedScene> loaded, const PictureView& view, int threads,
             std::shared_ptr<const std::atomic<bool>> cancel)
      : loaded_(std::move(loaded)),
        scene_(loaded_->scene()),
        moments_(loaded_->picture->moments),
        options_(loaded_->picture->request.options),
        cancel_(std::move(cancel)) {
    scene_.camera = view_camera(loaded_->scene(), view.pose, view.width, view.height);
    set_size(view.width, view.height);
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      moments_[i].camera = view_camera(moments_[i], view.pose, view.width, view.height);
      options_.moments[i].scene = &moments_[i];
    }
    options_.threads = threads;
    options_.uniform = true;
    options_.cancel = cancel_.get();
    options_.layers = {.first_hit = true, .cost = true, .variance = true, .halves = true};
  }

  const compiler::CompiledScene& scene() const { return scene_; }
  int spp() const { return runtime::resolve(scene_, options_).spp; }

  // Renders one sample per pixel of a smaller picture.
  runtime::RenderResult coarse(int width, int height) {
    set_size(width, height);
    runtime::RenderOptions options = options_;
    options.regions = options.native_code = false;  // take longer to make than to do without
    options.sample_range = runtime::SampleRange{0, 1};
    return runtime::render(scene_, options);
  }

  runtime::RenderResult samples(const PictureView& view, std::uint32_t first, std::uint32_t last) {
    set_size(view.width, view.height);
    runtime::RenderOptions options = options_;
    options.sample_range = runtime::SampleRange{first, last};
    return runtime::render(scene_, options);
  }

 private:
  void set_size(int width, int height) { scene_.film.width = width, scene_.film.height = height; }

  const std::shared_ptr<const LoadedScene> loaded_;
  compiler::CompiledScene scene_;
  std::vector<compiler::CompiledScene> moments_;
  runtime::RenderOptions options_;
  const std::shared_ptr<const std::atomic<bool>> cancel_;
};

bool is_whole(const runtime::RenderResult& result) { return result.stats.end == runtime::RenderEnd::Done; }

}  // namespace

// A render in a thread of low priority. The destructor waits for its end.
class TruePicture::Round {
 public:
  // Calls `on_done` from that thread.
  Round(std::function<runtime::RenderResult()> render, std::function<void()> on_done)
      : thread_([this, render = std::move(render), on_done = std::move(on_done)] {
          lower_priority();
          result_ = render();
          is_done_ = true;
          on_done();
        }) {}
  ~Round() { thread_.join(); }
  Round(const Round&) = delete;
  Round& operator=(const Round&) = delete;

  bool is_done() const { return is_done_; }
  // Call once, when the round is done.
  runtime::RenderResult take() { return std::move(result_); }

 private:
  runtime::RenderResult result_;
  std::atomic<bool> is_done_ = false;
  std::thread thread_;
};

compiler::Camera view_camera(const compiler::CompiledScene& scene, const std::optional<CameraPose>& pose, int width,
                             int height) {
  using Projection = compiler::Camera::Projection;
  compiler::Camera camera = scene.camera;
  double half = 0;
  if (pose) {
    camera.position = pose->position - scene.origin, camera.target = pose->target - scene.origin;
    camera.up = pose->up;
    camera.projection = pose->orthographic ? Projection::Orthographic : Projection::Perspective;
    half = pose->half_width;
  } else {
    if (camera.projection == Projection::Panorama) return camera;
    const glm::dvec2 own = runtime::Camera(camera, scene.film.width, scene.film.height).half_extent();
    half = std::max(own.x, own.y * width / height);
  }
  camera.width = 2 * half;
  camera.fov = 2 * vm::real::atan(half);
  camera.vertical_fov.reset();
  camera.focal_length.reset();
  return camera;
}

TruePicture::TruePicture(int threads, std::function<void()> on_change)
    : threads_(threads), on_change_(std::move(on_change)), thread_([this] { run(); }) {}

TruePicture::~TruePicture() {
  {
    const std::lock_guard lock(mutex_);
    over_ = *cancel_ = true;
  }
  wake_.notify_one();
  thread_.join();
  round_ = nullptr;
}

void TruePicture::set_scene(std::shared_ptr<const LoadedScene> scene) {
  {
    const std::lock_guard lock(mutex_);
    scene_ = std::move(scene);
    latest_ = nullptr;
    changed_ = *cancel_ = true;
  }
  wake_.notify_one();
}

void TruePicture::set_view(PictureView view) {
  {
    const std::lock_guard lock(mutex_);
    view_ = std::move(view);
    latest_ = nullptr;
    changed_ = *cancel_ = true;
  }
  wake_.notify_one();
}

PictureView TruePicture::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

std::shared_ptr<const Picture> TruePicture::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void TruePicture::run() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    wake_.wait(lock, [this] { return over_ || (changed_ && scene_ && view_.width > 0); });
    if (over_) return;
    changed_ = false;
    cancel_ = std::make_shared<std::atomic<bool>>(false);
    const auto scene = scene_;
    const PictureView view = view_;
    const auto cancel = cancel_;
    lock.unlock();
    render(scene, view, cancel);
    lock.lock();
  }
}

void TruePicture::render(std::shared_ptr<const LoadedScene> scene, const PictureView& view,
                         std::shared_ptr<const std::atomic<bool>> cancel) {
  const auto work = std::make_shared<ViewRender>(scene, view, threads_, std::move(cancel));
  const Clock::time_point start = Clock::now();
  Picture picture{0, std::move(scene), view, work->scene().camera, 0, work->spp(), 0, std::nullopt, {}};
  for (const int share : kCoarse) {
    const Clock::time_point begin = Clock::now();
    const int width = std::max(1, view.width / share), height = std::max(1, view.height / share);
    const auto coarse = [=] { return work->coarse(width, height); };
    // The first look does not wait for anything.
    std::optional<runtime::RenderResult> result = share == kCoarse[0] ? coarse() : in_background(coarse);
    if (!result || !is_whole(*result)) return;
    picture.film = std::move(result->film);
    picture.seconds = since(start);
    publish(picture);
    if (since(begin) > kCoarseSeconds) break;
  }
  const auto spp = static_cast<std::uint32_t>(picture.spp);
  std::uint32_t size = 1;
  for (std::uint32_t first = 0; first < spp;) {
    const Clock::time_point begin = Clock::now();
    const std::uint32_t last = std::min(spp, first + size);
    std::optional<runtime::RenderResult> result = in_background([=] { return work->samples(view, first, last); });
    if (!result || !is_whole(*result)) return;
    if (first == 0)
      picture.film = std::move(result->film);
    else
      picture.film.merge(result->film);
    picture.samples = static_cast<int>(last);
    picture.seconds = since(start);
    if (last >= 2) picture.noise = runtime::image_noise(picture.film, picture.film.area());
    publish(picture);
    if (since(begin) < kRoundSeconds && first > 0) size *= 2;
    first = last;
  }
}

// Returns nullopt as soon as the render is out of date: the next first look need not wait for its end.
std::optional<runtime::RenderResult> TruePicture::in_background(std::function<runtime::RenderResult()> render) {
  round_ = nullptr;  // waits for the end of a render that was out of date
  round_ = std::make_unique<Round>(std::move(render), [this] {
    const std::lock_guard lock(mutex_);
    wake_.notify_one();
  });
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [this] { return over_ || changed_ || round_->is_done(); });
  if (over_ || changed_) return std::nullopt;
  return round_->take();
}

void TruePicture::publish(Picture picture) {
  {
    const std::lock_guard lock(mutex_);
    if (changed_) return;  // the picture is out of date
    picture.number = ++number_;
    latest_ = std::make_shared<const Picture>(std::move(picture));
  }
  on_change_();
}

}  // namespace fathom::cli
