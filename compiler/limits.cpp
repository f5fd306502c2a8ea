#include "compiler/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::compiler {

std::string raise(double Limits::*value, double needed) {
  const LimitRow& row = limit_row(value);
  if (needed > row.largest) return fmt::format("{} {} are the most that can be: {}", row.largest, row.unit, row.why);
  // A number that is easily read: the next of two digits.
  const double step = std::pow(10, std::max(0.0, std::floor(std::log10(needed)) - 1));
  const double enough = std::min(row.largest, std::ceil(needed / step) * step);
  return fmt::format("`--limit {}={}` allows more", row.name, enough);
}

}  // namespace fathom::compiler
