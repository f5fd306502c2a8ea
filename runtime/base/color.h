// The brightness of a colour.
#pragma once

#include <algorithm>
#include <glm/vec3.hpp>

namespace fathom::runtime {

// Returns the Y of CIE XYZ. Source: IEC 61966-2-1:1999.
inline float luminance(glm::vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

inline float max_component(glm::vec3 c) { return std::max({c.x, c.y, c.z}); }

}  // namespace fathom::runtime
