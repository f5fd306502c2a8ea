#include "compiler/shapes/node_spec.h"

namespace fathom::compiler {

std::vector<double> NodeSpec::with_derived(Params given, std::span<const NodeFacts> children) const {
  std::vector<double> all(given.begin(), given.end());
  if (!derive) return all;
  const std::vector<double> derived = derive(given, children);
  all.insert(all.end(), derived.begin(), derived.end());
  return all;
}

}  // namespace fathom::compiler
