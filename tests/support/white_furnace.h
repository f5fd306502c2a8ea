// White furnace test: a ball of a white material in uniform light of radiance 1 has radiance 1 everywhere, if neither
// the material nor the paths through the ball lose energy.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "runtime/render.h"
#include "runtime/sampling/sampler.h"

namespace fathom::test {

struct WhiteMaterial {
  std::string json;
  // `glass`: true if some of the material transmits.
  bool coat = false, glass = false, rough_pigment = false;
};

// Returns random white material number `number`. Metalness, transmission and coat are each present, partly or fully,
// in half of the materials.
inline WhiteMaterial random_white(std::uint32_t number) {
  runtime::Sampler sampler(2026, number, 0, 0);
  const auto pick = [&](double low, double high) { return low + (high - low) * static_cast<double>(sampler.next()); };
  const auto share = [&](double none, double all) {
    const double kind = pick(0, 1), value = pick(0, 1);
    return kind < none ? 0 : kind < none + all ? 1 : value;
  };
  const double metalness = share(0.5, 0.25), transmission = share(0.5, 0.25), coat = share(0.5, 0.25);
  const double roughness = share(0.15, 0.05), diffuse = share(0.75, 0.05), coat_roughness = share(0.4, 0.05);
  const double ior = pick(1.1, 2.5), coat_ior = pick(1.2, 2), opacity = share(0, 0.9);
  const bool thin = pick(0, 1) < 0.25;
  WhiteMaterial made;
  made.json = R"({"type": "principled", "color": [1, 1, 1])";
  const auto put = [&](const char* name, double value) {
    made.json += std::string(", \"") + name + "\": " + std::to_string(value);
  };
  put("metalness", metalness);
  put("transmission", transmission);
  put("coat", coat);
  put("roughness", roughness);
  put("diffuse_roughness", diffuse);
  put("coat_roughness", coat_roughness);
  put("ior", ior);
  put("coat_ior", coat_ior);
  put("opacity", opacity);
  made.json += thin ? R"(, "thin_walled": true})" : "}";
  made.coat = coat > 0;
  made.glass = transmission > 0 && metalness < 1;
  made.rough_pigment = diffuse > 0 && transmission < 1 && metalness < 1;
  return made;
}

// Scene after `"version": 1`. The ball's disc touches the edges of a square image.
inline std::string furnace(const std::string& material) {
  return R"("camera": {"type": "orthographic", "position": [0, 0, 3], "target": [0, 0, 0], "width": 2},
            "background": [1, 1, 1], "materials": {"m": )" +
         material + R"(}, "objects": [{"type": "sphere", "radius": 1, "material": "m"}])";
}

// Fraction of the light that the ball's disc returns, over `side` x `side` pixels with `spp` samples per pixel.
// Samples that miss the ball have radiance 1 and are subtracted.
inline double returned(const compiler::CompiledScene& scene, int side, int spp) {
  runtime::RenderOptions options;
  options.width = options.height = side;
  options.spp = spp;
  options.sampler = runtime::SamplerKind::Sobol;
  options.filter = compiler::FilterKind::Box;
  const runtime::Film film = runtime::render(scene, options).film;
  double sum = 0, samples = 0, hits = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const runtime::PixelMeans means = film.means(x, y);
      sum += means.radiance.x * means.samples;
      samples += means.samples;
      hits += means.hits;
    }
  }
  return (sum - (samples - hits)) / hits;
}

}  // namespace fathom::test
