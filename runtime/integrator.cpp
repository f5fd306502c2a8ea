#include "runtime/integrator.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/bsdf.h"
#include "runtime/elementary.h"

namespace fathom::runtime {
namespace {

// Arrivals are shaded when so many wait: enough for the machine's blocks, few enough to keep the stream full.
constexpr std::size_t kShadeBatch = 64;
// Paths are started so many at once.
constexpr std::size_t kStartBatch = 32;
// A path goes on with at most this probability, so that even a closed white room ends.
constexpr float kMostSurvival = 0.95f;

float max_component(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

glm::vec3 background_radiance(const compiler::Background& background, glm::dvec3 direction) {
  const double share = std::clamp((direction.y + 1) / 2, 0.0, 1.0);
  return glm::vec3(background.bottom * (1 - share) + background.top * share);
}

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

Integrator::Integrator(const World& world, Film& film)
    : world_(world), film_(film), marcher_(make_marcher(world.field, world.settings.marching)) {
  paths_.resize(static_cast<std::size_t>(marcher_->capacity()));
  for (std::size_t id = paths_.size(); id > 0; --id) free_ids_.push_back(static_cast<std::uint32_t>(id - 1));
}

void Integrator::run(const NextPaths& next) {
  StageClock& clock = marcher_->clock();
  if (world_.settings.profile) clock.start(Stage::Shading);
  bool more = true;
  while (true) {
    while (more && !free_ids_.empty()) more = start_paths(next);
    if (marcher_->empty() && marcher_->arrivals().empty()) break;
    clock.enter(Stage::March);
    marcher_->advance();
    if (marcher_->arrivals().size() >= kShadeBatch || marcher_->empty()) settle_arrivals();
  }
  clock.stop();
}

// False when there are no more.
bool Integrator::start_paths(const NextPaths& next) {
  marcher_->clock().enter(Stage::Shading);
  std::array<PathKey, kStartBatch> keys;
  const std::size_t wanted = std::min(kStartBatch, free_ids_.size());
  const std::size_t given = next(std::span(keys).first(wanted));
  start(std::span(keys).first(given));
  return given == wanted;
}

// In steps of one kind each, so that the processor has several paths' in hand.
void Integrator::start(std::span<const PathKey> keys) {
  const Settings& settings = world_.settings;
  std::array<Sampler, kStartBatch> samplers;
  std::array<CameraRay, kStartBatch> rays;
  std::uint64_t pixel_key = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const PathKey& key = keys[i];
    const bool same = i > 0 && key.x == keys[i - 1].x && key.y == keys[i - 1].y;
    if (!same) {
      pixel_key =
          Sampler::pixel_key(settings.seed, static_cast<std::uint32_t>(key.x), static_cast<std::uint32_t>(key.y));
    }
    samplers[i] = Sampler(pixel_key, key.sample);
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    // A single sample shows what lies at the pixel's centre.
    const glm::vec2 place = settings.spp == 1 ? glm::vec2(0.5f) : samplers[i].next2();
    rays[i] = world_.camera.ray(keys[i].x + static_cast<double>(place.x), keys[i].y + static_cast<double>(place.y));
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::uint32_t id = free_ids_.back();
    free_ids_.pop_back();
    Path& path = paths_[id];
    path.key = keys[i];
    path.sampler = samplers[i];
    path.origin = rays[i].origin;
    path.direction = rays[i].direction;
    path.throughput = glm::vec3(1);
    path.absorption = glm::vec3(0);
    path.bounces = 0;
    path.result = {};
    path.result.number = keys[i].sample;
    marcher_->add(id, {path.origin, path.direction});
  }
  stats_.primary_rays += keys.size();
}

void Integrator::settle_arrivals() {
  marcher_->take_arrivals(settled_);
  if (film_.layers().cost) {
    for (const Arrival& arrival : settled_) {
      paths_[arrival.id].result.evaluations += arrival.evaluations;
      paths_[arrival.id].result.instructions += arrival.instructions;
    }
  }
  const auto is_hit = [](const Arrival& arrival) { return arrival.status == Arrival::Status::Hit; };
  const auto hits_end = std::partition(settled_.begin(), settled_.end(), is_hit);
  const std::span<const Arrival> hits(settled_.begin(), hits_end);
  for (std::size_t first = 0; first < hits.size(); first += kSurfaceBatch) {
    shade(hits.subspan(first, std::min(kSurfaceBatch, hits.size() - first)));
  }
  marcher_->clock().enter(Stage::Shading);
  for (const Arrival& arrival : std::span<const Arrival>(hits_end, settled_.end())) leave_scene(arrival);
  marcher_->clock().enter(Stage::Film);
  for (const std::uint32_t id : ended_) add_to_film(id);
  ended_.clear();
}

// A path that met nothing more sees the background.
void Integrator::leave_scene(const Arrival& arrival) {
  Path& path = paths_[arrival.id];
  if (arrival.status != Arrival::Status::Invalid) {
    path.result.radiance += path.throughput * background_radiance(world_.scene.background, path.direction);
  }
  ended_.push_back(arrival.id);
}

void Integrator::shade(std::span<const Arrival> arrivals) {
  marcher_->clock().enter(Stage::Normals);
  std::array<Hit, kSurfaceBatch> hits;
  std::array<SurfacePoint, kSurfaceBatch> points;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const Path& path = paths_[arrivals[i].id];
    hits[i] = {path.origin + arrivals[i].t * path.direction, glm::vec3(-path.direction), arrivals[i].side,
               arrivals[i].width};
  }
  find_surfaces(world_.scene, world_.field, std::span(hits).first(arrivals.size()), points, marcher_->workspace());
  marcher_->clock().enter(Stage::Shading);
  for (std::size_t i = 0; i < arrivals.size(); ++i) shade_one(arrivals[i], hits[i], points[i]);
}

void Integrator::shade_one(const Arrival& arrival, const Hit& hit, const SurfacePoint& point) {
  Path& path = paths_[arrival.id];
  const Material& material = world_.materials[point.material];
  const bool inside = arrival.side < 0;
  if (path.bounces == 0) record_first_hit(path, arrival, point, material);
  // Beer-Lambert law.
  if (path.absorption != glm::vec3(0)) path.throughput *= exp(-path.absorption * static_cast<float>(arrival.t));
  path.result.radiance += path.throughput * material.emission;

  const BsdfSample next = sample_bsdf(material, hit.wo, point.normal, inside, path.sampler);
  path.throughput *= next.weight;
  ++path.bounces;
  if (!(max_component(path.throughput) > 0) || !survives_roulette(path)) {
    ended_.push_back(arrival.id);
    return;
  }
  path.direction = next.wi;
  if (next.through) path.absorption = inside ? glm::vec3(0) : material.absorption;
  go_on(arrival.id, hit, point, next.through);
}

void Integrator::record_first_hit(Path& path, const Arrival& arrival, const SurfacePoint& point,
                                  const Material& material) {
  ++stats_.primary_hits;
  path.result.hit = true;
  path.result.albedo = albedo_of(material);
  path.result.normal = point.normal;
  path.result.depth = arrival.t;
  path.result.position = path.origin + arrival.t * path.direction;
  path.result.surface = point.surface;
  path.result.material = point.material;
  // The camera stands in a solid: its medium is that of the surface the ray comes out of.
  if (arrival.side < 0 && material.type == Material::Type::Transparent) path.absorption = material.absorption;
}

// Past the settled number of bounces a path survives with probability q and then counts 1/q times: the mean stays.
bool Integrator::survives_roulette(Path& path) {
  if (world_.settings.cut_after) return path.bounces <= *world_.settings.cut_after;
  if (path.bounces < world_.settings.bounces) return true;
  const float q = std::min(kMostSurvival, max_component(path.throughput));
  if (path.sampler.next() >= q) return false;
  path.throughput /= q;
  return true;
}

void Integrator::go_on(std::uint32_t id, const Hit& hit, const SurfacePoint& point, bool through) {
  Path& path = paths_[id];
  const Ray ray = leave(hit, point, path.direction, through);
  path.origin = ray.origin;
  marcher_->add(id, ray);
}

void Integrator::add_to_film(std::uint32_t id) {
  Path& path = paths_[id];
  if (!finite(path.result.radiance)) {
    ++stats_.dropped_samples;
    path.result.radiance = glm::vec3(0);
  }
  if (!film_.add(path.key.x, path.key.y, path.result)) ++stats_.saturated;
  free_ids_.push_back(id);
}

Stats Integrator::stats() const {
  Stats stats = stats_;
  stats.march = marcher_->counters();
  if (world_.settings.profile) stats.stages = marcher_->clock().seconds();
  return stats;
}

}  // namespace fathom::runtime
