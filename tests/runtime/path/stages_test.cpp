// The stages of the integrator, each on its own.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "runtime/path/camera_rays.h"
#include "runtime/path/direct_light.h"
#include "runtime/path/emission.h"
#include "runtime/path/hits.h"
#include "runtime/path/mis.h"
#include "runtime/path/scatter.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::stages_test {
namespace {

using Status = RayHit::Status;

RenderContext context_of(const compiler::CompiledScene& scene, const RenderOptions& options = {}) {
  const Settings settings = resolve(scene, options);
  return {scene,
          settings,
          Camera(scene.camera, settings.width, settings.height),
          Filter(settings.filter, settings.filter_width),
          make_field(scene),
          Media(scene, extent_of(scene), settings.far),
          Materials(scene),
          Lights(scene),
          {},
          true};
}

std::vector<std::uint32_t> ids_of(std::span<const RayHit> ray_hits) {
  std::vector<std::uint32_t> ids;
  for (const RayHit& ray_hit : ray_hits) ids.push_back(ray_hit.id);
  std::ranges::sort(ids);
  return ids;
}

using Ids = std::vector<std::uint32_t>;

TEST_CASE("stages: ray hits are grouped by the next stage of their paths", "[path][render]") {
  std::vector<PathState> paths(8);
  for (const std::size_t id : {1, 3, 5, 7}) paths[id].has_shadow_ray = true;
  std::vector<RayHit> ray_hits;
  const Status statuses[] = {Status::Hit, Status::Hit,      Status::Miss,    Status::Miss,
                             Status::Hit, Status::NearMiss, Status::Invalid, Status::Hit};
  for (std::uint32_t id = 0; id < 8; ++id) ray_hits.push_back({id, statuses[id]});
  for (const bool passes : {false, true}) {
    CAPTURE(passes);
    std::vector<RayHit> grouped;
    const RayHitGroups groups = group_ray_hits(ray_hits, paths, passes, grouped);
    CHECK(ids_of(groups.ended_shadow_rays) == (passes ? Ids{3, 5} : Ids{1, 3, 5, 7}));
    CHECK(ids_of(groups.shadow_hits) == (passes ? Ids{1, 7} : Ids{}));
    CHECK(ids_of(groups.surface_hits) == Ids{0, 4});
    CHECK(ids_of(groups.escaped_rays) == Ids{2, 6});
  }
}

TEST_CASE("stages: the MIS weights of both ways to find a light add up to 1", "[path][render]") {
  for (const float bsdf_pdf : {1e-3f, 0.7f, 1.0f, 250.0f}) {
    for (const float light_pdf : {1e-3f, 0.4f, 1.0f, 1e4f}) {
      CAPTURE(bsdf_pdf, light_pdf);
      const float by_bsdf = bsdf_mis_weight(LightSampling::Mis, bsdf_pdf, light_pdf);
      CHECK(by_bsdf + power_heuristic(light_pdf, bsdf_pdf) == Approx(1).epsilon(1e-6));
    }
  }
  // A density of 0: the other way cannot find the light.
  for (const LightSampling sampling : {LightSampling::Mis, LightSampling::Nee, LightSampling::Bsdf}) {
    CHECK(bsdf_mis_weight(sampling, 0, 1) == 1);
    CHECK(bsdf_mis_weight(sampling, 1, 0) == 1);
  }
  CHECK(bsdf_mis_weight(LightSampling::Nee, 1, 1) == 0);
  CHECK(bsdf_mis_weight(LightSampling::Bsdf, 1, 1) == 1);
}

TEST_CASE("stages: a path begins with the camera's ray, in the camera's medium", "[path][render]") {
  const auto scene = scene_of(R"("camera": {"position": [0, 0, 0.5], "target": [0, 0, 0]},
      "film": {"width": 4, "height": 4}, "render": {"spp": 1},
      "materials": {"glass": {"type": "transparent", "ior": 1.25, "absorption": [1, 2, 3]}},
      "objects": [{"type": "sphere", "radius": 1, "material": "glass"}])");
  const RenderContext context = context_of(scene);
  std::vector<PathState> paths(3);
  const PathKey keys[] = {{2, 1, 5, 0}, {3, 3, 0, 0}};
  const std::uint32_t ids[] = {2, 0};
  RealScratch scratch;
  begin_paths(context, keys, ids, paths, scratch);
  const PathState& path = paths[2];
  const CameraRay expected = context.camera.ray(2.5, 1.5);
  CHECK(path.ray.origin == expected.origin);
  CHECK(path.ray.direction == expected.direction);
  CHECK(path.ray.side == -1);
  CHECK(path.medium.field == 1);
  CHECK(path.medium.ior == 1.25f);
  CHECK(path.medium.absorption == glm::vec3(1, 2, 3));
  CHECK(path.result.number == 5);
  CHECK((!path.ends && !path.has_shadow_ray && path.bounces == 0));
  CHECK(paths[0].key.x == 3);
}

TEST_CASE("stages: only light of two bounces or more is clamped", "[path][render]") {
  Settings settings{};
  settings.clamp = 2.0;
  for (const int bounces : {0, 1, 2, 3}) {
    CAPTURE(bounces);
    PathState path{};
    add_radiance(settings, path, {8, 4, 0}, bounces);
    add_radiance(settings, path, {1, 1, 1}, bounces);
    CHECK(path.result.radiance == (bounces < 2 ? glm::vec3(9, 5, 1) : glm::vec3(3, 2, 1)));
  }
}

TEST_CASE("stages: a shadow ray brings light unless it is occluded", "[path][render]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const RenderContext context = context_of(scene);
  std::vector<PathState> paths(4);
  std::vector<RayHit> ray_hits;
  for (const Status status : {Status::Miss, Status::Hit, Status::NearMiss, Status::Invalid}) {
    const auto id = static_cast<std::uint32_t>(ray_hits.size());
    paths[id].has_shadow_ray = true;
    paths[id].shadow_radiance = glm::vec3(1, 2, 3);
    ray_hits.push_back({id, status});
  }
  end_shadow_rays(context, 0, ray_hits, paths, {});
  for (const RayHit& ray_hit : ray_hits) {
    const bool free = ray_hit.status == Status::Miss || ray_hit.status == Status::NearMiss;
    CHECK(paths[ray_hit.id].result.radiance == (free ? glm::vec3(1, 2, 3) : glm::vec3(0)));
    CHECK(!paths[ray_hit.id].has_shadow_ray);
  }
}

TEST_CASE("stages: a shadow ray that passes a surface is attenuated by its medium", "[path][render]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const RenderContext context = context_of(scene);
  std::vector<PathState> paths(2);
  std::vector<ShadowRay> rays(2);
  const std::vector<RayHit> ray_hits = {{0, Status::Miss}, {1, Status::Miss}};
  for (PathState& path : paths) path.shadow_radiance = glm::vec3(1);
  rays[0].medium.absorption = glm::vec3(1, 2, 0);
  rays[0].length = 0.5;
  // The ray seeks the background and is still within a medium.
  rays[1].length = INFINITY;
  end_shadow_rays(context, 1, ray_hits, paths, rays);
  CHECK(paths[0].result.radiance.x == Approx(std::exp(-0.5)).epsilon(1e-6));
  CHECK(paths[0].result.radiance.y == Approx(std::exp(-1.0)).epsilon(1e-6));
  CHECK(paths[0].result.radiance.z == 1);
  CHECK(paths[1].result.radiance == glm::vec3(0));
}

TEST_CASE("stages: a BSDF sample is a bounce, or a null interaction", "[path][render]") {
  Settings settings{};
  settings.rr_depth = 10;
  const Hit hit{{0, 0, 0}, {0, 1, 0}, 1, 0};
  SurfacePoint point{};
  point.normal = {0, 1, 0};
  point.offset = 0.125f;
  std::vector<PathState> paths(3);
  const auto batch = std::make_unique<VertexBatch>();
  batch->count = 3;
  const BsdfSample samples[] = {
      {.wi = {0, 1, 0}, .weight = glm::vec3(0.5f), .pdf = 0.25f},
      {.wi = {0, -1, 0}, .weight = glm::vec3(0.75f), .is_transmission = true, .is_null = true},
      {.wi = {0, 1, 0}, .weight = glm::vec3(0)}};
  for (std::size_t i = 0; i < 3; ++i) {
    paths[i] = {};
    paths[i].throughput = glm::vec3(1);
    paths[i].eta_scale = 1;
    paths[i].medium.ior = 1;
    batch->path[i] = &paths[i];
    batch->own_beyond[i].ior = 1.5f;
    batch->own_beyond[i].side = -1;
    batch->surface[i] = {&hit, &point, &paths[i].medium, nullptr, &batch->own_beyond[i], false};
    batch->wi.set(i, samples[i].wi);
    batch->weight.set(i, samples[i].weight);
    batch->pdf[i] = samples[i].pdf;
    batch->eta_scale[i] = 1;
    batch->is_transmission[i] = samples[i].is_transmission;
    batch->is_null[i] = samples[i].is_null;
  }
  apply_bsdf_samples(settings, *batch);
  CHECK((paths[0].bounces == 1 && paths[0].null_interactions == 0 && paths[0].bsdf_pdf == 0.25f));
  CHECK((paths[1].bounces == 0 && paths[1].null_interactions == 1 && paths[1].bsdf_pdf == 0));
  CHECK((!paths[0].ends && !paths[1].ends && paths[2].ends));
  CHECK(paths[0].throughput == glm::vec3(0.5f));
  CHECK(paths[0].ray.origin == glm::dvec3(0, 0.125, 0));
  CHECK(paths[0].medium.ior == 1);
  CHECK(paths[1].ray.origin == glm::dvec3(0, -0.125, 0));
  CHECK(paths[1].medium.ior == 1.5f);
  CHECK(paths[1].ray.side == -1);
}

}  // namespace
}  // namespace fathom::runtime::stages_test
