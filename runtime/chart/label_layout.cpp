#include "runtime/chart/label_layout.h"

#include <algorithm>

namespace fathom::runtime {
namespace {

// Directions from the point to its label, y downwards, best first: labels read best to the upper right.
constexpr glm::dvec2 kDirections[] = {{1, -1}, {1, 0}, {0, -1}, {-1, -1}, {1, 1}, {-1, 0}, {-1, 1}, {0, 1}};

Rectangle beside(glm::dvec2 point, glm::dvec2 direction, double clearance, glm::dvec2 size) {
  // 0.71 = 1/sqrt(2): a label at a corner is as far from the point as one at a side.
  const double away = clearance * (direction.x != 0 && direction.y != 0 ? 0.71 : 1);
  const glm::dvec2 middle = point + direction * (away + 0.5 * size);
  return {middle - 0.5 * size, middle + 0.5 * size};
}

}  // namespace

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.lo.x < b.hi.x && b.lo.x < a.hi.x && a.lo.y < b.hi.y && b.lo.y < a.hi.y;
}

// Clips the segment to the rectangle, one axis at a time (Y.-D. Liang, B. Barsky, "A New Concept and Method for Line
// Clipping", 1984).
bool meets_segment(const Rectangle& rectangle, glm::dvec2 from, glm::dvec2 to) {
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = to[axis] - from[axis];
    const double lo = rectangle.lo[axis] - from[axis], hi = rectangle.hi[axis] - from[axis];
    if (step == 0) {
      if (lo > 0 || hi < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(lo / step, hi / step));
    leave = std::min(leave, std::max(lo / step, hi / step));
  }
  return enter <= leave;
}

bool LabelLayout::is_free(const Rectangle& area, bool over_segments) const {
  if (area.lo.x < bounds_.lo.x || area.lo.y < bounds_.lo.y) return false;
  if (area.hi.x > bounds_.hi.x || area.hi.y > bounds_.hi.y) return false;
  for (const Rectangle& blocked : blocked_) {
    if (overlap(area, blocked)) return false;
  }
  if (over_segments) return true;
  return std::none_of(segments_.begin(), segments_.end(),
                      [&](const Segment& segment) { return meets_segment(area, segment.from, segment.to); });
}

std::optional<Rectangle> LabelLayout::place(glm::dvec2 point, double clearance, glm::dvec2 size, bool important) {
  for (const bool over_segments : {false, true}) {
    if (over_segments && !important) break;
    for (const glm::dvec2 direction : kDirections) {
      const Rectangle area = beside(point, direction, clearance, size);
      if (!is_free(area, over_segments)) continue;
      block(area);
      return area;
    }
  }
  return std::nullopt;
}

}  // namespace fathom::runtime
