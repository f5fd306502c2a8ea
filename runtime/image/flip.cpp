#include "runtime/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>

#include "vm/number/real.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

using Plane = std::vector<float>;  // [y][x]
using Planes = std::array<Plane, 3>;

// The constants of the paper: section 4.1.3 (colour), 4.2 (features), 4.3 (both).
constexpr float kColorExponent = 0.7f, kNear = 0.4f, kNearShare = 0.95f;  // q_c, p_c, p_t
constexpr float kFeatureExponent = 0.5f, kFeatureWidth = 0.082f;          // q_f; w, degrees

float power_of(float x, float y) {
  return static_cast<float>(vm::real::pow(static_cast<double>(x), static_cast<double>(y)));
}

// Matrices of sRGB's primaries and D65, as fractions of whole numbers (IEC 61966-2-1:1999).
constexpr float kXyz[3][3] = {{0.412386563f, 0.357591491f, 0.180450491f},
                              {0.212636822f, 0.715182982f, 0.072180196f},
                              {0.019330620f, 0.119197164f, 0.950372587f}};
constexpr float kRgb[3][3] = {{3.241003233f, -1.537398969f, -0.498615882f},
                              {-0.969224252f, 1.875929984f, 0.041554226f},
                              {0.055639420f, -0.204011206f, 1.057148977f}};

glm::vec3 times(const float (&m)[3][3], glm::vec3 v) {
  glm::vec3 product;
  for (int i = 0; i < 3; ++i) product[i] = m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z;
  return product;
}

// Returns XYZ relative to that of white.
glm::vec3 to_xyz(glm::vec3 rgb) {
  static const glm::vec3 white = times(kXyz, glm::vec3(1));
  return times(kXyz, rgb) / white;
}
glm::vec3 from_xyz(glm::vec3 xyz) {
  static const glm::vec3 white = times(kXyz, glm::vec3(1));
  return times(kRgb, xyz * white);
}

// Returns lightness, red-green, blue-yellow: L*a*b* without its roots.
glm::vec3 to_opponent(glm::vec3 rgb) {
  const glm::vec3 v = to_xyz(rgb);
  return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}
glm::vec3 from_opponent(glm::vec3 c) {
  const float y = (c.x + 16) / 116;
  return from_xyz({y + c.y / 500, y, y - c.z / 200});
}

// CIE 15:2004.
float lab_root(float t) {
  constexpr float kDelta = 6 / 29.0f;
  return t > kDelta * kDelta * kDelta ? power_of(t, 1 / 3.0f) : t / (3 * kDelta * kDelta) + 4 / 29.0f;
}

// Returns L*a*b* in which dim colours are less saturated, as the eye sees them: the Hunt effect.
glm::vec3 to_hunt_lab(glm::vec3 rgb) {
  const glm::vec3 v = to_xyz(rgb);
  const float x = lab_root(v.x), y = lab_root(v.y), z = lab_root(v.z);
  const float lightness = 116 * y - 16, share = 0.01f * lightness;
  return {lightness, share * 500 * (x - y), share * 200 * (y - z)};
}

// HyAB: Abasi, Tehran, Fairchild, "Distance metrics for very large color differences", 2020.
float distance(glm::vec3 a, glm::vec3 b) {
  const glm::vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// Returns the colour difference in [0,1]. Most of the range is for the differences that most images have.
float color_error(glm::vec3 a, glm::vec3 b) {
  static const float most = power_of(distance(to_hunt_lab({0, 1, 0}), to_hunt_lab({0, 0, 1})), kColorExponent);
  const float error = power_of(distance(to_hunt_lab(a), to_hunt_lab(b)), kColorExponent), near = kNear * most;
  if (error < near) return kNearShare / near * error;
  return kNearShare + (error - near) / (most - near) * (1 - kNearShare);
}

// A one-dimensional kernel. Its centre is the middle element.
using Kernel = std::vector<float>;

Kernel gaussian(float per_square, int radius) {  // e^(-x^2 per_square)
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) {
    const float power = -static_cast<float>(x * x) * per_square;
    kernel.push_back(static_cast<float>(vm::real::exp(static_cast<double>(power))));
  }
  return kernel;
}

float sum(const Kernel& kernel) {
  float total = 0;
  for (const float value : kernel) total += value;
  return total;
}

// Scales positive elements to the sum 1, negative ones to -1.
void normalise(Kernel& kernel) {
  float positive = 0, negative = 0;
  for (const float value : kernel) (value > 0 ? positive : negative) += std::abs(value);
  for (float& value : kernel) value /= value > 0 ? positive : negative > 0 ? negative : 1;
}

// Convolves along rows and then columns. Pixels beyond the border repeat the border's.
Plane convolve(const Plane& plane, int width, int height, const Kernel& across, const Kernel& down) {
  const int radius = static_cast<int>(across.size()) / 2;
  const auto at = [width](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  Plane rows(plane.size()), result(plane.size(), 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float total = 0;
      for (int i = -radius; i <= radius; ++i) {
        total += across[static_cast<std::size_t>(i + radius)] * plane[at(std::clamp(x + i, 0, width - 1), y)];
      }
      rows[at(x, y)] = total;
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int i = -radius; i <= radius; ++i) {
      const float weight = down[static_cast<std::size_t>(i + radius)];
      const int from = std::clamp(y + i, 0, height - 1);
      for (int x = 0; x < width; ++x) result[at(x, y)] += weight * rows[at(x, from)];
    }
  }
  return result;
}

// The eye's contrast sensitivity in a channel: a sum of Gaussians a sqrt(pi/b) e^(-pi^2 x^2 / b), x in degrees (table
// 1).
struct Sensitivity {
  float a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivities[3] = {
    {1, 0.0047f, 0, 1e-5f}, {1, 0.0053f, 0, 1e-5f}, {34.1f, 0.04f, 13.5f, 0.025f}};
constexpr float kPiF = std::numbers::pi_v<float>;

// Filters a channel by the eye's contrast sensitivity. The two-dimensional kernel sums to 1 as a whole.
void apply_contrast_sensitivity(Plane& plane, int width, int height, const Sensitivity& s, float pixels_per_degree) {
  constexpr float kWidest = 0.04f;  // b
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPiF * kPiF)) * pixels_per_degree));
  const auto kernel_of = [&](float b) {
    return gaussian(kPiF * kPiF / (b * pixels_per_degree * pixels_per_degree), radius);
  };
  const Kernel first = kernel_of(s.b1), second = kernel_of(s.b2);
  const float first_scale = s.a1 * std::sqrt(kPiF / s.b1), second_scale = s.a2 * std::sqrt(kPiF / s.b2);
  const float first_sum = sum(first), second_sum = sum(second);
  const float total = first_scale * first_sum * first_sum + second_scale * second_sum * second_sum;
  const Plane a = convolve(plane, width, height, first, first);
  const Plane b = s.a2 > 0 ? convolve(plane, width, height, second, second) : Plane(plane.size(), 0);
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = (first_scale * a[i] + second_scale * b[i]) / total;
}

// Perceived content of one of the two images.
struct PerceivedImage {
  Planes opponent;      // as on the screen, then filtered
  Plane edges, points;  // strength of the features
};

Plane magnitude(const Plane& x, const Plane& y) {
  Plane result(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) result[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
  return result;
}

// Finds edges where the first derivative of the lightness is large, and points where the second is (section 4.2).
void find_features(PerceivedImage& perceived, int width, int height, float pixels_per_degree) {
  const float deviation = 0.5f * kFeatureWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  Kernel smooth = gaussian(1 / (2 * deviation * deviation), radius), edge = smooth, point = smooth;
  for (int x = -radius; x <= radius; ++x) {
    const auto i = static_cast<std::size_t>(x + radius);
    edge[i] *= static_cast<float>(-x);
    point[i] *= static_cast<float>(x * x) / (deviation * deviation) - 1;
  }
  normalise(smooth);
  normalise(edge);
  normalise(point);
  Plane light = perceived.opponent[0];
  for (float& value : light) value = (value + 16) / 116;
  perceived.edges =
      magnitude(convolve(light, width, height, edge, smooth), convolve(light, width, height, smooth, edge));
  perceived.points =
      magnitude(convolve(light, width, height, point, smooth), convolve(light, width, height, smooth, point));
}

PerceivedImage perceive(RgbView image, float pixels_per_degree) {
  PerceivedImage perceived;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    glm::vec3 rgb;
    for (int c = 0; c < 3; ++c) {
      const float value = image.rgb[i + static_cast<std::size_t>(c)];
      rgb[c] = value > 0 ? std::min(value, 1.0f) : 0;
    }
    const glm::vec3 opponent = to_opponent(rgb);
    for (std::size_t c = 0; c < 3; ++c) perceived.opponent[c].push_back(opponent[static_cast<int>(c)]);
  }
  find_features(perceived, image.width, image.height, pixels_per_degree);
  for (std::size_t c = 0; c < 3; ++c) {
    apply_contrast_sensitivity(perceived.opponent[c], image.width, image.height, kSensitivities[c],
                               pixels_per_degree);
  }
  return perceived;
}

glm::vec3 color_at(const PerceivedImage& perceived, std::size_t i) {
  const glm::vec3 rgb = from_opponent({perceived.opponent[0][i], perceived.opponent[1][i], perceived.opponent[2][i]});
  return {std::clamp(rgb.x, 0.0f, 1.0f), std::clamp(rgb.y, 0.0f, 1.0f), std::clamp(rgb.z, 0.0f, 1.0f)};
}

}  // namespace

Flip flip(RgbView a, RgbView b, float pixels_per_degree) {
  CHECK(a.width == b.width && a.height == b.height, "pictures of different sizes");
  const PerceivedImage first = perceive(a, pixels_per_degree), second = perceive(b, pixels_per_degree);
  Flip result;
  for (std::size_t i = 0; i < first.edges.size(); ++i) {
    const float color = color_error(color_at(first, i), color_at(second, i));
    const float features =
        std::max(std::abs(first.edges[i] - second.edges[i]), std::abs(first.points[i] - second.points[i]));
    const float feature = std::min(power_of(0.707106781f * features, kFeatureExponent), 1.0f);
    const float error = std::clamp(power_of(color, 1 - feature), 0.0f, 1.0f);
    result.map.push_back(error);
    result.mean += static_cast<double>(error);
  }
  if (!result.map.empty()) result.mean /= static_cast<double>(result.map.size());
  return result;
}

}  // namespace fathom::runtime
