#include "runtime/march.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "runtime/certify.h"
#include "runtime/stream.h"
#include "vm/check.h"

namespace fathom::runtime {
namespace {

// The direction at unit length; nothing when it has none. One that is a unit vector to float precision stays as it
// is.
std::optional<glm::dvec3> unit(glm::dvec3 direction) {
  const double squared = glm::dot(direction, direction);
  if (!(squared > 1e-60 && squared < 1e60)) return std::nullopt;
  if (std::abs(squared - 1) < 1e-6) return direction;
  return direction / std::sqrt(squared);
}

bool finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// The part of the ray within [0, t_max] and the box, by slabs (Kay and Kajiya, "Ray Tracing Complex Scenes", 1986);
// nothing when there is none.
std::optional<Stretch> clip(const compiler::Box& box, glm::dvec3 origin, glm::dvec3 direction, double t_max) {
  if (box.empty()) return std::nullopt;
  Stretch part{0, t_max, 0};
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (!(origin[i] >= box.lo[i] && origin[i] <= box.hi[i])) return std::nullopt;
      continue;
    }
    const double inverse = 1 / direction[i];
    const double a = (box.lo[i] - origin[i]) * inverse, b = (box.hi[i] - origin[i]) * inverse;
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  if (!(part.begin <= part.end)) return std::nullopt;
  return part;
}

// Every ray searched in double from its start.
class Certifier final : public Marcher {
 public:
  using Marcher::Marcher;
  void advance() override {}

 private:
  void begin(const Course& course, int side, float) override { certify_from(course, side, {0, course.length, 0}, 0); }
};

}  // namespace

void Marcher::arrive(Arrival arrival) {
  switch (arrival.status) {
    case Arrival::Status::Hit:
      ++counters_.hits;
      break;
    case Arrival::Status::Miss:
      ++counters_.misses;
      break;
    case Arrival::Status::Contact:
      ++counters_.contacts;
      break;
    case Arrival::Status::Invalid:
      ++counters_.invalid;
      break;
  }
  arrival.instructions = std::uint64_t{arrival.evaluations} * field_.distance->instructions();
  counters_.instructions += arrival.instructions;
  arrivals_.push_back(arrival);
}

void Marcher::add(std::uint32_t id, const Ray& ray) {
  CHECK(live_ < kCapacity, "a ray was added to a full marcher");
  ++counters_.rays;
  Arrival arrival{id, Arrival::Status::Invalid, 1, 0, 0, 0, 0};
  const std::optional<glm::dvec3> direction = unit(ray.direction);
  if (!direction || !finite(ray.origin) || std::isnan(ray.t_max)) return arrive(arrival);
  const std::optional<Stretch> part = clip(field_.bound, ray.origin, *direction, std::min(ray.t_max, field_.far));
  if (!part) {
    ++counters_.clipped;
    arrival.status = Arrival::Status::Miss;
    return arrive(arrival);
  }
  begin({ray.origin + part->begin * *direction, *direction, part->begin, part->end - part->begin, id},
        part->begin > 0 ? 1 : ray.side, ray.slope);
}

void Marcher::certify_from(const Course& course, int side, const Stretch& stretch, std::uint32_t evaluations) {
  const Stage before = clock_.enter(Stage::Resolve);
  const Certified found = certify(field_, course.origin, course.direction, side, stretch, workspace_);
  clock_.enter(before);
  ++counters_.certified;
  counters_.certified_evaluations += found.evaluations;
  counters_.evaluations += found.evaluations;
  arrive({course.id, found.status, static_cast<std::int8_t>(found.side), evaluations + found.evaluations,
          found.evaluations, static_cast<float>(found.width), course.entry + found.t});
}

std::unique_ptr<Marcher> make_marcher(const Field& field, const Marching& marching) {
  if (marching.method == Method::Certified) return std::make_unique<Certifier>(field);
  if (marching.precision == Precision::Double) return std::make_unique<Stream<double>>(field, marching);
  return std::make_unique<Stream<float>>(field, marching);
}

MarchCounters follow(const Field& field, std::span<const Ray> rays, const Marching& marching,
                     const std::function<void(const Arrival&)>& settle) {
  const std::unique_ptr<Marcher> marcher = make_marcher(field, marching);
  std::vector<Arrival> arrivals;
  for (std::size_t next = 0; next < rays.size() || !marcher->empty();) {
    while (next < rays.size() && marcher->room() > 0) {
      marcher->add(static_cast<std::uint32_t>(next), rays[next]);
      ++next;
    }
    marcher->advance();
    marcher->take_arrivals(arrivals);
    for (const Arrival& arrival : arrivals) settle(arrival);
  }
  return marcher->counters();
}

MarchResult march(const Field& field, std::span<const Ray> rays, const Marching& marching) {
  MarchResult result;
  result.arrivals.resize(rays.size());
  result.counters =
      follow(field, rays, marching, [&](const Arrival& arrival) { result.arrivals[arrival.id] = arrival; });
  return result;
}

}  // namespace fathom::runtime
