#include "runtime/path/jump_normals.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/sampling/warp.h"

namespace fathom::runtime {
namespace {

// A change of the field across the surface by more than this factor beyond the gradient's is a jump.
constexpr double kJump = 8;
// Distance of the neighbouring points from the hit, in offsets, and length along the ray within which they are
// sought, in such distances, each way. A surface at a flatter angle to the ray keeps its gradient.
constexpr double kAside = 32, kReachSteps = 16;
constexpr int kHalvings = 40;

class JumpSearch {
 public:
  JumpSearch(const Field& field, const JumpQuery& query, RealScratch& scratch)
      : field_(field), query_(query), scratch_(scratch) {}

  bool jumps() const {
    const double steepness = glm::length(query_.gradient);
    if (!(steepness > 0)) return true;
    const glm::dvec3 step = query_.offset / steepness * query_.gradient;
    const glm::dvec3 along = query_.offset * query_.wo;
    const double expected = kJump * 2 * query_.offset * steepness;
    return change(step) > expected || change(along) > expected || !(change(step) > 0);
  }

  // Returns a point of the surface beside the hit, at the query's distance along the unit vector `aside` or against
  // it.
  std::optional<glm::dvec3> beside(glm::dvec3 aside) const {
    for (const double way : {kAside, -kAside}) {
      const glm::dvec3 middle = query_.position + way * query_.offset * aside;
      if (const auto found = cross(middle)) return found;
    }
    return std::nullopt;
  }

 private:
  double value(glm::dvec3 point) const {
    std::uint64_t instructions = 0;
    return field_.evaluate(point, scratch_, instructions);
  }
  double change(glm::dvec3 step) const {
    return std::abs(value(query_.position + step) - value(query_.position - step));
  }

  // Returns the place of the change of sign on the line along the ray through `middle`.
  std::optional<glm::dvec3> cross(glm::dvec3 middle) const {
    const double reach = kReachSteps * kAside * query_.offset;
    double near = reach, far = -reach;  // along wo
    const bool near_solid = value(middle + near * query_.wo) < 0;
    if ((value(middle + far * query_.wo) < 0) == near_solid) return std::nullopt;
    for (int i = 0; i < kHalvings; ++i) {
      const double half = (near + far) / 2;
      ((value(middle + half * query_.wo) < 0) == near_solid ? near : far) = half;
    }
    return middle + near * query_.wo;
  }

  const Field& field_;
  const JumpQuery& query_;
  RealScratch& scratch_;
};

}  // namespace

std::optional<glm::dvec3> jump_normal(const Field& field, const JumpQuery& query, RealScratch& scratch) {
  const JumpSearch search(field, query, scratch);
  if (!search.jumps()) return std::nullopt;
  const FrameOf<double> frame(query.wo);
  const auto first = search.beside(frame.x), second = search.beside(frame.y);
  if (!first || !second) return std::nullopt;
  const glm::dvec3 normal = glm::cross(*first - query.position, *second - query.position);
  const double length = glm::length(normal), cosine = glm::dot(normal, query.wo);
  if (!(length > 0) || cosine == 0) return std::nullopt;
  return normal * ((cosine < 0 ? -1 : 1) / length);
}

}  // namespace fathom::runtime
