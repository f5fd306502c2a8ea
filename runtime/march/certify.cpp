#include "runtime/march/certify.h"

namespace fathom::runtime {

Certified certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, const Stretch& stretch,
                  RealScratch& scratch) {
  Search search(field, origin, direction, side, stretch);
  while (!search.done()) {
    std::uint64_t instructions = 0;
    const double f = field.evaluate(search.point(), scratch, instructions);
    search.give(f, instructions, scratch);
  }
  return search.result();
}

}  // namespace fathom::runtime
