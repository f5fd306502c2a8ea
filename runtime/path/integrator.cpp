#include "runtime/path/integrator.h"

#include <algorithm>
#include <cmath>

namespace fathom::runtime {
namespace {

// Arrivals are shaded when so many wait: enough for the machine's blocks, few enough to keep the stream full.
constexpr std::size_t kShadeBatch = 64;
// Vertices are shaded so many at once: they fit the processor's first cache.
constexpr std::size_t kVertexBatch = 16;
// Paths are started so many at once.
constexpr std::size_t kStartBatch = 32;

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::size_t under_way(const Marcher& marcher) {
  return static_cast<std::size_t>(marcher.capacity() - marcher.room());
}

}  // namespace

Integrator::Integrator(const World& world, const Pass& pass, PathExchange& exchange)
    : world_(world), pass_(pass), exchange_(exchange) {
  marchers_.resize(1 + world.media.size());
  int paths = marcher(0).capacity();
  for (std::size_t i = 0; i < world.media.size(); ++i) {
    paths = std::min(paths, Marcher::capacity_for(world.media.field(i)));
  }
  paths_.resize(static_cast<std::size_t>(paths));
  vertices_.resize(kVertexBatch);
  if (world.materials.pass_straight()) shadows_.resize(paths_.size());
  for (std::size_t id = paths_.size(); id > 0; --id) free_ids_.push_back(static_cast<std::uint32_t>(id - 1));
}

// Made when the first ray is in the medium: it takes 300 KB, and a scene may have thousands of media.
Marcher& Integrator::marcher(std::size_t field) {
  std::unique_ptr<Marcher>& marcher = marchers_[field];
  if (!marcher) marcher = make_marcher(this->field(field), world_.settings.marching);
  return *marcher;
}

void Integrator::run() {
  StageClock& clock = marchers_[0]->clock();
  if (world_.settings.profile) clock.start(Stage::Shading);
  bool more = true;
  while (true) {
    while (more && !free_ids_.empty()) more = start_paths();
    if (idle()) break;
    for (std::size_t field = 0; field < marchers_.size(); ++field) {
      if (due(field)) advance(field);
    }
  }
  clock.stop();
}

bool Integrator::idle() const {
  return std::all_of(marchers_.begin(), marchers_.end(), [](const auto& marcher) {
    return !marcher || (marcher->empty() && marcher->ray_hits().empty());
  });
}

// Rays within a medium wait until they fill registers, or until there are no others.
bool Integrator::due(std::size_t field) const {
  if (field == 0) return true;
  if (!marchers_[field]) return false;
  const std::size_t rays = under_way(*marchers_[field]);
  return rays > 0 && rays >= std::min(kShadeBatch, under_way(*marchers_[0]));
}

void Integrator::advance(std::size_t field) {
  Marcher& marcher = *marchers_[field];
  marchers_[0]->clock().enter(Stage::March);
  marcher.advance();
  if (marcher.ray_hits().size() >= kShadeBatch || marcher.empty()) settle_arrivals(field);
}

// False when there are no more.
bool Integrator::start_paths() {
  marchers_[0]->clock().enter(Stage::Shading);
  std::array<PathKey, kStartBatch> keys;
  const std::size_t wanted = std::min(kStartBatch, free_ids_.size());
  const std::size_t given = exchange_.next(std::span(keys).first(wanted));
  start(std::span(keys).first(given));
  return given == wanted;
}

// In steps of one kind each, so that the processor has several paths' in hand.
void Integrator::start(std::span<const PathKey> keys) {
  const Settings& settings = world_.settings;
  std::array<Sampler, kStartBatch> samplers;
  std::array<CameraRay, kStartBatch> rays;
  std::array<float, kStartBatch> weights;
  PixelKey pixel;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const PathKey& key = keys[i];
    const bool same = i > 0 && key.x == keys[i - 1].x && key.y == keys[i - 1].y;
    if (!same) pixel = PixelKey(pass_.plan, static_cast<std::uint32_t>(key.x), static_cast<std::uint32_t>(key.y));
    samplers[i] = Sampler(pixel, key.sample);
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    // A single sample shows what lies at the pixel's centre.
    const FilterSample place = settings.spp == 1 ? FilterSample{} : world_.filter.sample(samplers[i].next2());
    const double x = keys[i].x + 0.5 + static_cast<double>(place.offset.x);
    const double y = keys[i].y + 0.5 + static_cast<double>(place.offset.y);
    rays[i] = world_.camera.has_lens() ? world_.camera.ray(x, y, samplers[i].next2()) : world_.camera.ray(x, y);
    weights[i] = place.weight;
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::uint32_t id = free_ids_.back();
    free_ids_.pop_back();
    Path& path = paths_[id];
    path.key = keys[i];
    path.sampler = samplers[i];
    path.space = world_.camera_space ? *world_.camera_space
                                     : space_at(rays[i].origin, world_.media, world_.materials, scratch_);
    path.throughput = glm::vec3(1);
    path.weight = weights[i];
    path.eta_scale = 1;
    path.bounces = 0;
    path.crossings = 0;
    path.pdf = 0;
    path.in_shadow_test = false;
    path.ends = false;
    path.result = {};
    path.result.number = pass_.first_number + keys[i].sample;
    Ray ray{rays[i].origin, rays[i].direction};
    ray.side = path.space.side;
    follow(id, ray);
  }
  stats_.primary_rays += keys.size();
}

void Integrator::follow(std::uint32_t id, const Ray& ray) {
  Path& path = paths_[id];
  path.origin = ray.origin;
  path.direction = ray.direction;
  marcher(path.space.field).add(id, ray);
}

void Integrator::settle_arrivals(std::size_t field) {
  StageClock& clock = marchers_[0]->clock();
  marchers_[field]->take_ray_hits(settled_);
  if (world_.settings.layers.cost) {
    for (const RayHit& ray_hit : settled_) {
      paths_[ray_hit.id].result.evaluations += ray_hit.evaluations;
      paths_[ray_hit.id].result.instructions += ray_hit.instructions;
    }
  }
  clock.enter(Stage::Shading);
  const auto is_hit = [](const RayHit& ray_hit) { return ray_hit.status == RayHit::Status::Hit; };
  const auto tests_shadow = [&](const RayHit& ray_hit) { return paths_[ray_hit.id].in_shadow_test; };
  // What stands in the way of light may let some of it straight through.
  const auto ends_test = [&](const RayHit& ray_hit) {
    return tests_shadow(ray_hit) && (shadows_.empty() || !is_hit(ray_hit));
  };
  const auto tests_end = std::partition(settled_.begin(), settled_.end(), ends_test);
  const auto shadows_end = std::partition(tests_end, settled_.end(), tests_shadow);
  const auto hits_end = std::partition(shadows_end, settled_.end(), is_hit);
  for (const RayHit& ray_hit : std::span(settled_.begin(), tests_end)) {
    const bool free = ray_hit.status == RayHit::Status::Miss || ray_hit.status == RayHit::Status::Contact;
    end_shadow_test(ray_hit.id, free && !is_endless(field, ray_hit.id));
  }
  const auto in_batches = [](std::span<const RayHit> ray_hits, const auto& use) {
    for (std::size_t first = 0; first < ray_hits.size(); first += kSurfaceBatch) {
      use(ray_hits.subspan(first, std::min(kSurfaceBatch, ray_hits.size() - first)));
    }
  };
  in_batches({tests_end, shadows_end}, [&](std::span<const RayHit> some) { pass_shadows(field, some); });
  in_batches({shadows_end, hits_end}, [&](std::span<const RayHit> some) { shade(field, some); });
  for (const RayHit& ray_hit : std::span(hits_end, settled_.end())) leave_scene(ray_hit);
  clock.enter(Stage::Film);
  for (const std::uint32_t id : ended_) hand_in(id);
  ended_.clear();
}

// Whether a shadow ray looked for the background from within a medium and met no end of that: as leave_scene() has
// it, there is none to see.
bool Integrator::is_endless(std::size_t field, std::uint32_t id) const {
  return field != 0 && !shadows_.empty() && std::isinf(shadows_[id].length);
}

// A path that met nothing more sees the background.
void Integrator::leave_scene(const RayHit& ray_hit) {
  Path& path = paths_[ray_hit.id];
  if (ray_hit.status != RayHit::Status::Invalid && path.space.field == 0) {
    const glm::vec3 direction(path.direction);
    const bool sought = path.pdf > 0 && !world_.lights.empty();
    const float share = hit_share(path, sought ? world_.lights.pdf_of_background(path.from, direction) : 0);
    if (share > 0) add_light(path, path.throughput * world_.lights.background(direction) * share, path.bounces);
  }
  ended_.push_back(ray_hit.id);
}

// The places that rays of path or shadow met; `ray_of` gives an ray_hit's origin and direction.
template <class RayOf>
void Integrator::find_places(std::size_t number, std::span<const RayHit> ray_hits, Places& places,
                             const RayOf& ray_of) {
  StageClock& clock = marchers_[0]->clock();
  clock.enter(Stage::Normals);
  for (std::size_t i = 0; i < ray_hits.size(); ++i) {
    const auto& ray = ray_of(ray_hits[i].id);
    places.hits[i] = {ray.origin + ray_hits[i].t * ray.direction, glm::vec3(-ray.direction), ray_hits[i].side,
                      ray_hits[i].width};
  }
  const std::span<const Hit> hits = std::span(places.hits).first(ray_hits.size());
  find_surfaces(world_.scene, field(number), hits, places.points, marchers_[number]->workspace());
  fathom::runtime::find_places(world_.scene, field(number), hits, places.points, scratch_);
  clock.enter(Stage::Shading);
}

void Integrator::shade(std::size_t number, std::span<const RayHit> ray_hits) {
  Places places;
  find_places(number, ray_hits, places, [&](std::uint32_t id) -> const Path& { return paths_[id]; });
  for (std::size_t first = 0; first < ray_hits.size(); first += vertices_.size()) {
    const std::size_t count = std::min(vertices_.size(), ray_hits.size() - first);
    shade_vertices(ray_hits.subspan(first, count), std::span(places.hits).subspan(first, count),
                   std::span(places.points).subspan(first, count));
  }
}

void Integrator::pass_shadows(std::size_t number, std::span<const RayHit> ray_hits) {
  Places places;
  find_places(number, ray_hits, places, [&](std::uint32_t id) -> const Ray& { return shadows_[id].ray; });
  for (std::size_t i = 0; i < ray_hits.size(); ++i) pass_shadow(ray_hits[i], places.hits[i], places.points[i]);
}

void Integrator::hand_in(std::uint32_t id) {
  Path& path = paths_[id];
  if (!finite(path.result.radiance)) {
    ++stats_.dropped_samples;
    path.result.radiance = glm::vec3(0);
  }
  path.result.radiance *= path.weight;
  const glm::vec3 radiance = path.result.radiance;
  const float brightest = std::max({radiance.x, radiance.y, radiance.z});
  if (brightest > 0) ++stats_.lit_samples;
  if (brightest > 0 && brightest < static_cast<float>(kFaintLight)) ++stats_.faint_samples;
  if (!exchange_.add(path.key, path.result)) ++stats_.saturated;
  free_ids_.push_back(id);
}

Stats Integrator::stats() const {
  Stats stats = stats_;
  for (const auto& marcher : marchers_) {
    if (marcher) stats.march.merge(marcher->counters());
  }
  if (world_.settings.profile) stats.stages = marchers_[0]->clock().seconds();
  return stats;
}

}  // namespace fathom::runtime
