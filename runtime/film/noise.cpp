#include "runtime/film/noise.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>

#include "runtime/base/color.h"
#include "runtime/base/tiles.h"
#include "runtime/film/film.h"

namespace fathom::runtime {
namespace {}  // namespace

std::uint32_t next_end(std::uint32_t judged, int least, int most) {
  const auto first = static_cast<std::uint32_t>((std::max(kLeastNoiseSpp, least) + 1) / 2);
  const auto last = static_cast<std::uint32_t>(most / 2);
  if (judged >= last) return 0;
  return std::min(last, judged == 0 ? first : 2 * judged);
}

double noise_of(const Film& film, PixelRect tile, std::initializer_list<std::size_t> stages) {
  double sum = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const RadianceMeans pixel = film.radiance_of(stages, x, y);
      const auto deviation = static_cast<double>(luminance(glm::vec3(glm::sqrt(pixel.variance))));
      const auto brightness = static_cast<double>(luminance(glm::vec3(pixel.radiance)));
      sum += deviation * deviation / (2 * (std::max(brightness, 0.0) + kDark));
    }
  }
  return std::sqrt(sum / static_cast<double>(tile.pixels()));
}

std::size_t judge(const Film& film, std::uint32_t end, double limit, NoiseState& state) {
  const Tiles tiles(film.area(), kNoiseTile);
  std::size_t open = 0;
  for (std::size_t i = 0; i < state.tiles.size(); ++i) {
    NoiseTile& tile = state.tiles[i];
    if (!tile.open()) continue;
    const PixelRect pixels = tiles.at(static_cast<std::int64_t>(i));
    if (tile.ends[1] == 0 && noise_of(film, pixels, {0, 2}) <= limit) tile.ends[1] = end;
    if (tile.ends[0] == 0 && noise_of(film, pixels, {1, 3}) <= limit) tile.ends[0] = end;
    open += tile.open();
  }
  state.judged = end;
  return open;
}

}  // namespace fathom::runtime
