// A plane of an image: one number per pixel.
#pragma once

#include <vector>

namespace fathom::runtime {

using Plane = std::vector<float>;  // [y][x]

}  // namespace fathom::runtime
