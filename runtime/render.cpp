#include "runtime/render.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/adaptive.h"
#include "runtime/shared_picture.h"
#include "runtime/tiles.h"
#include "runtime/unit_worker.h"
#include "vm/check.h"

namespace fathom::runtime {
namespace {

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

// Calls on_tick now and then until it is destroyed.
class Ticker {
 public:
  Ticker(const RenderOptions& options, SharedPicture& picture) {
    if (!options.on_tick) return;
    thread_ = std::thread([this, &options, &picture] {
      std::unique_lock lock(mutex_);
      while (!ended_.wait_for(lock, std::chrono::duration<double>(kTickSeconds), [this] { return over_; })) {
        options.on_tick([&](const auto& use) { picture.look(use); });
      }
    });
  }
  ~Ticker() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    ended_.notify_one();
    thread_.join();
  }
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
  std::thread thread_;
};

Stats run_threads(const PassWork& pass, int threads) {
  std::vector<Stats> stats(static_cast<std::size_t>(threads));
  // Each thread makes its worker itself, so that what it writes to lies in memory of its own.
  const auto work = [&](Stats& counted) {
    const auto worker = std::make_unique<UnitWorker>(pass);
    worker->run();
    counted = worker->stats();
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < stats.size(); ++i) others.emplace_back([&, i] { work(stats[i]); });
  work(stats[0]);
  for (std::thread& thread : others) thread.join();
  Stats sum;
  for (const Stats& counted : stats) sum.merge(counted);
  return sum;
}

// All samples, in one pass, or in two of which the first says where the second is to look.
class Passes {
 public:
  Passes(const World& world, const RenderOptions& options, PartialRender& render,
         SharedPicture::Clock::time_point start)
      : world_(world),
        options_(options),
        render_(render),
        picture_(render, samples_of(world.settings), options, start) {}

  Stats run() {
    const Ticker ticker(options_, picture_);
    const Settings& settings = world_.settings;
    if (!settings.adaptive)
      return run_pass(0, {{settings.sampler, settings.seed, settings.spp}}, settings.samples, {});
    const int first = first_samples(settings.spp);
    Stats stats = run_pass(0, {{settings.sampler, settings.seed, first}}, {0, static_cast<std::uint32_t>(first)}, {});
    if (picture_.stopped()) return stats;
    stats.merge(run_second_stage(first));
    return stats;
  }

  RenderEnd end() const { return picture_.end(); }
  double seconds() const { return picture_.seconds(); }

 private:
  static std::uint64_t samples_of(const Settings& settings) {
    return std::uint64_t{settings.crop.pixels()} * settings.samples.size();
  }

  Stats run_second_stage(int first) {
    const Settings& settings = world_.settings;
    const PixelRect area = render_.film.area();
    std::vector<int> more = second_samples(estimates_of(render_.film), area.width(), area.height(), settings.spp);
    const auto most = static_cast<std::uint32_t>(*std::max_element(more.begin(), more.end()));
    if (render_.film.stages() == 1) {
      // The ticker's thread may be looking.
      picture_.change([&] {
        render_.film.begin_second_stage(first_share(settings.spp));
        render_.covered.resize(2);
      });
    }
    const Pass second{{settings.sampler, second_seed(settings.seed), settings.spp - first},
                      static_cast<std::uint32_t>(first)};
    return run_pass(1, second, {0, most}, SampleLimits(area, std::move(more)));
  }

  Stats run_pass(std::size_t stage, const Pass& pass, SampleRange samples, const SampleLimits& limits) {
    const Settings& settings = world_.settings;
    const PixelRect crop = settings.crop;
    const int side = tile_side(crop.width(), crop.height(), settings.tile, settings.threads);
    const Coverage before = render_.covered[stage];
    // Who sets a limit wants a whole picture early, whatever it is worth.
    UnitQueue units(crop, side, rounds_of(samples, options_.time_limit ? 1 : kFirstRound), before);
    return run_threads({world_, pass, stage, limits, units, picture_}, settings.threads);
  }

  const World& world_;
  const RenderOptions& options_;
  PartialRender& render_;
  SharedPicture picture_;
};

void check(const Settings& settings) {
  const PixelRect crop = settings.crop;
  CHECK(crop.width() > 0 && crop.height() > 0 && settings.spp > 0 && settings.tile > 0, "nothing to render");
  CHECK(crop.x0 >= 0 && crop.y0 >= 0 && crop.x1 <= settings.width && crop.y1 <= settings.height, "a crop within");
  const auto spp = static_cast<std::uint32_t>(settings.spp);
  CHECK(settings.samples.first < settings.samples.last && settings.samples.last <= spp, "samples within the plan");
  const bool whole = crop == PixelRect{0, 0, settings.width, settings.height} && settings.samples.size() == spp;
  CHECK(!settings.adaptive || whole, "samples shared out in a part");
}

}  // namespace

Settings resolve(const compiler::CompiledScene& scene, const RenderOptions& options) {
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  Settings settings{};
  settings.width = options.width.value_or(scene.film.width);
  settings.height = options.height.value_or(scene.film.height);
  settings.crop = options.crop.value_or(PixelRect{0, 0, settings.width, settings.height});
  settings.spp = options.spp.value_or(scene.settings.spp);
  settings.samples = options.sample_range.value_or(SampleRange{0, static_cast<std::uint32_t>(settings.spp)});
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
  const auto start = SharedPicture::Clock::now();
  const Settings settings = resolve(scene, options);
  check(settings);
  RenderResult result{{Film(settings.crop, settings.layers), std::vector<Coverage>(1)}, settings, {}};
  if (options.resume_from) {
    static_cast<PartialRender&>(result) = *options.resume_from;
    CHECK(result.film.area() == settings.crop && result.film.layers() == settings.layers, "a film of another render");
  }
  const std::uint64_t resumed = result.film.samples();
  const World world = make_world(scene, settings, options);
  Passes passes(world, options, result, start);
  result.stats = passes.run();
  for (Coverage& covered : result.covered) covered.tidy();
  if (world.field.regions) {
    result.stats.region_bytes = world.field.regions->facts().bytes;
    result.stats.region_seconds = world.field.regions->facts().seconds;
  }
  result.stats.seconds = passes.seconds();
  result.stats.threads = settings.threads;
  result.stats.resumed_samples = resumed;
  result.stats.end = passes.end();
  return result;
}

}  // namespace fathom::runtime
