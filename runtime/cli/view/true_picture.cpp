#include "runtime/cli/view/true_picture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "runtime/film/adaptive.h"
#include "runtime/render.h"
#include "runtime/sampling/camera.h"

namespace fathom::cli {
namespace {

using Clock = std::chrono::steady_clock;

// Shares of the view's size that coarse pictures have, and the time that a coarse picture may take for the next to be
// drawn: beyond, the picture itself is not far.
constexpr int kCoarse[] = {8, 3};
constexpr double kCoarseSeconds = 0.1;
// Samples are taken in rounds, each of twice as many as the one before until a round takes this long, seconds.
constexpr double kRoundSeconds = 0.5;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// The scene of one view, with its moments, and the options of its render.
class ViewRender {
 public:
  ViewRender(const LoadedScene& loaded, const PictureView& view, int threads, const std::atomic<bool>& cancel)
      : scene_(loaded.scene()), moments_(loaded.picture->moments), options_(loaded.picture->request.options) {
    scene_.camera = view_camera(loaded.scene(), view.pose, view.width, view.height);
    set_size(view.width, view.height);
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      moments_[i].camera = view_camera(moments_[i], view.pose, view.width, view.height);
      options_.moments[i].scene = &moments_[i];
    }
    options_.threads = threads;
    options_.uniform = true;
    options_.cancel = &cancel;
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

  compiler::CompiledScene scene_;
  std::vector<compiler::CompiledScene> moments_;
  runtime::RenderOptions options_;
};

bool is_whole(const runtime::RenderResult& result) { return result.stats.end == runtime::RenderEnd::Done; }

}  // namespace

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
  camera.fov = 2 * std::atan(half);
  camera.vertical_fov.reset();
  camera.focal_length.reset();
  return camera;
}

TruePicture::TruePicture(int threads, std::function<void()> on_change)
    : threads_(threads), on_change_(std::move(on_change)), thread_([this] { run(); }) {}

TruePicture::~TruePicture() {
  {
    const std::lock_guard lock(mutex_);
    over_ = cancel_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void TruePicture::set_scene(std::shared_ptr<const LoadedScene> scene) {
  {
    const std::lock_guard lock(mutex_);
    scene_ = std::move(scene);
    changed_ = cancel_ = true;
  }
  wake_.notify_one();
}

void TruePicture::set_view(PictureView view) {
  {
    const std::lock_guard lock(mutex_);
    view_ = std::move(view);
    changed_ = cancel_ = true;
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
    changed_ = cancel_ = false;
    const auto scene = scene_;
    const PictureView view = view_;
    lock.unlock();
    render(scene, view);
    lock.lock();
  }
}

void TruePicture::render(std::shared_ptr<const LoadedScene> scene, const PictureView& view) {
  ViewRender work(*scene, view, threads_, cancel_);
  const Clock::time_point start = Clock::now();
  Picture picture{0, std::move(scene), view, work.scene().camera, 0, work.spp(), 0, std::nullopt, {}};
  for (const int share : kCoarse) {
    const Clock::time_point begin = Clock::now();
    runtime::RenderResult result = work.coarse(std::max(1, view.width / share), std::max(1, view.height / share));
    if (!is_whole(result)) return;
    picture.film = std::move(result.film);
    picture.seconds = since(start);
    publish(picture);
    if (since(begin) > kCoarseSeconds) break;
  }
  const auto spp = static_cast<std::uint32_t>(picture.spp);
  std::uint32_t round = 1;
  for (std::uint32_t first = 0; first < spp;) {
    const Clock::time_point begin = Clock::now();
    const std::uint32_t last = std::min(spp, first + round);
    runtime::RenderResult result = work.samples(view, first, last);
    if (!is_whole(result)) return;
    if (first == 0)
      picture.film = std::move(result.film);
    else
      picture.film.merge(result.film);
    picture.samples = static_cast<int>(last);
    picture.seconds = since(start);
    if (last >= 2) picture.noise = runtime::image_noise(picture.film, picture.film.area());
    publish(picture);
    if (since(begin) < kRoundSeconds && first > 0) round *= 2;
    first = last;
  }
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
