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

// Returns the limits of a pass: end(tile, half) of the pixels of that half of the tile.
template <class End>
SampleLimits limits_of(const AdaptiveState& state, PixelRect area, const End& end) {
  const Tiles tiles(area, kAdaptiveTile);
  std::vector<std::uint32_t> ends(area.pixels());
  for (std::size_t i = 0; i < state.tiles.size(); ++i) {
    const std::uint32_t of_half[2] = {end(state.tiles[i], 0), end(state.tiles[i], 1)};
    const PixelRect tile = tiles.at(static_cast<std::int64_t>(i));
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) ends[area.index(x, y)] = of_half[half_of(x, y)];
    }
  }
  return {area, std::move(ends)};
}

}  // namespace

Stats Passes::run(SampleRange samples) {
  const Settings& settings = context_.settings;
  if (settings.noise_threshold) return run_adaptive();
  return run_pass(0, samples, {});
}

RenderEnd Passes::end() const {
  if (shared_film_.end() != RenderEnd::Done || context_.settings.noise_threshold.value_or(0) <= 0)
    return shared_film_.end();
  const Tiles tiles(context_.settings.crop, kAdaptiveTile);
  for (std::int64_t i = 0; i < tiles.count(); ++i) {
    if (image_noise(render_.film, tiles.at(i)) > *context_.settings.noise_threshold) return RenderEnd::Done;
  }
  return RenderEnd::Noise;
}

Stats Passes::run_adaptive() {
  const Settings& settings = context_.settings;
  const double threshold = *settings.noise_threshold;
  AdaptiveState& state = render_.adaptive;
  if (!state.used()) {
    shared_film_.modify([&] {
      if (adaptive_stages(threshold) > 1) render_.film.add_stage();
      render_.covered.resize(render_.film.stages());
      state.tiles.resize(static_cast<std::size_t>(Tiles(settings.crop, kAdaptiveTile).count()));
    });
  }
  Stats stats;
  for (std::uint32_t end; (end = next_round(state.tested_spp, settings.spp, threshold)) != 0;) {
    stats.merge(run_round(end));
    if (shared_film_.should_stop()) return stats;
    shared_film_.modify([&] { test_convergence(render_.film, end, threshold, state); });
  }
  const bool decided = std::ranges::none_of(state.tiles, &AdaptiveTile::open);
  shared_film_.modify([&] {
    if (!decided) allocate_samples(render_.film, settings.spp, threshold, state);
  });
  stats.merge(run_allocation());
  return stats;
}

Stats Passes::run_round(std::uint32_t end) {
  const AdaptiveState& state = render_.adaptive;
  const PixelRect area = context_.settings.crop;
  const SampleRange round{state.tested_spp, end};
  const Tiles tiles(area, kAdaptiveTile);
  Stats stats;
  for (std::size_t stage = 0; stage < render_.film.stages(); ++stage) {
    // Pixels whose number of samples is decided go on in stage 1.
    const auto takes_part = [&](const AdaptiveTile& tile, std::size_t half) {
      return tile.open() && (tile.ends[half] == 0) == (stage == 0);
    };
    Coverage others;
    for (std::size_t i = 0; i < state.tiles.size(); ++i) {
      const AdaptiveTile& tile = state.tiles[i];
      if (!takes_part(tile, 0) && !takes_part(tile, 1)) others.add({tiles.at(static_cast<std::int64_t>(i)), round});
    }
    if (others.blocks().size() == state.tiles.size()) continue;
    const auto limit = [&](const AdaptiveTile& tile, std::size_t half) { return takes_part(tile, half) ? end : 0; };
    stats.merge(run_pass(stage, round, limits_of(state, area, limit), others));
  }
  return stats;
}

Stats Passes::run_allocation() {
  const AdaptiveState& state = render_.adaptive;
  std::uint32_t last = state.tested_spp;
  for (const AdaptiveTile& tile : state.tiles) last = std::max({last, tile.ends[0], tile.ends[1]});
  const SampleLimits limits = limits_of(state, context_.settings.crop,
                                        [](const AdaptiveTile& tile, std::size_t half) { return tile.ends[half]; });
  shared_film_.modify([&] { shared_film_.set_remaining(limits.sum() - render_.film.samples()); });
  return run_pass(0, {state.tested_spp, last}, limits);
}

// Treats `besides` as done, in addition to the samples in the film.
Stats Passes::run_pass(std::size_t stage, SampleRange samples, const SampleLimits& limits,
                       const Coverage& already_covered) {
  const Settings& settings = context_.settings;
  const PixelRect crop = settings.crop;
  const int side = tile_side(crop.width(), crop.height(), settings.tile, settings.threads);
  Coverage done = already_covered;
  shared_film_.modify([&] { done.add(render_.covered[stage]); });  // read() may be canonicalising it
  done.canonicalise();
  // With a time limit the first round has one sample per pixel: a user who sets a limit wants an early image of all
  // pixels, however noisy.
  UnitQueue units(crop, side, split_into_rounds(samples, options_.time_limit ? 1 : kFirstRound), done);
  return run_threads({context_, stage, limits, units, shared_film_}, settings.threads);
}

}  // namespace fathom::runtime
