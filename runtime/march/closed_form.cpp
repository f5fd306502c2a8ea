#include "runtime/march/closed_form.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "compiler/geometry/box.h"

namespace fathom::runtime {
namespace {

using compiler::ClosedForm;

constexpr double kNoEnd = std::numeric_limits<double>::infinity();
// Error of t and of places, relative to the largest number: float knows no more of the solid.
constexpr double kFormError = 4e-6;
// Cosine, squared, below which a ray barely touches a surface.
constexpr double kLeastCosine2 = 1e-4;

// The part of a ray in a solid: empty if begin > end.
struct Part {
  double begin = -kNoEnd, end = kNoEnd;
  bool grazes = false;
};

void clip_part(Part& part, double begin, double end) {
  part.begin = std::max(part.begin, begin);
  part.end = std::min(part.end, end);
}

// The part between the planes at -half and half across one axis.
void cut_slab(Part& part, double place, double speed, double half) {
  if (speed == 0) {
    if (std::abs(place) > half) part.end = -kNoEnd;
    part.grazes = part.grazes || std::abs(std::abs(place) - half) < kFormError * std::max(1.0, half);
    return;
  }
  const double a = (-half - place) / speed, b = (half - place) / speed;
  clip_part(part, std::min(a, b), std::max(a, b));
}

// The part within a ball or a round cylinder: |p + t d|^2 < r^2.
void cut_round(Part& part, double pp, double pd, double dd, double radius) {
  if (dd == 0) {
    if (pp > radius * radius) part.end = -kNoEnd;
    part.grazes = part.grazes || std::abs(pp - radius * radius) < kFormError * std::max(1.0, radius * radius);
    return;
  }
  const double square = pd * pd - dd * (pp - radius * radius);
  part.grazes = part.grazes || std::abs(square) < kLeastCosine2 * dd * radius * radius + kFormError * pd * pd;
  if (square < 0) {
    part.end = -kNoEnd;
    return;
  }
  const double root = std::sqrt(square);
  clip_part(part, (-pd - root) / dd, (-pd + root) / dd);
}

Part part_within(const ClosedForm& form, glm::dvec3 p, glm::dvec3 d) {
  Part part;
  const auto& size = form.size;
  switch (form.shape) {
    case ClosedForm::Shape::Ball:
      cut_round(part, glm::dot(p, p), glm::dot(p, d), glm::dot(d, d), size[0]);
      break;
    case ClosedForm::Shape::Box:
      for (int axis = 0; axis < 3; ++axis) cut_slab(part, p[axis], d[axis], size[static_cast<std::size_t>(axis)]);
      break;
    case ClosedForm::Shape::Cylinder:
      cut_round(part, p.x * p.x + p.z * p.z, p.x * d.x + p.z * d.z, d.x * d.x + d.z * d.z, size[0]);
      cut_slab(part, p.y, d.y, size[1]);
      break;
    case ClosedForm::Shape::HalfSpace: {
      const glm::dvec3 normal(size[0], size[1], size[2]);
      const double height = glm::dot(normal, p) - size[3], speed = glm::dot(normal, d);
      if (speed < 0) {
        clip_part(part, -height / speed, kNoEnd);
      } else if (height > 0) {
        part.end = -kNoEnd;
      }
      part.grazes = speed * speed < kLeastCosine2 * glm::dot(d, d);
      break;
    }
    case ClosedForm::Shape::None:
      break;
  }
  return part;
}

}  // namespace

Entrance find_entrance(const ClosedForm& form, glm::dvec3 origin, glm::dvec3 direction) {
  const glm::dvec3 p = form.linear * origin + form.translation, d = form.linear * direction;
  const Part part = part_within(form, p, d);
  if (part.grazes) return {Meeting::Uncertain, 0, 0};
  if (part.end == -kNoEnd) return {Meeting::Misses, 0, 0};
  const double begin = std::isfinite(part.begin) ? std::abs(part.begin) : 0;
  const double slack = kFormError * std::max({1.0, begin, compiler::largest_part(origin)});
  if (std::abs(part.end - part.begin) < 4 * slack) return {Meeting::Uncertain, 0, 0};
  if (part.begin > part.end || part.end < -4 * slack) return {Meeting::Misses, 0, 0};
  if (part.begin < 4 * slack) return {Meeting::Uncertain, 0, 0};
  return {Meeting::Enters, part.begin, slack};
}

}  // namespace fathom::runtime
