// The two workloads that renderers are compared on, and what is counted of them.
//
// S: one camera ray a pixel and, where it hits a surface that faces the light, one shadow ray. P: diffuse path
// tracing under a white sky, albedo 0.8, at most 4 bounces, no roulette. Both in grey.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fathom::bench {

// A scene's camera and the numbers that classic sphere tracing needs: what distance counts as a hit, where rays end.
struct View {
  glm::dvec3 eye, at;
  double fov;  // vertical, degrees
  double epsilon, t_max;
};

struct Frame {
  int width, height, spp;
};
inline constexpr Frame kShadowFrame{640, 360, 1}, kPathFrame{320, 180, 64};

inline constexpr double kAlbedo = 0.8;
inline constexpr int kMostBounces = 4;  // of P: the fifth surface met is black
// Of S: 0.8 (0.1 + 0.9 s) with s the cosine to the light, or 0 in the shade; a miss is 0.5 + 0.5 d.y.
inline constexpr double kAmbient = 0.1;
inline constexpr glm::dvec3 kToLight{0.6, 0.8, 0.4};  // not normalised

struct Picture {
  std::uint64_t rays = 0;         // camera rays and those after them
  std::uint64_t camera_hits = 0;  // of S
  std::vector<float> pixels;      // [y][x], grey

  double mean() const {
    double sum = 0;
    for (const float pixel : pixels) sum += static_cast<double>(pixel);
    return sum / static_cast<double>(pixels.size());
  }
};

}  // namespace fathom::bench
