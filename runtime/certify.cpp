#include "runtime/certify.h"

namespace fathom::runtime {

Certified certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, const Stretch& stretch,
                  vm::Workspace& workspace) {
  Search search(field, origin, direction, side, stretch);
  while (!search.done()) {
    std::uint64_t instructions = 0;
    const double f = field.evaluate(search.point(), workspace, instructions);
    search.give(f, instructions, workspace);
  }
  return search.result();
}

}  // namespace fathom::runtime
