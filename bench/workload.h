// The two workloads on which renderers are compared, and their counters.
//
// S: one camera ray per pixel, and one shadow ray from each hit that faces the light. P: diffuse path tracing under a
// white sky, albedo 0.8, max 4 bounces, no Russian roulette. Both are grey.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fathom::bench {

// A scene's camera, and the parameters of classic sphere tracing: the distance that counts as a hit, the rays' end.
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
inline constexpr int kMaxBounces = 4;  // of P: the fifth surface on a path is black
// Shading of S: 0.8 (0.1 + 0.9 s), where s is the cosine to the light, or 0 in shadow. A miss is 0.5 + 0.5 d.y.
inline constexpr double kAmbient = 0.1;
inline constexpr glm::dvec3 kToLight{0.6, 0.8, 0.4};  // not normalised

struct Picture {
  std::uint64_t rays = 0;         // camera rays and their successors
  std::uint64_t camera_hits = 0;  // of S
  std::vector<float> pixels;      // [y][x], grey

  double mean() const {
    double sum = 0;
    for (const float pixel : pixels) sum += static_cast<double>(pixel);
    return sum / static_cast<double>(pixels.size());
  }
};

}  // namespace fathom::bench
