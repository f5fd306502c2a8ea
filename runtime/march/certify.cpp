#include "runtime/march/certify.h"

namespace fathom::runtime {

CertifiedResult certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side,
                        const RayInterval& interval, RealScratch& scratch) {
  CertifiedSearch search(field, origin, direction, side, interval);
  while (!search.done()) {
    std::uint64_t instructions = 0;
    const double f = field.evaluate(search.point(), scratch, instructions);
    search.supply(f, instructions, scratch);
  }
  return search.result();
}

}  // namespace fathom::runtime
