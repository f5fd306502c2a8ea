// A verb's input and output streams: `out` is for data, `err` for people. Also prints all messages that are not about
// a place in a scene file, in this form:
//
//     error: unknown option `--sppp`
//       = help: did you mean `--spp`?
//
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cli/options/exit_code.h"

namespace fathom::cli {

struct OptionTable;

// The files that a command reads and writes. No file may be both read and written, or written by two outputs.
// Tested by: tests/runtime/cli/cli_overwriting_test.cpp
class UsedFiles {
 public:
  // A file is known by its canonical path, whether or not it exists.
  void add_input(const std::string& path) { add(path, Use::Input); }
  void add_output(const std::string& path) { add(path, Use::Output); }
  // Returns the first file added that is already an output, or, if it is an output itself, already an input.
  const std::optional<std::string>& conflict() const { return conflict_; }

 private:
  enum class Use { Input, Output };
  void add(const std::string& path, Use use);

  std::map<std::filesystem::path, Use> uses_;
  std::optional<std::string> conflict_;
};

struct Streams {
  std::istream& in;
  std::ostream& out;
  std::ostream& err;
  bool terminal = false;           // `err` is a terminal: progress may redraw its line
  bool color = false;              // `err` understands colours and NO_COLOR does not forbid them
  bool out_terminal = false;       // `out` is a terminal, which cannot show images
  int columns = 80;                // width for wrapped help
  OptionTable* options = nullptr;  // when set, a verb stores its options there and does nothing else
  // Options common to all verbs, set by Arguments: -q, and the count of -v for verbs without a -v of their own.
  mutable bool quiet = false;
  mutable int verbosity = 0;
  mutable UsedFiles files = {};
  bool shows_steps = false;  // `err` is read while the verb works, not kept for later
};

using Help = std::vector<std::string>;  // each string is one "= help:" line

// Prints the message and returns `code`, so that a verb can end with `return fail(...)`.
ExitCode fail(const Streams& streams, ExitCode code, std::string_view message, const Help& help = {});

// Prints text that may contain names from scenes to standard output. Terminal control characters become escapes such
// as \u0085, and invalid UTF-8 becomes U+FFFD. JSON keeps its meaning.
void print(const Streams& streams, std::string_view text);

// Prints a line about completed work, unless -q is given.
void say(const Streams& streams, std::string_view message);
void note(const Streams& streams, std::string_view message);
void warn(const Streams& streams, std::string_view message);

// Formats a count: "1 error", "2 errors".
std::string count_of(std::size_t count, std::string_view noun);

}  // namespace fathom::cli
