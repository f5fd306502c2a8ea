#include "runtime/passes.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "runtime/base/tiles.h"
#include "runtime/film/adaptive.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

Stats run_threads(const PassWork& pass, int threads) {
  std::vector<Stats> stats(static_cast<std::size_t>(threads));
  // Each thread makes its worker itself, so that the worker writes to memory of its own.
  parallel_for(
      threads, stats.size(), [] { return 0; },
      [&](int, std::size_t i) {
        const auto worker = std::make_unique<UnitWorker>(pass);
        worker->run();
        stats[i] = worker->stats();
      });
  Stats sum;
  for (const Stats& counted : stats) sum.merge(counted);
  return sum;
}

// PathSample::number of the first sample of half B.
constexpr std::uint32_t kSecondHalf = 1u << 30;

// Returns the number of samples that the decided halves have when complete.
std::uint64_t samples_of(const AdaptiveState& state, PixelRect area) {
  const Tiles tiles(area, kAdaptiveTile);
  std::uint64_t samples = 0;
  for (std::size_t i = 0; i < state.tiles.size(); ++i) {
    const auto [first, second] = state.tiles[i].ends;
    samples += tiles.at(static_cast<std::int64_t>(i)).pixels() * (std::uint64_t{first} + second);
  }
  return samples;
}

}  // namespace

Stats Passes::run(SampleRange samples) {
  const Settings& settings = world_.settings;
  if (settings.noise_threshold) return run_adaptive();
  return run_pass(0, {{settings.sampler, settings.seed, settings.spp}}, samples, {});
}

RenderEnd Passes::end() const {
  if (picture_.end() != RenderEnd::Done || world_.settings.noise_threshold.value_or(0) <= 0) return picture_.end();
  const Tiles tiles(world_.settings.crop, kAdaptiveTile);
  for (std::int64_t i = 0; i < tiles.count(); ++i) {
    if (image_noise(render_.film, tiles.at(i)) > *world_.settings.noise_threshold) return RenderEnd::Done;
  }
  return RenderEnd::Noise;
}

Stats Passes::run_adaptive() {
  const Settings& settings = world_.settings;
  const double threshold = *settings.noise_threshold;
  AdaptiveState& state = render_.adaptive;
  if (render_.film.stages() == 1) {
    picture_.change([&] {
      render_.film.begin_stages(adaptive_stages(threshold));
      render_.covered.resize(render_.film.stages());
      state.tiles.resize(static_cast<std::size_t>(Tiles(settings.crop, kAdaptiveTile).count()));
    });
  }
  Stats stats;
  for (std::uint32_t end; (end = next_round(state.judged, settings.spp, threshold)) != 0;) {
    stats.merge(run_round(end));
    if (picture_.stopped()) return stats;
    picture_.change([&] { judge(render_.film, end, threshold, state); });
  }
  const bool decided = std::ranges::none_of(state.tiles, &AdaptiveTile::open);
  picture_.change([&] {
    if (!decided) assign_shares(render_.film, settings.spp, threshold, state);
    picture_.expect(samples_of(state, settings.crop) - render_.film.samples());
  });
  stats.merge(run_shares());
  return stats;
}

Pass Passes::pass_of(std::size_t half) const {
  const Settings& settings = world_.settings;
  const int each = settings.spp / 2;
  const std::uint64_t seed = half == 0 ? settings.seed : second_seed(settings.seed);
  return {{settings.sampler, seed, each}, half == 0 ? 0 : kSecondHalf};
}

Stats Passes::run_round(std::uint32_t end) {
  const AdaptiveState& state = render_.adaptive;
  const SampleRange round{state.judged, end};
  const Tiles tiles(world_.settings.crop, kAdaptiveTile);
  Stats stats;
  for (std::size_t stage = 0; stage < render_.film.stages(); ++stage) {
    const std::size_t half = stage % 2;
    Coverage others;
    bool some = false;
    for (std::size_t i = 0; i < state.tiles.size(); ++i) {
      const std::size_t wanted = state.tiles[i].ends[half] == 0 ? half : half + 2;
      if (state.tiles[i].open() && stage == wanted) {
        some = true;
      } else {
        others.add({tiles.at(static_cast<std::int64_t>(i)), round});
      }
    }
    if (some) stats.merge(run_pass(stage, pass_of(half), round, {}, others));
  }
  return stats;
}

Stats Passes::run_shares() {
  const AdaptiveState& state = render_.adaptive;
  const PixelRect area = world_.settings.crop;
  const Tiles tiles(area, kAdaptiveTile);
  Stats stats;
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<int> ends(area.pixels());
    std::uint32_t last = state.judged;
    for (std::size_t i = 0; i < state.tiles.size(); ++i) {
      const std::uint32_t end = state.tiles[i].ends[half];
      const PixelRect tile = tiles.at(static_cast<std::int64_t>(i));
      last = std::max(last, end);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) ends[area.index(x, y)] = static_cast<int>(end);
      }
    }
    stats.merge(run_pass(half, pass_of(half), {state.judged, last}, SampleLimits(area, std::move(ends))));
  }
  return stats;
}

// Treats `besides` as done, in addition to the samples in the film.
Stats Passes::run_pass(std::size_t stage, const Pass& pass, SampleRange samples, const SampleLimits& limits,
                       const Coverage& besides) {
  const Settings& settings = world_.settings;
  const PixelRect crop = settings.crop;
  const int side = tile_side(crop.width(), crop.height(), settings.tile, settings.threads);
  Coverage done = besides;
  picture_.change([&] { done.add(render_.covered[stage]); });  // look() may be tidying it
  done.tidy();
  // With a time limit the first round has one sample per pixel: a user who sets a limit wants an early image of all
  // pixels, however noisy.
  UnitQueue units(crop, side, rounds_of(samples, options_.time_limit ? 1 : kFirstRound), done);
  return run_threads({world_, pass, stage, limits, units, picture_}, settings.threads);
}

}  // namespace fathom::runtime
