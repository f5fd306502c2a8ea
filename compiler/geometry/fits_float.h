// Range check for the machine's immediates.
#pragma once

#include <cmath>

namespace fathom::compiler {

// True if the number rounds to a finite float.
inline bool fits_float(double value) { return std::isfinite(static_cast<float>(value)); }

}  // namespace fathom::compiler
