// A plane of a picture: one number for each pixel.
#pragma once

#include <vector>

namespace fathom::runtime {

using Plane = std::vector<float>;  // [y][x]

}  // namespace fathom::runtime
