#include "runtime/passes.h"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/base/tiles.h"
#include "runtime/film/adaptive.h"
#include "runtime/film/noise.h"

namespace fathom::runtime {
namespace {

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

// That the open tiles may take at most.
std::uint64_t samples_left(const NoiseState& state, const Settings& settings) {
  const Tiles tiles(settings.crop, kNoiseTile);
  std::uint64_t pixels = 0;
  for (std::size_t i = 0; i < state.tiles.size(); ++i) {
    if (state.tiles[i].open()) pixels += tiles.at(static_cast<std::int64_t>(i)).pixels();
  }
  return pixels * 2 * (static_cast<std::uint64_t>(settings.spp / 2) - state.judged);
}

}  // namespace

Stats Passes::run(SampleRange samples) {
  const Settings& settings = world_.settings;
  if (settings.noise) return run_noise();
  if (settings.adaptive) return run_adaptive();
  return run_pass(0, {{settings.sampler, settings.seed, settings.spp}}, samples, {});
}

RenderEnd Passes::end() const {
  const auto& tiles = render_.noise.tiles;
  const bool quiet =
      !tiles.empty() && std::none_of(tiles.begin(), tiles.end(), [](auto tile) { return tile.open(); });
  return picture_.end() == RenderEnd::Done && quiet ? RenderEnd::Noise : picture_.end();
}

// In two stages, of which the first says where the second is to look.
Stats Passes::run_adaptive() {
  const Settings& settings = world_.settings;
  const int first = first_samples(settings.spp);
  Stats stats = run_pass(0, {{settings.sampler, settings.seed, first}}, {0, static_cast<std::uint32_t>(first)}, {});
  if (picture_.stopped()) return stats;
  stats.merge(run_second_stage(first));
  return stats;
}

Stats Passes::run_second_stage(int first) {
  const Settings& settings = world_.settings;
  const PixelRect area = render_.film.area();
  std::vector<int> more = second_samples(estimates_of(render_.film), area.width(), area.height(), settings.spp);
  const auto most = static_cast<std::uint32_t>(*std::max_element(more.begin(), more.end()));
  if (render_.film.stages() == 1) {
    picture_.change([&] {
      render_.film.begin_second_stage(first_share(settings.spp));
      render_.covered.resize(2);
    });
  }
  const Pass second{{settings.sampler, second_seed(settings.seed), settings.spp - first},
                    static_cast<std::uint32_t>(first)};
  return run_pass(1, second, {0, most}, SampleLimits(area, std::move(more)));
}

// In rounds, each of which says where the next is to look.
Stats Passes::run_noise() {
  const Settings& settings = world_.settings;
  NoiseState& state = render_.noise;
  if (render_.film.stages() == 1) {
    picture_.change([&] {
      render_.film.begin_halves();
      render_.covered.resize(kNoiseStages);
      state.tiles.resize(static_cast<std::size_t>(Tiles(settings.crop, kNoiseTile).count()));
    });
  }
  Stats stats;
  std::size_t open = state.tiles.size();
  if (end() == RenderEnd::Noise) return stats;
  while (open > 0) {
    const std::uint32_t end = next_end(state.judged, settings.min_spp, settings.spp);
    if (end == 0) break;
    stats.merge(run_halves(end));
    if (picture_.stopped()) break;
    picture_.change([&] {
      open = judge(render_.film, end, *settings.noise, state);
      picture_.expect(samples_left(state, settings));
    });
  }
  return stats;
}

// Both halves of all open tiles, from the last judgement up to `end`.
Stats Passes::run_halves(std::uint32_t end) {
  const Settings& settings = world_.settings;
  const std::vector<NoiseTile> decided = render_.noise.tiles;
  const SampleRange round{render_.noise.judged, end};
  const Tiles tiles(settings.crop, kNoiseTile);
  const int each = settings.spp / 2;
  Stats stats;
  for (std::size_t stage = 0; stage < kNoiseStages; ++stage) {
    const std::size_t half = stage % 2;
    Coverage others;
    bool some = false;
    for (std::size_t i = 0; i < decided.size(); ++i) {
      const std::size_t wanted = decided[i].ends[half] == 0 ? half : half + 2;
      if (decided[i].open() && stage == wanted) {
        some = true;
      } else {
        others.add({tiles.at(static_cast<std::int64_t>(i)), round});
      }
    }
    if (!some) continue;
    const std::uint64_t seed = half == 0 ? settings.seed : second_seed(settings.seed);
    const Pass pass{{settings.sampler, seed, each}, static_cast<std::uint32_t>(half == 0 ? 0 : each)};
    stats.merge(run_pass(stage, pass, round, {}, others));
  }
  return stats;
}

// `besides` counts as done already.
Stats Passes::run_pass(std::size_t stage, const Pass& pass, SampleRange samples, const SampleLimits& limits,
                       const Coverage& besides) {
  const Settings& settings = world_.settings;
  const PixelRect crop = settings.crop;
  const int side = tile_side(crop.width(), crop.height(), settings.tile, settings.threads);
  Coverage done = besides;
  picture_.change([&] { done.add(render_.covered[stage]); });  // who looks may be tidying it
  done.tidy();
  // Who sets a limit wants a whole picture early, whatever it is worth.
  UnitQueue units(crop, side, rounds_of(samples, options_.time_limit ? 1 : kFirstRound), done);
  return run_threads({world_, pass, stage, limits, units, picture_}, settings.threads);
}

}  // namespace fathom::runtime
