#include "runtime/march.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "runtime/certify.h"
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

struct Stretch {
  double begin, end;
};

// The part of the ray within [0, t_max] and the box, by slabs (Kay and Kajiya, "Ray Tracing Complex Scenes", 1986);
// nothing when there is none.
std::optional<Stretch> clip(const compiler::Box& box, glm::dvec3 origin, glm::dvec3 direction, double t_max) {
  if (box.empty()) return std::nullopt;
  Stretch part{0, t_max};
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

// The largest float that is not above `value`.
float round_down(double value) {
  const float rounded = static_cast<float>(value);
  return static_cast<double>(rounded) > value ? std::nextafter(rounded, -INFINITY) : rounded;
}

}  // namespace

void Stream::arrive(std::uint32_t id, Arrival::Status status, float side, double t, double width) {
  counters_.hits += status == Arrival::Status::Hit;
  counters_.invalid += status == Arrival::Status::Invalid;
  arrivals_.push_back({id, status, static_cast<std::int8_t>(side < 0 ? -1 : 1), t, static_cast<float>(width)});
}

void Stream::add(std::uint32_t id, const Ray& ray) {
  CHECK(live_ < kCapacity, "a ray was added to a full stream");
  ++counters_.rays;
  const std::optional<glm::dvec3> direction = unit(ray.direction);
  if (!direction || !finite(ray.origin) || std::isnan(ray.t_max)) return arrive(id, Arrival::Status::Invalid, 1);
  const std::optional<Stretch> part = clip(field_.bound, ray.origin, *direction, std::min(ray.t_max, field_.far));
  if (!part) return arrive(id, Arrival::Status::Miss, 1);

  Course& course = courses_[static_cast<std::size_t>(live_)];
  course = {ray.origin + part->begin * *direction, *direction, part->begin, id};
  Lane& lane = lanes_[static_cast<std::size_t>(live_)];
  lane = {};
  lane.origin = course.origin;
  lane.direction = course.direction;
  lane.side = part->begin > 0 ? 1.0f : static_cast<float>(ray.side);
  lane.t_max = round_down(part->end - part->begin);
  lane.m = std::clamp(ray.slope, -1.0f, 0.9f);
  ++live_;
}

void Stream::place_points() {
  for (int i = 0; i < live_; ++i) {
    const std::size_t n = static_cast<std::size_t>(i);
    const Lane& lane = lanes_[n];
    x_[n] = lane.origin.x + lane.t_next * lane.direction.x;
    y_[n] = lane.origin.y + lane.t_next * lane.direction.y;
    z_[n] = lane.origin.z + lane.t_next * lane.direction.z;
  }
}

void Stream::advance() {
  place_points();
  const std::size_t count = static_cast<std::size_t>(live_);
  vm::evaluate_distance(*field_.distance, {x_.data(), y_.data(), z_.data()}, count, distance_.data(), workspace_);
  counters_.evaluations += count;
  const LaneRules rules{field_.inv_lipschitz, field_.band, field_.finest};
  // Downwards: a lane that ends is replaced by the last one, which has had its turn.
  for (int i = live_ - 1; i >= 0; --i) {
    const std::size_t n = static_cast<std::size_t>(i);
    const float error = distance_error(field_, x_[n], y_[n], z_[n], distance_[n]);
    const LaneVerdict verdict = update(lanes_[n], distance_[n], error, rules);
    if (verdict != LaneVerdict::Going) finish(i, verdict);
  }
}

void Stream::finish(int index, LaneVerdict verdict) {
  const std::size_t n = static_cast<std::size_t>(index), last = static_cast<std::size_t>(--live_);
  const Lane& lane = lanes_[n];
  const Course& course = courses_[n];
  switch (verdict) {
    case LaneVerdict::Hit:
      arrive(course.id, Arrival::Status::Hit, lane.side, course.entry + static_cast<double>(lane.t), lane.width);
      break;
    case LaneVerdict::Miss:
      arrive(course.id, Arrival::Status::Miss, lane.side);
      break;
    case LaneVerdict::Certify:
      certify_lane(lane, course);
      break;
    default:
      arrive(course.id, Arrival::Status::Invalid, lane.side);
      break;
  }
  lanes_[n] = lanes_[last];
  courses_[n] = courses_[last];
}

void Stream::certify_lane(const Lane& lane, const Course& course) {
  const Certified found = certify(field_, course.origin, course.direction, lane.side < 0 ? -1 : 1,
                                  static_cast<double>(lane.t), static_cast<double>(lane.t_max), workspace_);
  ++counters_.certified;
  counters_.certified_evaluations += found.evaluations;
  counters_.evaluations += found.evaluations;
  counters_.contacts += found.contact;
  counters_.exhausted += found.outcome == Certified::Outcome::Exhausted;
  switch (found.outcome) {
    case Certified::Outcome::Hit:
      return arrive(course.id, Arrival::Status::Hit, lane.side, course.entry + found.t, found.width);
    case Certified::Outcome::Miss:
      return arrive(course.id, Arrival::Status::Miss, lane.side);
    default:
      return arrive(course.id, Arrival::Status::Invalid, lane.side);
  }
}

MarchResult march(const Field& field, std::span<const Ray> rays) {
  MarchResult result;
  result.arrivals.resize(rays.size());
  Stream stream(field);
  std::vector<Arrival> arrivals;
  std::size_t next = 0;
  while (next < rays.size() || !stream.empty()) {
    while (next < rays.size() && stream.room() > 0) {
      stream.add(static_cast<std::uint32_t>(next), rays[next]);
      ++next;
    }
    stream.advance();
    stream.take_arrivals(arrivals);
    for (const Arrival& arrival : arrivals) result.arrivals[arrival.id] = arrival;
  }
  result.counters = stream.counters();
  return result;
}

}  // namespace fathom::runtime
