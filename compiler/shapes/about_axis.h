// Bodies about the y axis, for the rows of the domain operators.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "compiler/shapes/node_table.h"

namespace fathom::compiler {

inline constexpr double kNoLimit = 1e18;  // stands for infinity in a program

inline double distance_from_axis(double x, double z) { return std::sqrt(x * x + z * z); }

// Returns the maximum distance of the box from the y axis.
inline double radius_about_y(const Box& box) {
  return distance_from_axis(std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
                            std::max(std::abs(box.lo.z), std::abs(box.hi.z)));
}

// Margin, as a share of the solid's size, of a box or tube whose distance is part of a result. On the solid's surface
// the solid's own distance then counts, and its material.
inline constexpr double kAside = 1e-3;

inline Box tube(double radius, double y0, double y1) { return {{-radius, y0, -radius}, {radius, y1, radius}}; }

inline ErrorText check_bounded_about_y(std::span<const NodeFacts> children, const char* what) {
  if (std::isfinite(radius_about_y(children[0].box))) return std::nullopt;
  return fmt::format("{} needs a node that ends in x and z; cut it with an intersection first", what);
}

}  // namespace fathom::compiler
