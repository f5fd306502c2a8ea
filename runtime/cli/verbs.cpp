#include "runtime/cli/verbs.h"

#include <algorithm>
#include <sstream>

namespace fathom::cli {

OptionTable option_table(std::string_view name) {
  const auto verb = std::find_if(kVerbs.begin(), kVerbs.end(), [&](const Verb& each) { return each.name == name; });
  std::istringstream nothing;
  std::ostringstream unused;
  OptionTable table;
  Streams streams{nothing, unused, unused};
  streams.options = &table;
  verb->run({}, streams);
  return table;
}

}  // namespace fathom::cli
