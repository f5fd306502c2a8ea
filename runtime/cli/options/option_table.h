// The options of a verb as data. The help, the completion scripts and the manual page are made of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fathom::cli {

struct OptionRow {
  std::string names;  // "-o,--output"; of a positional argument its name
  std::string value;  // what stands for the value in the help: "FILE"; empty for a flag
  std::string doc;
  std::string group;               // the heading it stands under
  std::vector<std::string> words;  // the only values it takes; empty: others, too
  bool required = true;            // of a positional argument
  bool repeated = false;           // of a positional argument: one or more
};

struct OptionTable {
  std::string verb, description;
  std::string examples;  // a line each: "command   # comment"; after an empty line paragraphs of prose
  std::vector<OptionRow> positionals, options;
};

// "-o,--output" as "-o" and "--output".
std::vector<std::string> names_of(const OptionRow& option);

// Whether the value is the name of a file, or of a folder.
bool takes_file(const OptionRow& option);

}  // namespace fathom::cli
