#include "runtime/denoise/nl_means.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "runtime/base/tiles.h"
#include "runtime/denoise/nl_means_tile.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

constexpr float kAlike = 0.15f;  // difference of a feature that about halves a weight
constexpr int kVarianceRadius = 1, kErrorRadius = 4, kChoiceRadius = 2;

Plane box_mean(const Plane& plane, int width, int height, int radius) {
  const auto pass = [&](const Plane& from, int length, int lines, std::size_t step, std::size_t line_step) {
    Plane to(from.size());
    for (int line = 0; line < lines; ++line) {
      const std::size_t start = static_cast<std::size_t>(line) * line_step;
      for (int i = 0; i < length; ++i) {
        const int first = std::max(0, i - radius), last = std::min(length - 1, i + radius);
        float sum = 0;
        for (int j = first; j <= last; ++j) sum += from[start + static_cast<std::size_t>(j) * step];
        to[start + static_cast<std::size_t>(i) * step] = sum / static_cast<float>(last - first + 1);
      }
    }
    return to;
  };
  const auto row = static_cast<std::size_t>(width);
  return pass(pass(plane, width, height, 1, row), height, width, row, 1);
}

// Returns the smaller of the changes to the neighbours on both sides along an axis: the slope of the surface itself,
// even at its edge.
Plane slope(const Plane& plane, int width, int height, bool across) {
  const auto at = [&](int x, int y) {
    return plane[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
  };
  const int dx = across ? 1 : 0, dy = across ? 0 : 1;
  Plane result;
  result.reserve(plane.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float ahead = std::abs(at(x + dx, y + dy) - at(x, y)), behind = std::abs(at(x - dx, y - dy) - at(x, y));
      const bool first = across ? x == 0 : y == 0, last = across ? x == width - 1 : y == height - 1;
      result.push_back(first ? ahead : last ? behind : std::min(ahead, behind));
    }
  }
  return result;
}

// Weight of squared differences in three features. A pixel on the edge between two surfaces resembles no other pixel:
// its slopes are steep on both sides, and its neighbours may differ by that slope (RMZ 2013, equation 5; there by the
// gradient, which is steep next to the edge, too).
Plane sharpness_of(const NlMeansInput& input, std::size_t first) {
  Plane squares(input.valid.size(), kAlike * kAlike);
  for (std::size_t i = first; i < first + 3; ++i) {
    for (const bool across : {true, false}) {
      const Plane change = slope(input.features[i], input.width, input.height, across);
      for (std::size_t at = 0; at < squares.size(); ++at) squares[at] += change[at] * change[at];
    }
  }
  for (float& value : squares) value = 1 / value;
  return squares;
}

// Estimates the noise: half the squared difference of the copies is the variance of one copy, in the mean. Squares
// beyond float's range count as the largest value whose sums are still finite.
Plane noise_of(const NlMeansInput& input) {
  Plane noise(input.valid.size(), 0);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float difference = input.copies[0][c][i] - input.copies[1][c][i];
      noise[i] += std::min(0.5f * difference * difference, 1e37f);
    }
  }
  return noise;
}

NlMeansPlanes frame(const NlMeansInput& input) {
  NlMeansPlanes framing{input.width, input.height, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  const auto framed = [&](const Plane& plane) { return PaddedPlane(plane, input.width, input.height); };
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t c = 0; c < 3; ++c) framing.copies[half][c] = framed(input.copies[half][c]);
  }
  for (std::size_t i = 0; i < input.features.size(); ++i) framing.features[i] = framed(input.features[i]);
  for (std::size_t i = 0; i < 2; ++i) framing.sharpness[i] = framed(sharpness_of(input, 3 * i));
  framing.depth = framed(input.depth);
  framing.slope_x = framed(slope(input.depth, input.width, input.height, true));
  framing.slope_y = framed(slope(input.depth, input.width, input.height, false));
  framing.valid = framed(input.valid);
  const Plane noise = noise_of(input);
  framing.noise = framed(noise);
  framing.variance = framed(box_mean(noise, input.width, input.height, kVarianceRadius));
  return framing;
}

NlMeansFiltered filter(const NlMeansPlanes& framing, int threads, const std::function<bool()>& is_cancelled) {
  NlMeansFiltered filtered;
  const std::size_t pixels = static_cast<std::size_t>(framing.width) * static_cast<std::size_t>(framing.height);
  for (auto& colors : filtered.colors) colors.fill(Plane(pixels));
  filtered.errors.fill(Plane(pixels));
  const Tiles tiles({0, 0, framing.width, framing.height}, kTile);
  parallel_for(
      threads, static_cast<std::size_t>(tiles.count()), [] { return std::make_unique<TileBuffers>(); },
      [&](const std::unique_ptr<TileBuffers>& buffers, std::size_t i) {
        if (is_cancelled && is_cancelled()) return;
        filter_tile(framing, tiles.at(static_cast<std::int64_t>(i)), *buffers, filtered);
      });
  return filtered;
}

// Returns every pixel's share of every candidate: 1 for the candidate with the least error around the pixel, with
// soft seams.
std::array<Plane, kCandidates> choose(NlMeansFiltered& filtered, int width, int height) {
  for (Plane& error : filtered.errors) error = box_mean(error, width, height, kErrorRadius);
  std::array<Plane, kCandidates> shares;
  shares.fill(Plane(filtered.errors[0].size(), 0));
  for (std::size_t i = 0; i < shares[0].size(); ++i) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < kCandidates; ++k) {
      if (filtered.errors[k][i] < filtered.errors[best][i]) best = k;
    }
    shares[best][i] = 1;
  }
  for (Plane& share : shares) share = box_mean(share, width, height, kChoiceRadius);
  return shares;
}

}  // namespace

std::array<Plane, 3> nl_means(const NlMeansInput& input, int threads, const std::function<bool()>& is_cancelled) {
  const NlMeansPlanes framing = frame(input);
  NlMeansFiltered filtered = filter(framing, threads, is_cancelled);
  const std::array<Plane, kCandidates> shares = choose(filtered, input.width, input.height);
  std::array<Plane, 3> result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[c].resize(input.valid.size(), 0);
    for (std::size_t k = 0; k < kCandidates; ++k) {
      for (std::size_t i = 0; i < result[c].size(); ++i) result[c][i] += shares[k][i] * filtered.colors[k][c][i];
    }
  }
  return result;
}

}  // namespace fathom::runtime
