// Output of `fathom render -v` to `-vvvvvv`, and of other verbs up to `-vv`. Each level includes the lower levels:
//
//     1  what the scene compiled to and in what time; camera  4  materials, surfaces
//     2  the compiler's passes and the size after each        5  how often each operation occurs
//     3  instruction set, threads, settings, bounds           6  the listings
//
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <chrono>

#include "compiler/compile.h"
#include "runtime/cli/options/streams.h"
#include "runtime/path/options.h"

namespace fathom::cli {

class Verbosity {
 public:
  Verbosity(int level, const Streams& streams) : level_(level), streams_(streams) {}

  // Returns options for compile() that report each pass. Starts the clock.
  compiler::CompileOptions watch_compiler();
  void describe(const compiler::CompiledScene& scene) const;  // level 1
  void describe(const compiler::CompiledScene& scene, const runtime::Settings& settings) const;

 private:
  int level_;
  const Streams& streams_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace fathom::cli
