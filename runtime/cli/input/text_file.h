// Reads texts from files or standard input up to the limit of size, and names them in messages.
// Tested by: tests/runtime/cli/input/cli_files_test.cpp, tests/runtime/cli/input/cli_limits_test.cpp
#pragma once

#include <string>
#include <variant>

#include "compiler/source/limits.h"
#include "runtime/cli/options/streams.h"

namespace fathom::cli {

// Returns the text of a file, or of standard input for "-", or the reason why it cannot be read. Reads no more than
// the limit `file-size`, whatever the kind of file.
struct ReadError {
  std::string reason;
  std::string help = "";
  ExitCode code = kIo;
};
std::variant<std::string, ReadError> read_text(const std::string& path, const compiler::Limits& limits,
                                               const Streams& streams);
ExitCode fail(const Streams& streams, const std::string& path, const ReadError& read_error);

// Name of the file for messages: quoted() within a sentence, source_name() before a line number.
std::string quoted(const std::string& path);
std::string source_name(const std::string& path);

}  // namespace fathom::cli
