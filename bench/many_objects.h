// Benchmark scene D without its file: random spheres and boxes in the unit cube (bench/make-scene-d has the rules).
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace fathom::bench {

struct ManyObjects {
  struct Sphere {
    float x, y, z, r;
  };
  struct Box {
    float x, y, z, hx, hy, hz;
  };
  std::vector<Sphere> spheres;
  std::vector<Box> boxes;
};

inline ManyObjects make_many_objects(int count) {
  const double size = count <= 1000 ? 0.02 : count <= 10000 ? 0.01 : 0.005;
  std::uint32_t state = 1;
  const auto draw = [&](std::uint32_t n) {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>((state >> 8) % n) / n;
  };
  const auto rounded = [](double value) { return static_cast<float>(std::floor(value * 1e6 + 0.5 + 1e-9) * 1e-6); };
  ManyObjects objects;
  for (int i = 0; i < count; ++i) {
    const auto x = static_cast<float>(draw(10000)), y = static_cast<float>(draw(10000));
    const auto z = static_cast<float>(draw(10000));
    const double r = size * (0.5 + draw(1000)), hx = r * (0.5 + draw(1000)), hy = r * (0.5 + draw(1000));
    const double hz = r * (0.5 + draw(1000));
    if (i % 2 == 0) {
      objects.spheres.push_back({x, y, z, static_cast<float>(r)});
    } else {
      objects.boxes.push_back({x, y, z, rounded(hx), rounded(hy), rounded(hz)});
    }
  }
  return objects;
}

}  // namespace fathom::bench
