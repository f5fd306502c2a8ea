#include "runtime/cli/option_table.h"

#include <algorithm>
#include <sstream>

#include "runtime/cli/verbs.h"

namespace fathom::cli {

std::vector<std::string> names_of(const OptionRow& option) {
  std::vector<std::string> names;
  std::istringstream list(option.names);
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  return names;
}

bool takes_file(const OptionRow& option) { return option.value == "FILE" || option.value == "FOLDER"; }

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
