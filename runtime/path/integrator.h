// The path integrator: camera paths followed from hit to hit until they end.
//
// One Integrator per thread keeps marchers full of rays, one for the scene's field and one for each medium's that a
// ray was in: every ray that arrives is shaded and goes on as the path's next ray, or makes room for a new camera
// path. At each hit light is looked for in two ways, whose shares add up to 1 (multiple importance sampling): a light
// is chosen and a shadow ray sent to it (shade.cpp), and the path's next ray may hit one.
//
//     Integrator integrator(world, {plan}, exchange);   // that gives keys of paths and takes what they bring
//     integrator.run();
//
// Source: Kajiya, "The Rendering Equation", 1986; Veach, "Robust Monte Carlo Methods for Light Transport Simulation",
// 1997, chapters 8 and 9; Russian roulette: Arvo and Kirk, "Particle Transport and Image Synthesis", 1990. Tested by:
// tests/runtime/render_test.cpp, light_transport_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/base/stats.h"
#include "runtime/field/field.h"
#include "runtime/film/film.h"
#include "runtime/light/light.h"
#include "runtime/march/march.h"
#include "runtime/material/bsdf.h"
#include "runtime/material/material.h"
#include "runtime/path/media.h"
#include "runtime/path/options.h"
#include "runtime/path/path.h"
#include "runtime/path/surface.h"
#include "runtime/sampling/camera.h"
#include "runtime/sampling/filter.h"
#include "runtime/sampling/sampler.h"

namespace fathom::runtime {

// What every thread reads and none writes.
struct World {
  const compiler::CompiledScene& scene;
  Settings settings;
  Camera camera;
  Filter filter;
  Field field;
  Media media;
  Materials materials;
  Lights lights;
  std::optional<Space> camera_space;  // where all camera rays begin, if they do in the same
  bool numbered = true;  // surfaces and materials have the numbers that they have in the picture's own scene
};

// Which numbers paths are drawn by, and where they stand among the samples of their pixel.
struct Pass {
  SamplePlan plan;
  std::uint32_t first_number = 0;  // PathSample::number of the pass's sample 0
};

// Where paths come from, and what they bring home goes to.
class PathExchange {
 public:
  virtual ~PathExchange() = default;
  // Asked for the next paths: fills `keys` from the front and returns how many; fewer than asked for, and there are
  // no more.
  virtual std::size_t next(std::span<PathKey> keys) = 0;
  // A path has ended, in no order. False when some sum is full.
  virtual bool add(const PathKey& key, const PathSample& sample) = 0;
};

class Integrator {
 public:
  Integrator(const World& world, const Pass& pass, PathExchange& exchange);

  // Follows all paths there are to their end.
  void run();
  Stats stats() const;

 private:
  // A path at a place where it met a surface, and how it may go on from there.
  struct Vertex {
    std::uint32_t id;
    Path* path;
    const Hit* hit;
    const SurfacePoint* point;
    Space space;                    // that the ray came through
    const MaterialPoint* material;  // `made`, or one that is the same everywhere
    MaterialPoint made;
    bool inside;   // the path comes out of the solid whose surface this is
    Space beyond;  // what it gets into if it goes through
    std::optional<Bsdf> bsdf;
    LightQuery query;
    BsdfSample next;
    float roulette;  // a number in [0,1)
    LightSample light;
  };

  bool start_paths();
  void start(std::span<const PathKey> keys);
  bool idle() const;
  bool due(std::size_t field) const;
  void advance(std::size_t field);
  void settle_arrivals(std::size_t field);
  struct Places {
    std::array<Hit, kSurfaceBatch> hits;
    std::array<SurfacePoint, kSurfaceBatch> points;
  };
  template <class RayOf>
  void find_places(std::size_t field, std::span<const RayHit> ray_hits, Places& places, const RayOf& ray_of);
  void shade(std::size_t field, std::span<const RayHit> ray_hits);
  void pass_shadows(std::size_t field, std::span<const RayHit> ray_hits);
  void follow(std::uint32_t id, const Ray& ray);
  void leave_scene(const RayHit& ray_hit);
  void hand_in(std::uint32_t id);  // and frees the id

  Marcher& marcher(std::size_t field);
  const Field& field(std::size_t number) const { return number == 0 ? world_.field : world_.media.field(number - 1); }

  // shade.cpp
  struct ShadowRay {
    Space space;
    Ray ray;
    double length;      // to the light, a little more than ray.t_max
    int crossings = 0;  // made before
  };
  void look_along(std::uint32_t id, const ShadowRay& shadow);
  void pass_shadow(const RayHit& ray_hit, const Hit& hit, const SurfacePoint& point);
  void shade_vertices(std::span<const RayHit> ray_hits, std::span<const Hit> hits,
                      std::span<const SurfacePoint> points);
  void meet(Vertex& vertex, const RayHit& ray_hit, const Hit& hit, const SurfacePoint& point);
  void find_material(Vertex& vertex);
  MaterialPoint mix_of(const vm::SurfaceShares& shares, glm::dvec3 place);
  bool is_inside(const Vertex& vertex) const;
  void sample_bsdf(Vertex& vertex);
  void sample_light(Vertex& vertex);
  float relative_index(const Vertex& vertex) const;
  Space beyond(const Vertex& vertex);
  Space no_medium(const Vertex& vertex, glm::dvec3 place);
  void record_first_hit(const Vertex& vertex, const RayHit& ray_hit);
  void add_emission(const Vertex& vertex);
  bool is_endless(std::size_t field, std::uint32_t id) const;
  float hit_share(const Path& path, float light_pdf) const;
  void add_light(Path& path, glm::vec3 radiance, int bounces);
  std::optional<ShadowRay> look_for_light(Vertex& vertex);
  void go_with(const Vertex& vertex);
  bool plays_roulette(int bounces) const;
  bool survives(Path& path, float roulette) const;
  void end_shadow_test(std::uint32_t id, bool free);
  void go_on(std::uint32_t id);

  const World& world_;
  const Pass pass_;
  PathExchange& exchange_;
  std::vector<std::unique_ptr<Marcher>> marchers_;  // [0]: of the scene's field; [1 + medium]: once a ray was there
  std::vector<Path> paths_;                         // [id]
  std::vector<ShadowRay> shadows_;                  // [id], where surfaces may let light straight through
  std::vector<std::uint32_t> free_ids_, ended_;
  std::vector<RayHit> settled_;   // scratch
  std::vector<Vertex> vertices_;  // scratch
  Vertex passed_;                 // scratch: what a shadow ray goes through
  RealScratch scratch_;
  Stats stats_;
};

}  // namespace fathom::runtime
