#include "runtime/render.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/adaptive.h"
#include "runtime/integrator.h"
#include "runtime/tiles.h"
#include "vm/check.h"

namespace fathom::runtime {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Tells the caller how far all threads together are.
class ProgressReport {
 public:
  ProgressReport(const RenderOptions& options, const Settings& settings)
      : options_(options), paths_(static_cast<double>(settings.crop.pixels()) * settings.spp), start_(Clock::now()) {}

  void add(std::uint64_t paths, std::uint64_t rays) {
    if (!options_.on_progress) return;
    const std::lock_guard lock(mutex_);
    done_ += paths;
    rays_ += rays;
    options_.on_progress({static_cast<double>(done_) / paths_, rays_, seconds_since(start_)});
  }

 private:
  const RenderOptions& options_;
  double paths_;
  Clock::time_point start_;
  std::mutex mutex_;
  std::uint64_t done_ = 0, rays_ = 0;
};

// How many samples a pass takes of each pixel: of all the plan's, or so many of each.
class SampleCounts {
 public:
  explicit SampleCounts(int all) : all_(static_cast<std::uint32_t>(all)) {}
  SampleCounts(PixelRect area, std::vector<int> each) : area_(area), each_(std::move(each)) {}

  std::uint32_t at(int x, int y) const {
    return each_.empty() ? all_ : static_cast<std::uint32_t>(each_[area_.index(x, y)]);
  }

 private:
  std::uint32_t all_ = 0;
  PixelRect area_;
  std::vector<int> each_;  // [y][x]; empty: all_
};

// What the threads of one pass share.
struct PassWork {
  const World& world;
  Pass pass;
  SampleCounts counts;
  Film& film;
  ProgressReport& report;
  const std::atomic<bool>* cancel;

  bool cancelled() const { return cancel && cancel->load(std::memory_order_relaxed); }
};

// One thread's work: the paths of one tile after another, pixel by pixel, sample by sample.
class Worker {
 public:
  Worker(const PassWork& work, Tiles& tiles)
      : work_(work), tiles_(tiles), integrator_(work.world, work.pass, work.film) {}

  void run() {
    integrator_.run([this](std::span<PathKey> keys) { return next(keys); });
  }
  Stats stats() const { return integrator_.stats(); }

 private:
  std::size_t next(std::span<PathKey> keys) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      while (!tile_ || sample_ == samples_) {
        if (!next_pixel()) return i;
      }
      keys[i] = {x_, y_, sample_++};
    }
    return keys.size();
  }

  bool next_pixel() {
    if (tile_ && ++x_ == tile_->x1) {
      x_ = tile_->x0;
      ++y_;
    }
    if ((!tile_ || y_ == tile_->y1) && !next_tile()) return false;
    sample_ = 0;
    samples_ = work_.counts.at(x_, y_);
    tile_paths_ += samples_;
    return true;
  }

  bool next_tile() {
    if (tile_) report_tile();
    tile_ = work_.cancelled() ? std::nullopt : tiles_.take();
    if (!tile_) return false;
    x_ = tile_->x0;
    y_ = tile_->y0;
    return true;
  }

  void report_tile() {
    const std::uint64_t rays = integrator_.stats().march.rays;
    work_.report.add(tile_paths_, rays - reported_rays_);
    reported_rays_ = rays;
    tile_paths_ = 0;
  }

  const PassWork& work_;
  Tiles& tiles_;
  Integrator integrator_;
  std::optional<PixelRect> tile_;
  int x_ = 0, y_ = 0;
  std::uint32_t sample_ = 0, samples_ = 0;  // of the pixel
  std::uint64_t tile_paths_ = 0, reported_rays_ = 0;
};

World make_world(const compiler::CompiledScene& scene, const Settings& settings, const RenderOptions& options) {
  World world{scene,
              settings,
              Camera(scene.camera, settings.width, settings.height),
              Filter(settings.filter, settings.filter_width),
              make_field(scene, settings.far),
              Media(scene, extent_of(scene), settings.far),
              Materials(scene),
              Lights(scene, options.environment),
              {}};
  if (settings.regions) {
    const RegionOptions regions{.threads = settings.threads, .memory = settings.region_memory};
    add_regions(world.field, scene, regions);
    world.media.add_regions(scene, regions);
  }
  RealScratch scratch;
  const glm::dvec3 eye = world.camera.position();
  if (is_even_around(eye, world.camera.spread(world.filter.radius()), world.field, world.media, scratch)) {
    world.camera_space = space_at(eye, world.media, world.materials, scratch);
  }
  return world;
}

Stats render_pass(const PassWork& pass) {
  const Settings& settings = pass.world.settings;
  const PixelRect crop = settings.crop;
  Tiles tiles(crop, tile_side(crop.width(), crop.height(), settings.tile, settings.threads));
  std::vector<Stats> stats(static_cast<std::size_t>(settings.threads));
  // Each thread makes its worker itself, so that what it writes to lies in memory of its own.
  const auto work = [&](Stats& counted) {
    const auto worker = std::make_unique<Worker>(pass, tiles);
    worker->run();
    counted = worker->stats();
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < stats.size(); ++i) threads.emplace_back([&, i] { work(stats[i]); });
  work(stats[0]);
  for (std::thread& thread : threads) thread.join();
  Stats sum;
  for (const Stats& counted : stats) sum.merge(counted);
  return sum;
}

// All samples, in one pass, or in two of which the first says where the second is to look.
Stats render_passes(const World& world, Film& film, const RenderOptions& options) {
  const Settings& settings = world.settings;
  ProgressReport report(options, settings);
  const int first = settings.adaptive ? first_samples(settings.spp) : settings.spp;
  const Pass pass{{settings.sampler, settings.seed, first}};
  const PassWork work{world, pass, SampleCounts(first), film, report, options.cancel};
  Stats stats = render_pass(work);
  if (!settings.adaptive || work.cancelled()) return stats;
  std::vector<int> more = second_samples(estimates_of(film), film.width(), film.height(), settings.spp);
  film.begin_second_stage(first_share(settings.spp));
  const Pass second{{settings.sampler, second_seed(settings.seed), settings.spp - first},
                    static_cast<std::uint32_t>(first)};
  stats.merge(render_pass({world, second, SampleCounts(film.area(), std::move(more)), film, report, options.cancel}));
  return stats;
}

}  // namespace

Settings resolve(const compiler::CompiledScene& scene, const RenderOptions& options) {
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  Settings settings{};
  settings.width = options.width.value_or(scene.film.width);
  settings.height = options.height.value_or(scene.film.height);
  settings.crop = options.crop.value_or(PixelRect{0, 0, settings.width, settings.height});
  settings.spp = options.spp.value_or(scene.settings.spp);
  settings.bounces = options.bounces.value_or(scene.settings.bounces);
  settings.tile = options.tile.value_or(scene.settings.tile);
  settings.seed = options.seed.value_or(scene.settings.seed);
  settings.sampler = options.sampler.value_or(scene.settings.sampler);
  settings.filter = options.filter.value_or(scene.film.filter);
  settings.filter_width = options.filter || options.filter_width ? options.filter_width : scene.film.filter_width;
  settings.cut_after = options.cut_after;
  settings.adaptive = options.adaptive.value_or(scene.settings.adaptive) && settings.spp >= kLeastAdaptiveSpp;
  settings.light_sampling = options.light_sampling;
  settings.clamp = options.clamp;
  settings.marching = options.marching;
  settings.regions = options.regions;
  settings.region_memory = options.region_memory;
  settings.layers = options.layers;
  settings.layers.variance |= settings.adaptive;
  settings.profile = options.profile;
  settings.far = options.far ? options.far : scene.settings.far;
  settings.threads = options.threads > 0 ? options.threads : std::max(1, processors);
  return settings;
}

RenderResult render(const compiler::CompiledScene& scene, const RenderOptions& options) {
  const Clock::time_point start = Clock::now();
  const Settings settings = resolve(scene, options);
  const PixelRect crop = settings.crop;
  CHECK(crop.width() > 0 && crop.height() > 0 && settings.spp > 0 && settings.tile > 0, "nothing to render");
  CHECK(crop.x0 >= 0 && crop.y0 >= 0 && crop.x1 <= settings.width && crop.y1 <= settings.height, "a crop within");
  CHECK(!settings.adaptive || crop == (PixelRect{0, 0, settings.width, settings.height}),
        "samples shared out in a crop");
  const World world = make_world(scene, settings, options);
  RenderResult result{Film(crop, settings.layers), settings, {}};
  result.stats = render_passes(world, result.film, options);
  if (world.field.regions) {
    result.stats.region_bytes = world.field.regions->facts().bytes;
    result.stats.region_seconds = world.field.regions->facts().seconds;
  }
  result.stats.seconds = seconds_since(start);
  result.stats.threads = settings.threads;
  result.stats.cancelled = options.cancel && options.cancel->load();
  return result;
}

}  // namespace fathom::runtime
