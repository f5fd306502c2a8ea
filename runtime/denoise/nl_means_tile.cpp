// The loops over rows, compiled once per instruction set and chosen at run time (Highway's foreach_target). The loops
// process whole registers, even beyond a tile's last column: rows are longer, and nothing reads the rest.
#include "runtime/denoise/nl_means_tile.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/denoise/nl_means_tile.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<Lanes>;

HWY_INLINE V k(float value) { return hn::Set(Lanes(), value); }
HWY_INLINE V load(const float* from) { return hn::LoadU(Lanes(), from); }
HWY_INLINE void store(V value, float* to) { hn::StoreU(value, Lanes(), to); }
HWY_INLINE void add_to(float* sum, V value) { store(hn::Add(load(sum), value), sum); }
HWY_INLINE V square(V v) { return hn::Mul(v, v); }

// Calls move(x) for the first lane of each register of `width` columns.
template <class Move>
HWY_INLINE void for_columns(int width, const Move& move) {
  for (int x = 0; x < width; x += static_cast<int>(hn::Lanes(Lanes()))) move(x);
}

// Weight of a colour difference, in standard deviations of the noise, relative to that of a feature.
constexpr float kColor = 1 / (0.5f * 0.5f);
constexpr float kDepthSlack = 0.01f;  // relative to the depth
constexpr float kEighth = 0.125f;

// Approximates e^-8x by multiplications: within a tenth where the value matters, 0 beyond 1.
HWY_INLINE V falloff(V x) { return square(square(square(hn::Max(hn::Sub(k(1), x), hn::Zero(Lanes()))))); }

// Maximum weight of a neighbour at this distance, so that the window has no hard edge. (The kernel with the least
// error for its width, Epanechnikov, "Non-Parametric Estimation of a Multivariate Probability Density", 1969.)
float fade(int dx, int dy) {
  const float apart = static_cast<float>(dx * dx + dy * dy);
  return std::max(0.0f, 1 - apart / ((kWindow + 1) * (kWindow + 1)));
}

class TileFilter {
 public:
  TileFilter(const NlMeansPlanes& frame, const PixelRect& tile, TileBuffers& buffers, NlMeansFiltered& filtered)
      : in_(frame), tile_(tile), width_(tile.x1 - tile.x0), buffers_(buffers), out_(filtered) {}

  void run() {
    buffers_.sums = {};
    for (int dy = -kWindow; dy <= kWindow; ++dy) {
      for (int dx = -kWindow; dx <= kWindow; ++dx) {
        if (fade(dx, dy) > 0) add_neighbours(dx, dy);
      }
    }
    for (int y = tile_.y0; y < tile_.y1; ++y) finish(y);
  }

 private:
  std::size_t row_of(int y) const { return static_cast<std::size_t>(y - tile_.y0); }

  void add_neighbours(int dx, int dy) {
    compare_pixels(dx, dy);
    for (TileBuffers::PaddedTile& distance : buffers_.distances) average_patches(distance);
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      compare_features(y, dx, dy);
      compute_weights(y, dx, dy);
      for (std::size_t half = 0; half < 2; ++half) accumulate(y, dx, dy, half);
    }
  }

  // Computes squared differences at an offset less the noise's share, in variances (RKZ 2012, equation 2, all
  // channels).
  void compare_pixels(int dx, int dy) {
    for (int y = tile_.y0 - kPatch; y < tile_.y1 + kPatch; ++y) {
      const int p = tile_.x0 - kPatch, q = p + dx;
      const float *var_p = in_.variance.row(y) + p, *var_q = in_.variance.row(y + dy) + q;
      const float *valid_p = in_.valid.row(y) + p, *valid_q = in_.valid.row(y + dy) + q;
      for_columns(width_ + 2 * kPatch, [&](int x) HWY_ATTR {
        const V here = load(var_p + x), there = load(var_q + x);
        const V noise = hn::Add(here, hn::Min(here, there));
        const V scale =
            hn::Div(hn::Mul(load(valid_p + x), load(valid_q + x)), hn::Add(hn::Add(here, there), k(1e-20f)));
        for (std::size_t half = 0; half < 2; ++half) {
          V sum = hn::Zero(Lanes());
          for (const PaddedPlane& channel : in_.copies[half]) {
            sum = hn::Add(sum, square(hn::Sub(load(channel.row(y) + p + x), load(channel.row(y + dy) + q + x))));
          }
          // A square beyond float's range counts as the largest number.
          const V distance = hn::Mul(hn::Sub(hn::Min(sum, k(1e38f)), noise), scale);
          store(hn::Min(distance, k(1e30f)), buffers_.distances[half][row_of(y + kPatch)].data() + x);
        }
      });
    }
  }

  // Averages each patch into the element of its corner, times the weight of colour.
  void average_patches(TileBuffers::PaddedTile& distance) const {
    constexpr int kSide = 2 * kPatch + 1;
    const std::size_t height = row_of(tile_.y1);
    for (std::size_t y = 0; y < height + 2 * kPatch; ++y) {
      float* row = distance[y].data();
      for_columns(width_, [&](int x) HWY_ATTR {
        V sum = load(row + x);
        for (int i = 1; i < kSide; ++i) sum = hn::Add(sum, load(row + x + i));
        store(sum, row + x);
      });
    }
    for (std::size_t y = 0; y < height; ++y) {
      for_columns(width_, [&](int x) HWY_ATTR {
        V sum = load(distance[y].data() + x);
        for (std::size_t i = 1; i < kSide; ++i) sum = hn::Add(sum, load(distance[y + i].data() + x));
        store(hn::Mul(hn::Max(sum, hn::Zero(Lanes())), k(kColor * kEighth / (kSide * kSide))),
              distance[y].data() + x);
      });
    }
  }

  // Computes how unlike the features of both pixels are, and how far the depth leaves the pixel's slope.
  void compare_features(int y, int dx, int dy) {
    const int p = tile_.x0, q = p + dx;
    const float *depth_p = in_.depth.row(y) + p, *depth_q = in_.depth.row(y + dy) + q;
    const float *slope_x = in_.slope_x.row(y) + p, *slope_y = in_.slope_y.row(y) + p;
    const V ax = k(static_cast<float>(std::abs(dx))), ay = k(static_cast<float>(std::abs(dy)));
    for_columns(width_, [&](int x) HWY_ATTR {
      const V here = load(depth_p + x);
      const V slopes = hn::Add(hn::Mul(ax, load(slope_x + x)), hn::Mul(ay, load(slope_y + x)));
      const V expected = hn::Add(hn::Add(slopes, hn::Mul(k(kDepthSlack), here)), k(1e-12f));
      V sum = hn::Min(square(hn::Div(hn::Sub(here, load(depth_q + x)), expected)), k(1e3f));
      for (std::size_t group = 0; group < 2; ++group) {
        V squares = hn::Zero(Lanes());
        for (std::size_t i = 3 * group; i < 3 * group + 3; ++i) {
          const PaddedPlane& feature = in_.features[i];
          squares =
              hn::Add(squares, square(hn::Sub(load(feature.row(y) + p + x), load(feature.row(y + dy) + q + x))));
        }
        sum = hn::Add(sum, hn::Mul(squares, load(in_.sharpness[group].row(y) + p + x)));
      }
      store(hn::Mul(sum, k(kEighth)), buffers_.dissimilarity.data() + x);
    });
  }

  // Computes each neighbour's weights: the factor that all sets share, and the weight by features alone, which both
  // copies share.
  void compute_weights(int y, int dx, int dy) {
    const float* valid = in_.valid.row(y + dy) + tile_.x0 + dx;
    const V faded = k(fade(dx, dy));
    for_columns(width_, [&](int x) HWY_ATTR {
      const V share = hn::Mul(load(valid + x), faded);
      store(share, buffers_.share.data() + x);
      store(hn::Mul(falloff(load(buffers_.dissimilarity.data() + x)), share), buffers_.similarity.data() + x);
    });
  }

  void accumulate(int y, int dx, int dy, std::size_t half) {
    const std::size_t at = row_of(y);
    const float *distances = buffers_.distances[1 - half][at].data(), *dissimilarity = buffers_.dissimilarity.data();
    const float *shares = buffers_.share.data(), *similarity = buffers_.similarity.data();
    std::array<const float*, 3> colors;
    for (std::size_t c = 0; c < 3; ++c) colors[c] = in_.copies[half][c].row(y + dy) + tile_.x0 + dx;
    auto& by_both = buffers_.sums[0][half][at];
    auto& by_features = buffers_.sums[1][half][at];
    auto& by_color = buffers_.sums[2][half][at];
    for_columns(width_, [&](int x) HWY_ATTR {
      const V distance = load(distances + x), share = load(shares + x);
      const V both = hn::Mul(falloff(hn::Add(distance, load(dissimilarity + x))), share);
      const V color = hn::Mul(falloff(distance), share), features = load(similarity + x);
      for (std::size_t c = 0; c < 3; ++c) {
        const V value = load(colors[c] + x);
        add_to(by_both[c].data() + x, hn::Mul(both, value));
        add_to(by_features[c].data() + x, hn::Mul(features, value));
        add_to(by_color[c].data() + x, hn::Mul(color, value));
      }
      add_to(by_both[3].data() + x, both);
      add_to(by_features[3].data() + x, features);
      add_to(by_color[3].data() + x, color);
    });
  }

  // Computes the means and their errors.
  void finish(int y) {
    const std::size_t ty = row_of(y);
    for (int x = tile_.x0; x < tile_.x1; ++x) {
      const auto tx = static_cast<std::size_t>(x - tile_.x0);
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(in_.width) + static_cast<std::size_t>(x);
      const float noise = in_.noise.row(y)[x];
      float light = 0;
      for (std::size_t k = 0; k < kCandidates; ++k) {
        float error = -noise, apart = 0, bright = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          float means[2];
          for (std::size_t half = 0; half < 2; ++half) {
            const auto& sums = buffers_.sums[k][half][ty];
            const float weight = sums[3][tx], own = in_.copies[half][c].row(y)[x];
            means[half] = weight > 0 ? sums[c][tx] / weight : own;
            error += 0.5f * (means[half] - own) * (means[half] - own);
            if (c == 0) error += weight > 0 ? noise / std::max(weight, 1.0f) : noise;
          }
          apart += (means[0] - means[1]) * (means[0] - means[1]);
          out_.colors[k][c][at] = (means[0] + means[1]) / 2;
          bright += means[0] * means[0] + means[1] * means[1];
        }
        if (k == 0) light = bright + noise + 1e-20f;
        // The mean of the two copies has the bias of each and half the variance. A copy's variance is half the square
        // of the difference between the copies.
        out_.errors[k][at] = (error - apart / 4) / light;
      }
    }
  }

  const NlMeansPlanes& in_;
  PixelRect tile_;
  int width_;
  TileBuffers& buffers_;
  NlMeansFiltered& out_;
};

void filter_one(const NlMeansPlanes& in, const PixelRect& tile, TileBuffers& buffers, NlMeansFiltered& out) {
  TileFilter(in, tile, buffers, out).run();
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(filter_one);

void filter_tile(const NlMeansPlanes& in, const PixelRect& tile, TileBuffers& buffers, NlMeansFiltered& out) {
  HWY_DYNAMIC_DISPATCH(filter_one)(in, tile, buffers, out);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
