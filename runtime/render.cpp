#include "runtime/render.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/base/machine.h"
#include "runtime/base/tiles.h"
#include "runtime/field/pieces.h"
#include "runtime/field/region_store.h"
#include "runtime/film/adaptive.h"
#include "runtime/passes.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

using Clock = SharedFilm::Clock;

// Returns the function that interrupts building regions. The cost layer shows how much of the program was evaluated,
// so a render that keeps this layer ignores the time limit here: a resumed render then has the same regions.
std::function<bool()> interruption(const Settings& settings, const RenderOptions& options, Clock::time_point start) {
  const std::optional<double> limit = settings.layers.cost ? std::nullopt : options.time_limit;
  return [cancel = options.cancel, limit, start] {
    if (cancel && cancel->load(std::memory_order_relaxed)) return true;
    return limit && std::chrono::duration<double>(Clock::now() - start).count() >= *limit;
  };
}

// Calls on_tick every kTickSeconds, from a thread of its own, until the Ticker is destroyed.
class Ticker {
 public:
  Ticker(const RenderOptions& options, SharedFilm& shared_film) {
    if (!options.on_tick) return;
    thread_ = std::thread([this, &options, &shared_film] {
      std::unique_lock lock(mutex_);
      while (!ended_.wait_for(lock, std::chrono::duration<double>(kTickSeconds), [this] { return over_; })) {
        options.on_tick([&](const auto& use) { shared_film.read(use); });
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

std::uint64_t samples_of(const Settings& settings) {
  const std::uint32_t each = settings.samples.size();
  return std::uint64_t{settings.crop.pixels()} * each;
}

// True if a number names the same surface or material in both scenes.
bool same_numbers(const compiler::CompiledScene& a, const compiler::CompiledScene& b) {
  const auto same_surface = [](const compiler::Surface& one, const compiler::Surface& other) {
    return one.name == other.name && one.material == other.material;
  };
  const auto same_name = [](const compiler::Material& one, const compiler::Material& other) {
    return one.name == other.name;
  };
  return std::ranges::equal(a.surfaces, b.surfaces, same_surface) &&
         std::ranges::equal(a.materials, b.materials, same_name);
}

// Returns the samples per pixel of all moments that have the same regions as `scene`: together these samples have to
// repay the cost of building the regions.
int samples_with(const compiler::CompiledScene& scene, const Settings& settings, const RenderOptions& options) {
  if (options.moments.empty()) return settings.spp;
  std::uint32_t samples = 0;
  for (const Moment& moment : options.moments) {
    const bool same = moment.scene->surface.program().words == scene.surface.program().words;
    if (same) samples += moment.samples.size();
  }
  return static_cast<int>(samples);
}

// Calls use(field) for the field, or for the fields of its pieces.
template <class Use>
void for_each_part(const Field& field, const Use& use) {
  if (field.pieces) return void(std::ranges::for_each(field.pieces->fields, use));
  use(field);
}

RenderContext make_context(const compiler::CompiledScene& scene, const Settings& settings,
                           const RenderOptions& options, Clock::time_point start) {
  RenderContext context{scene,
                        settings,
                        Camera(scene.camera, settings.width, settings.height),
                        Filter(settings.filter, settings.filter_width),
                        make_field(scene, settings.far),
                        Media(scene, extent_of(scene), settings.far),
                        Materials(scene),
                        Lights(scene, options.environment),
                        {},
                        true};
  Settings share = settings;
  share.spp = samples_with(scene, settings, options);
  RegionOptions regions = region_options(share);
  regions.interrupted = interruption(settings, options, start);
  RegionStore* const store = options.region_store.get();
  const double evaluations = region_options(settings).evaluations;
  const auto prepare = [&](Field& field, const compiler::SplitField& split) {
    if (settings.pieces)
      add_pieces(field, split, extent_of(scene), settings.far, settings.native_code,
                 settings.regions ? &regions : nullptr, store);
    if (!field.pieces && settings.regions) add_regions(field, split, regions, store);
    if (!field.pieces && settings.native_code) add_native_code(field, evaluations);
    for_each_part(field, [&](const Field& part) {
      if (part.regions) regions.memory -= std::min(regions.memory, part.regions->summary().bytes);
    });
  };
  prepare(context.field, scene);
  for (std::size_t i = 0; i < scene.media.size(); ++i) prepare(context.media.field(i), scene.media[i]);
  RealScratch scratch;
  const glm::dvec3 eye = context.camera.position();
  if (is_uniform_around(eye, context.camera.spread(context.filter.radius()), context.field, context.media, scratch)) {
    context.camera_medium = medium_at(eye, context.media, context.materials, scratch);
  }
  return context;
}

void check(const Settings& settings) {
  const PixelRect crop = settings.crop;
  CHECK(crop.width() > 0 && crop.height() > 0 && settings.spp > 0 && settings.tile > 0, "nothing to render");
  CHECK(crop.x0 >= 0 && crop.y0 >= 0 && crop.x1 <= settings.width && crop.y1 <= settings.height, "a crop within");
  const auto spp = static_cast<std::uint32_t>(settings.spp);
  CHECK(settings.samples.first < settings.samples.last && settings.samples.last <= spp, "samples within the plan");
  const bool whole = crop == PixelRect{0, 0, settings.width, settings.height} && settings.samples.size() == spp;
  CHECK(whole || !settings.noise_threshold, "samples shared out in a part");
}

// Returns the ranges of samples to take, each with its scene.
std::vector<Moment> moments_of(const compiler::CompiledScene& scene, const Settings& settings,
                               const RenderOptions& options) {
  if (options.moments.empty()) return {{&scene, settings.samples}};
  CHECK(!settings.noise_threshold, "moments of samples that are shared out");
  std::vector<Moment> moments;
  std::uint32_t end = 0;
  for (const Moment& moment : options.moments) {
    CHECK(moment.samples.first == end && moment.scene->origin == scene.origin, "moments in order about one origin");
    end = moment.samples.last;
    const auto both = intersection({settings.crop, moment.samples}, {settings.crop, settings.samples});
    if (both) moments.push_back({moment.scene, both->samples});
  }
  CHECK(end == static_cast<std::uint32_t>(settings.spp), "a moment for every sample");
  return moments;
}

void count_regions(const RenderContext& context, const RenderOptions& options, Stats& stats) {
  std::uint64_t bytes = 0;
  const auto count = [&](const Field& field) {
    if (!field.regions) return;
    const Regions::Summary& summary = field.regions->summary();
    bytes += summary.bytes;
    const bool reused = options.region_store && options.region_store->reused(*field.regions);
    stats.region_seconds += reused ? 0 : summary.seconds;
    stats.regions_reused += reused;
  };
  for_each_part(context.field, count);
  for (std::size_t i = 0; i < context.media.size(); ++i) for_each_part(context.media.field(i), count);
  stats.region_bytes = std::max(stats.region_bytes, bytes);
}

}  // namespace

// A user may stop a render after its first samples, so building regions takes no longer than a few samples without
// regions.
RegionOptions region_options(const Settings& settings) {
  constexpr double kEvaluationsPerRay = 10;
  constexpr int kMaxSamples = 16;
  const double pixels = static_cast<double>(settings.width) * settings.height;
  const double paths = pixels * std::min(settings.spp, kMaxSamples);
  RegionOptions regions{.threads = settings.threads, .memory = settings.region_memory};
  regions.evaluations = kEvaluationsPerRay * paths * (1 + std::min(settings.rr_depth, 3));
  return regions;
}

Settings resolve(const compiler::CompiledScene& scene, const RenderOptions& options) {
  Settings settings{with_overrides(scene.film, options), with_overrides(scene.settings, options), options, {}, {}};
  if (options.uniform || settings.spp < kMinAdaptiveSpp) settings.noise_threshold.reset();
  settings.layers.variance |= settings.noise_threshold.has_value();
  if (settings.threads <= 0) settings.threads = usable_processors();
  settings.crop = options.crop.value_or(PixelRect{0, 0, settings.width, settings.height});
  settings.samples = options.sample_range.value_or(SampleRange{0, static_cast<std::uint32_t>(settings.spp)});
  return settings;
}

bool can_resume(const PartialRender& render, const Settings& settings) {
  const auto tiles = static_cast<std::size_t>(Tiles(settings.crop, kAdaptiveTile).count());
  const bool adaptive = render.adaptive.used();
  return render.film.area() == settings.crop && render.film.layers() == settings.layers &&
         render.covered.size() == render.film.stages() &&
         render.film.stages() == (adaptive ? stages_of(settings) : 1) &&
         (!adaptive || (settings.noise_threshold && render.adaptive.tiles.size() == tiles));
}

RenderResult render(const compiler::CompiledScene& scene, const RenderOptions& options) {
  const auto start = Clock::now();
  const Settings settings = resolve(scene, options);
  check(settings);
  RenderResult result{{}, settings, {}};
  if (options.resume_from) {
    CHECK(can_resume(*options.resume_from, settings), "a film of another render");
    static_cast<PartialRender&>(result) = std::exchange(*options.resume_from, {});
  } else {
    result.film = Film(settings.crop, settings.layers);
    result.covered.resize(1);
  }
  const std::uint64_t resumed = options.resume_from ? result.film.samples() : 0;
  SharedFilm shared_film(result, samples_of(settings), options, start);
  std::optional<Ticker> ticker;
  for (const Moment& moment : moments_of(scene, settings, options)) {
    if (!options.moments.empty()) {
      shared_film.modify([&] { result.covered.front().canonicalise(); });
      if (result.covered.front().covers({settings.crop, moment.samples})) continue;
    }
    if (moment.samples.first > settings.samples.first && shared_film.should_stop()) break;
    RenderContext context = make_context(*moment.scene, settings, options, start);
    context.numbered = same_numbers(scene, *moment.scene);
    if (options.region_store) options.region_store->drop_unused();
    if (!ticker) ticker.emplace(options, shared_film);
    Passes passes(context, options, result, shared_film);
    result.stats.merge(passes.run(moment.samples));
    result.stats.end = passes.end();
    count_regions(context, options, result.stats);
  }
  ticker.reset();
  if (shared_film.end() != RenderEnd::Done) result.stats.end = shared_film.end();
  for (Coverage& covered : result.covered) covered.canonicalise();
  result.stats.seconds = shared_film.seconds();
  result.stats.threads = settings.threads;
  result.stats.resumed_samples = resumed;
  return result;
}

}  // namespace fathom::runtime
