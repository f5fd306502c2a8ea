#include "runtime/slice/slice_frame.h"

#include <algorithm>
#include <cmath>

namespace fathom::runtime {
namespace {

// Scene axes of a slice: of its first and of its second coordinate. `left` and `down` are true if the image's right
// and up are their negative directions.
struct View {
  int first, second;
  bool left, down;
};

View view_of(Axis axis) {
  if (axis == Axis::X) return {2, 1, true, false};
  if (axis == Axis::Y) return {0, 2, false, true};
  return {0, 1, false, false};
}

constexpr double kWithoutEnd = 2;  // scene units; where an infinite side ends

// Makes the interval finite, not empty, and a tenth longer than [lo, hi].
void frame_side(double& lo, double& hi) {
  if (!(lo <= hi)) lo = -kWithoutEnd, hi = kWithoutEnd;
  if (!std::isfinite(lo)) lo = std::min(-kWithoutEnd, std::isfinite(hi) ? hi - 2 * kWithoutEnd : 0);
  if (!std::isfinite(hi)) hi = std::max(kWithoutEnd, lo + 2 * kWithoutEnd);
  const double margin = 0.05 * (hi - lo);
  lo -= margin;
  hi += margin;
}

void widen(double& lo, double& hi, double length) {
  const double margin = 0.5 * std::max(0.0, length - (hi - lo));
  lo -= margin;
  hi += margin;
}

}  // namespace

glm::dvec3 Slice::point(int column, int row) const {
  const View view = view_of(axis);
  double across = (column + 0.5) / width, up = (height - row - 0.5) / height;
  if (view.left) across = (width - column - 0.5) / width;
  if (view.down) up = (row + 0.5) / height;
  glm::dvec3 point;
  point[static_cast<int>(axis)] = at;
  point[view.first] = lo.x + across * (hi.x - lo.x);
  point[view.second] = lo.y + up * (hi.y - lo.y);
  return point;
}

glm::dvec2 on_plane(Axis axis, glm::dvec3 point) {
  const View view = view_of(axis);
  return {point[view.first], point[view.second]};
}

Slice frame_slice(const compiler::Box& box, Axis axis, double at, int width, int height) {
  Slice slice{axis, at, on_plane(axis, box.lo), on_plane(axis, box.hi), width, height};
  frame_side(slice.lo.x, slice.hi.x);
  frame_side(slice.lo.y, slice.hi.y);
  double pixel = std::max((slice.hi.x - slice.lo.x) / width, (slice.hi.y - slice.lo.y) / height);
  if (!(pixel > 0)) pixel = 2 * kWithoutEnd / std::max(width, height);  // a solid without extent
  widen(slice.lo.x, slice.hi.x, pixel * width);
  widen(slice.lo.y, slice.hi.y, pixel * height);
  return slice;
}

}  // namespace fathom::runtime
