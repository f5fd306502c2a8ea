// Where a verb reads and writes: `out` is for data, `err` for people. Also the form of every message that is not
// about a place in a scene file:
//
//     error: unknown option `--sppp`
//       = help: did you mean `--spp`?
//
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cli/options/exit_code.h"

namespace fathom::cli {

struct OptionTable;

struct Streams {
  std::istream& in;
  std::ostream& out;
  std::ostream& err;
  bool terminal = false;           // a person watches `err`: progress may redraw its line
  bool color = false;              // `err` understands colours and NO_COLOR does not forbid them
  bool out_terminal = false;       // `out` is a terminal, which shows no pictures
  int columns = 80;                // of the terminal that help is printed on
  OptionTable* options = nullptr;  // when set, a verb puts its options there and does nothing else
  // What every verb knows, set by Arguments: -q, and how often -v was given to a verb that has no -v of its own.
  mutable bool quiet = false;
  mutable int verbosity = 0;
};

using Help = std::vector<std::string>;  // each a line after "= help:"

// Prints the message and returns `code`, so that a verb can end with `return fail(...)`.
ExitCode fail(const Streams& streams, ExitCode code, std::string_view message, const Help& help = {});

// Text to standard output, in which names of scenes may be: controls of a terminal as \u0085, what is no UTF-8 as
// U+FFFD. JSON keeps its meaning.
void print(const Streams& streams, std::string_view text);

// A line about what was done, not printed with -q.
void say(const Streams& streams, std::string_view message);
void note(const Streams& streams, std::string_view message);
void warn(const Streams& streams, std::string_view message);

// "1 error", "2 errors".
std::string count_of(std::size_t count, std::string_view noun);

}  // namespace fathom::cli
