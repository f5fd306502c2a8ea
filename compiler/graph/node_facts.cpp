#include "compiler/graph/node_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::compiler {

std::string_view name(Exactness exactness) {
  switch (exactness) {
    case Exactness::Exact:
      return "exact";
    case Exactness::Bound:
      return "a lower bound";
    default:
      return "an estimate";
  }
}

std::string describe(const Box& box) {
  // Prints four digits, and more for a side that is far from zero compared with its length.
  const auto side = [](double lo, double hi) {
    int digits = 4;
    for (double ratio = std::max(std::abs(lo), std::abs(hi)) / (hi - lo); ratio >= 100 && digits < 17; ratio /= 10) {
      ++digits;
    }
    return fmt::format("[{:.{}g},{:.{}g}]", lo, digits, hi, digits);
  };
  if (box.empty()) return "empty";
  return side(box.lo.x, box.hi.x) + "x" + side(box.lo.y, box.hi.y) + "x" + side(box.lo.z, box.hi.z);
}

std::string describe(const NodeFacts& k, bool in_cells) {
  if (in_cells) return fmt::format("bound {}, proved cell by cell", describe(k.box));
  return fmt::format("bound {}, {} outside, Lipschitz <= {:.4g} ({})", describe(k.box), name(k.outside), k.lipschitz,
                     k.certified ? "proved" : "estimate");
}

}  // namespace fathom::compiler
