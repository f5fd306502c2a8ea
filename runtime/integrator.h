// The path integrator: camera paths followed from hit to hit until they end.
//
// One Integrator per thread keeps a marcher full of rays: every ray that arrives is shaded and goes on as the path's
// next ray, or makes room for a new camera path. Light is found by hitting it.
//
//     Integrator integrator(world, film);
//     integrator.run([&](std::span<PathKey> keys) { fill keys; return how many; });
//
// Source: Kajiya, "The Rendering Equation", 1986; Russian roulette: Arvo and Kirk, "Particle Transport and Image
// Synthesis", 1990. Tested by: tests/runtime/render_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "compiler/compiled_scene.h"
#include "runtime/camera.h"
#include "runtime/field.h"
#include "runtime/film.h"
#include "runtime/filter.h"
#include "runtime/march.h"
#include "runtime/material.h"
#include "runtime/options.h"
#include "runtime/sampler.h"
#include "runtime/stats.h"
#include "runtime/surface.h"

namespace fathom::runtime {

// What every thread reads and none writes.
struct World {
  const compiler::CompiledScene& scene;
  Settings settings;
  Camera camera;
  Filter filter;
  Field field;
  std::vector<Material> materials;
};

// One camera path to be followed.
struct PathKey {
  int x, y;              // pixel
  std::uint32_t sample;  // in [0, spp)
};

class Integrator {
 public:
  // Asked for the next paths: fills `keys` from the front and returns how many; fewer than asked for, and there are
  // no more.
  using NextPaths = std::function<std::size_t(std::span<PathKey> keys)>;

  Integrator(const World& world, Film& film);

  // Follows all paths `next` gives to their end, and adds them to the film.
  void run(const NextPaths& next);
  Stats stats() const;

 private:
  struct Path {
    PathKey key;
    Sampler sampler;
    glm::dvec3 origin;  // of the current ray, scene units
    glm::dvec3 direction;
    glm::vec3 throughput;
    float weight;          // of the path in its pixel, by the filter
    glm::vec3 absorption;  // of the medium the ray travels through, per scene unit
    int bounces;           // made so far
    PathSample result;
  };

  bool start_paths(const NextPaths& next);
  void start(std::span<const PathKey> keys);
  void settle_arrivals();
  void shade(std::span<const Arrival> arrivals);
  void shade_one(const Arrival& arrival, const Hit& hit, const SurfacePoint& point);
  void record_first_hit(Path& path, const Arrival& arrival, const SurfacePoint& point, const Material& material);
  bool survives_roulette(Path& path);
  void go_on(std::uint32_t id, const Hit& hit, const SurfacePoint& point, bool through);
  void leave_scene(const Arrival& arrival);
  void add_to_film(std::uint32_t id);  // and frees the id

  const World& world_;
  Film& film_;
  std::unique_ptr<Marcher> marcher_;
  std::vector<Path> paths_;  // [id]
  std::vector<std::uint32_t> free_ids_, ended_;
  std::vector<Arrival> settled_;  // scratch
  Stats stats_;
};

}  // namespace fathom::runtime
