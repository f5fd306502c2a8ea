#include "runtime/mesh/lost/field_probe.h"

#include <algorithm>
#include <cmath>

namespace fathom::runtime {

FieldProbe::FieldProbe(const MeshField& field) : field_(field) {}

void FieldProbe::at(std::span<const glm::dvec3> places, std::vector<ProbedPoint>& out) {
  points_.clear();
  for (const glm::dvec3& place : places) points_.push_back(place);
  values_.resize(places.size());
  field_.evaluate(points_.from(0), places.size(), MeshField::Values::Distance, values_.data(), scratch_);
  radii_ = values_;
  if (field_.field().cells) {
    field_.evaluate(points_.from(0), places.size(), MeshField::Values::Radius, radii_.data(), scratch_);
  } else {
    for (float& radius : radii_) radius *= field_.field().inv_lipschitz;
  }
  out.clear();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec3 place = points_[i];
    const double error = static_cast<double>(field_.error(place, values_[i]));
    const double radius = std::abs(static_cast<double>(radii_[i])) - error;
    // NaN proves nothing: max() returns its first argument then.
    out.push_back(
        {glm::dvec3(place), static_cast<double>(values_[i]), std::max(0.0, radius), field_.side(place, values_[i])});
  }
}

ProbedPoint FieldProbe::at(glm::dvec3 place) {
  at(std::span(&place, 1), one_);
  return one_.front();
}

MeshField::SurfacePoint FieldProbe::surface_at(glm::dvec3 place) {
  points_.clear();
  points_.push_back(place);
  field_.find_surfaces(points_, surfaces_, 1);
  return surfaces_.front();
}

double FieldProbe::way_out(const ProbedPoint& from, glm::dvec3 direction, double most) {
  // Balls are followed until they are too short to count. Then steps find the other side, and false position the
  // zero.
  constexpr double kLeastStep = 0x1p-9;  // of `most`
  constexpr int kFalsePositions = 6;
  double inside = 0, inside_value = from.value, step = from.radius;
  while (inside < most) {
    double outside = std::min(most, inside + std::max(step, kLeastStep * most));
    ProbedPoint point = at(from.place + outside * direction);
    if (point.side == from.side) {
      inside = outside, inside_value = point.value, step = point.radius;
      continue;
    }
    double outside_value = point.value;
    for (int i = 0; i < kFalsePositions && point.side != Side::Unknown; ++i) {
      const double share = std::clamp(inside_value / (inside_value - outside_value), 0x1p-4, 1 - 0x1p-4);
      const double middle = inside + (std::isfinite(share) ? share : 0.5) * (outside - inside);
      point = at(from.place + middle * direction);
      if (point.side == from.side) {
        inside = middle, inside_value = point.value;
      } else {
        outside = middle, outside_value = point.value;
      }
    }
    return point.side == from.side ? inside : outside;
  }
  return most;
}

}  // namespace fathom::runtime
