// Runs a command line of the program: finds the verb and runs it. Implements `help`, `--help` and `--version` itself.
// Leaves the process as it was, so that tests run one command line after the other.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <span>
#include <string>

#include "runtime/cli/options/streams.h"

namespace fathom::cli {

// Takes the arguments after the program's name. Returns an ExitCode: exceptions become messages, and so does output
// that does not reach `streams.out`.
int run(std::span<const std::string> args, const Streams& streams);

}  // namespace fathom::cli
