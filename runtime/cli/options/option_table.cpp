#include "runtime/cli/options/option_table.h"

#include <sstream>

namespace fathom::cli {

std::vector<std::string> names_of(const OptionRow& option) {
  std::vector<std::string> names;
  std::istringstream list(option.names);
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  return names;
}

bool takes_file(const OptionRow& option) { return option.value == "FILE" || option.value == "FOLDER"; }

}  // namespace fathom::cli
