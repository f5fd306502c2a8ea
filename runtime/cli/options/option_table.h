// A verb's options as data, from which the help, the completion scripts and the manual page are generated.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fathom::cli {

struct OptionRow {
  std::string names;  // "-o,--output"; a positional argument's name
  std::string value;  // placeholder of the value in the help, "FILE"; empty for a flag
  std::string doc;
  std::string group;               // heading above the option
  std::vector<std::string> words;  // the valid values; empty: not restricted to a list
  bool required = true;            // positional arguments only
  bool repeated = false;           // positional arguments only: accepts several values
};

struct OptionTable {
  std::string verb, description;
  // One line per example, "command   # comment". After an empty line: paragraphs of prose.
  std::string examples;
  std::vector<OptionRow> positionals, options;
};

// Splits the names: "-o,--output" into "-o" and "--output".
std::vector<std::string> names_of(const OptionRow& option);

// True if the value names a file or a folder.
bool takes_file(const OptionRow& option);

}  // namespace fathom::cli
