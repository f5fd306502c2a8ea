#include "runtime/nl_means.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "runtime/tiles.h"

namespace fathom::runtime {
namespace {

constexpr int kWindow = 8;  // pixels to each side that are averaged
constexpr int kPatch = 2;   // pixels to each side that are compared
constexpr int kMargin = kWindow + kPatch;
constexpr int kTile = 64;
constexpr int kGrown = kTile + 2 * kPatch;

// How much a difference of colour, in deviations of the noise, and one of the features count.
struct Candidate {
  float color, features;
};
constexpr float kColor = 1 / (0.5f * 0.5f);
constexpr std::size_t kCandidates = 3;
constexpr std::array<Candidate, kCandidates> kCandidate = {{{kColor, 1}, {0, 1}, {kColor, 0}}};

constexpr float kAlike = 0.15f;       // difference of a feature that halves a weight, about
constexpr float kDepthSlack = 0.01f;  // of the depth itself
constexpr int kVarianceRadius = 1, kErrorRadius = 4, kChoiceRadius = 2;

// Stands for e^-x: the same to a tenth where it matters, 0 beyond 8, and no more than multiplications.
inline float falloff(float x) {
  const float base = std::max(0.0f, 1 - x * 0.125f), square = base * base, fourth = square * square;
  return fourth * fourth;
}

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

// A plane with a margin, so that the inner loops need not ask where the picture ends; 0 there.
class Framed {
 public:
  Framed() = default;
  Framed(const Plane& plane, int width, int height) : stride_(width + 2 * kMargin) {
    values_.resize(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2 * kMargin));
    for (int y = 0; y < height; ++y) {
      std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(y) * width, width, row(y));
    }
  }
  float* row(int y) { return values_.data() + static_cast<std::ptrdiff_t>(y + kMargin) * stride_ + kMargin; }
  const float* row(int y) const {
    return values_.data() + static_cast<std::ptrdiff_t>(y + kMargin) * stride_ + kMargin;
  }

 private:
  std::ptrdiff_t stride_ = 0;
  std::vector<float> values_;
};

// What filtering reads.
struct Framing {
  int width, height;
  std::array<std::array<Framed, 3>, 2> copies;
  std::array<Framed, 6> features;
  std::array<Framed, 2> sharpness;  // what squared differences of the first and last three features count
  Framed depth, slope_x, slope_y, valid;
  Framed noise;     // variance of a copy as it looks, all channels together
  Framed variance;  // the same, smoothed
};

// What filtering makes: for each set of weights the picture and its error.
struct Filtered {
  std::array<std::array<Plane, 3>, kCandidates> colors;
  std::array<Plane, kCandidates> errors;
};

// The lesser change to the neighbours on both sides along an axis: that of the surface itself, at its edge, too.
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

// Pixels that show the edge between two surfaces in part are like none: their slopes are steep on both sides, and by
// so much their neighbours may differ (RMZ 2013, equation 5; there the gradient, which is steep beside the edge,
// too).
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

// The two copies differ by their noise: half the square of the difference is the variance of one, in the mean.
Plane noise_of(const NlMeansInput& input) {
  Plane noise(input.valid.size(), 0);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float difference = input.copies[0][c][i] - input.copies[1][c][i];
      noise[i] += 0.5f * difference * difference;
    }
  }
  return noise;
}

Framing frame(const NlMeansInput& input) {
  Framing framing{input.width, input.height, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  const auto framed = [&](const Plane& plane) { return Framed(plane, input.width, input.height); };
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

// The filter over one tile; buffers are kept from tile to tile.
class TileFilter {
 public:
  TileFilter(const Framing& framing, Filtered& filtered) : in_(framing), out_(filtered) {}

  void run(const PixelRect& tile) {
    tile_ = tile;
    for (Sums& sums : sums_) sums = {};
    for (int dy = -kWindow; dy <= kWindow; ++dy) {
      for (int dx = -kWindow; dx <= kWindow; ++dx) {
        compare_pixels(dx, dy);
        for (Grown& distance : distances_) average_patches(distance);
        for (int y = tile_.y0; y < tile_.y1; ++y) {
          compare_features(y, dx, dy);
          accumulate(y, dx, dy);
        }
      }
    }
    for (int y = tile_.y0; y < tile_.y1; ++y) finish(y);
  }

 private:
  using Row = std::array<float, kTile>;
  using Grown = std::array<std::array<float, kGrown>, kGrown>;
  // For one set of weights and one copy: of the copy's values by the other's weights.
  struct Sums {
    std::array<std::array<Row, kTile>, 4> rows{};  // red, green, blue, weight
  };
  Sums& sums(std::size_t candidate, std::size_t half) { return sums_[2 * candidate + half]; }

  // Squared differences at an offset less the noise's share, in variances (RKZ 2012, equation 2, channels together).
  void compare_pixels(int dx, int dy) {
    constexpr float kLeast = 1e-20f;
    const int width = tile_.x1 - tile_.x0 + 2 * kPatch;
    for (int y = tile_.y0 - kPatch; y < tile_.y1 + kPatch; ++y) {
      const int x0 = tile_.x0 - kPatch;
      const float *var_p = in_.variance.row(y) + x0, *var_q = in_.variance.row(y + dy) + x0 + dx;
      const float *valid_p = in_.valid.row(y) + x0, *valid_q = in_.valid.row(y + dy) + x0 + dx;
      for (std::size_t half = 0; half < 2; ++half) {
        const auto& copy = in_.copies[half];
        const float *r_p = copy[0].row(y) + x0, *r_q = copy[0].row(y + dy) + x0 + dx;
        const float *g_p = copy[1].row(y) + x0, *g_q = copy[1].row(y + dy) + x0 + dx;
        const float *b_p = copy[2].row(y) + x0, *b_q = copy[2].row(y + dy) + x0 + dx;
        float* __restrict out = distances_[half][static_cast<std::size_t>(y - tile_.y0 + kPatch)].data();
        for (int x = 0; x < width; ++x) {
          const float r = r_p[x] - r_q[x], g = g_p[x] - g_q[x], b = b_p[x] - b_q[x];
          const float both = var_p[x] + var_q[x];
          // A difference beyond float's range of squares is as good as the largest number.
          const float square = std::min(r * r + g * g + b * b, 1e38f);
          const float distance = (square - var_p[x] - std::min(var_p[x], var_q[x])) / (both + kLeast);
          out[x] = std::min(distance, 1e30f) * (valid_p[x] * valid_q[x]);
        }
      }
    }
  }

  // Into the element of the patch's corner.
  void average_patches(Grown& distance) {
    constexpr int kSide = 2 * kPatch + 1;
    const int width = tile_.x1 - tile_.x0, height = tile_.y1 - tile_.y0;
    for (int y = 0; y < height + 2 * kPatch; ++y) {
      float* row = distance[static_cast<std::size_t>(y)].data();
      for (int x = 0; x < width; ++x) row[x] = row[x] + row[x + 1] + row[x + 2] + row[x + 3] + row[x + 4];
    }
    static_assert(kSide == 5);
    for (int y = 0; y < height; ++y) {
      const auto at = static_cast<std::size_t>(y);
      float* row = distance[at].data();
      const float *b = distance[at + 1].data(), *c = distance[at + 2].data(), *d = distance[at + 3].data(),
                  *e = distance[at + 4].data();
      for (int x = 0; x < width; ++x) {
        row[x] = std::max(0.0f, row[x] + b[x] + c[x] + d[x] + e[x]) * (1.0f / (kSide * kSide));
      }
    }
  }

  // How unlike what is seen at both pixels is: features, and depth that leaves the pixel's slope.
  void compare_features(int y, int dx, int dy) {
    const int width = tile_.x1 - tile_.x0;
    unlikeness_ = {};
    float* __restrict out = unlikeness_.data();
    for (std::size_t i = 0; i < in_.features.size(); ++i) {
      const float *p = in_.features[i].row(y) + tile_.x0, *q = in_.features[i].row(y + dy) + tile_.x0 + dx;
      const float* sharpness = in_.sharpness[i / 3].row(y) + tile_.x0;
      for (int x = 0; x < width; ++x) out[x] += (p[x] - q[x]) * (p[x] - q[x]) * sharpness[x];
    }
    const float *p = in_.depth.row(y) + tile_.x0, *q = in_.depth.row(y + dy) + tile_.x0 + dx;
    const float *sx = in_.slope_x.row(y) + tile_.x0, *sy = in_.slope_y.row(y) + tile_.x0;
    const float ax = static_cast<float>(std::abs(dx)), ay = static_cast<float>(std::abs(dy));
    for (int x = 0; x < width; ++x) {
      const float expected = ax * sx[x] + ay * sy[x] + kDepthSlack * p[x] + 1e-12f;
      const float ratio = (p[x] - q[x]) / expected;
      out[x] += std::min(ratio * ratio, 1e3f);
    }
  }

  void accumulate(int y, int dx, int dy) {
    const auto at = static_cast<std::size_t>(y - tile_.y0);
    const int width = tile_.x1 - tile_.x0;
    const float *valid = in_.valid.row(y + dy) + tile_.x0 + dx, *unlikeness = unlikeness_.data();
    for (std::size_t half = 0; half < 2; ++half) {
      const float* distance = distances_[1 - half][at].data();
      const auto& copy = in_.copies[half];
      const float *r = copy[0].row(y + dy) + tile_.x0 + dx, *g = copy[1].row(y + dy) + tile_.x0 + dx,
                  *b = copy[2].row(y + dy) + tile_.x0 + dx;
      for (std::size_t k = 0; k < kCandidates; ++k) {
        auto& rows = sums(k, half).rows;
        float* __restrict sr = rows[0][at].data(), * __restrict sg = rows[1][at].data();
        float* __restrict sb = rows[2][at].data(), * __restrict sw = rows[3][at].data();
        const Candidate candidate = kCandidate[k];
        for (int x = 0; x < width; ++x) {
          const float weight = falloff(distance[x] * candidate.color + unlikeness[x] * candidate.features) * valid[x];
          sr[x] += weight * r[x];
          sg[x] += weight * g[x];
          sb[x] += weight * b[x];
          sw[x] += weight;
        }
      }
    }
  }

  // Means and their errors.
  void finish(int y) {
    for (int x = tile_.x0; x < tile_.x1; ++x) {
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(in_.width) + static_cast<std::size_t>(x);
      const float noise = in_.noise.row(y)[x];
      float light = 0;
      for (std::size_t k = 0; k < kCandidates; ++k) {
        float error = -noise, apart = 0, bright = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          float means[2];
          for (std::size_t half = 0; half < 2; ++half) {
            const auto& rows = sums(k, half).rows;
            const auto ty = static_cast<std::size_t>(y - tile_.y0), tx = static_cast<std::size_t>(x - tile_.x0);
            const float weight = rows[3][ty][tx], own = in_.copies[half][c].row(y)[x];
            means[half] = weight > 0 ? rows[c][ty][tx] / weight : own;
            error += 0.5f * (means[half] - own) * (means[half] - own);
            if (c == 0) error += weight > 0 ? noise / std::max(weight, 1.0f) : noise;
          }
          apart += (means[0] - means[1]) * (means[0] - means[1]);
          out_.colors[k][c][at] = (means[0] + means[1]) / 2;
          bright += means[0] * means[0] + means[1] * means[1];
        }
        if (k == 0) light = bright + noise + 1e-20f;
        // The mean of the two has the bias of each and half their variance, which is half the square of what is
        // between.
        out_.errors[k][at] = (error - apart / 4) / light;
      }
    }
  }

  const Framing& in_;
  Filtered& out_;
  PixelRect tile_;
  std::array<Grown, 2> distances_;  // by each copy's colours
  Row unlikeness_;
  std::array<Sums, 2 * kCandidates> sums_;
};

Filtered filter(const Framing& framing, int threads) {
  Filtered filtered;
  const std::size_t pixels = static_cast<std::size_t>(framing.width) * static_cast<std::size_t>(framing.height);
  for (auto& colors : filtered.colors) colors.fill(Plane(pixels));
  filtered.errors.fill(Plane(pixels));
  Tiles tiles({0, 0, framing.width, framing.height}, kTile);
  const auto work = [&] {
    const auto tile_filter = std::make_unique<TileFilter>(framing, filtered);
    while (const auto tile = tiles.take()) tile_filter->run(*tile);
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  return filtered;
}

// Every pixel's share of every candidate: the best one's by the errors around it, with soft seams.
std::array<Plane, kCandidates> choose(Filtered& filtered, int width, int height) {
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

std::array<Plane, 3> nl_means(const NlMeansInput& input, int threads) {
  const Framing framing = frame(input);
  Filtered filtered = filter(framing, threads);
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
