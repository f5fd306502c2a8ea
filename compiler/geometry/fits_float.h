// What the machine's immediates can be.
#pragma once

#include <cmath>

namespace fathom::compiler {

// Whether the number rounds to a finite float.
inline bool fits_float(double value) { return std::isfinite(static_cast<float>(value)); }

}  // namespace fathom::compiler
