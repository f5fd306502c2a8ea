// Texts as verbs read them: of a file or of standard input, as far as the limit says, and their names for messages.
// Tested by: tests/runtime/cli/input/cli_files_test.cpp, tests/runtime/cli/input/cli_limits_test.cpp
#pragma once

#include <string>
#include <variant>

#include "compiler/source/limits.h"
#include "runtime/cli/options/streams.h"

namespace fathom::cli {

// The text of a file, or of standard input for "-"; otherwise the reason, for people. No more than the limit
// `file-size` is read, whatever the file.
struct Unreadable {
  std::string reason;
  std::string help = "";
  ExitCode code = kIo;
};
std::variant<std::string, Unreadable> read_text(const std::string& path, const compiler::Limits& limits,
                                                const Streams& streams);
ExitCode fail(const Streams& streams, const std::string& path, const Unreadable& unreadable);

// The file's name for messages: in a sentence, and before the number of a line.
std::string quoted(const std::string& path);
std::string source_name(const std::string& path);

}  // namespace fathom::cli
