// Difference that each pass of the compiler makes, for `fathom dump --diff`:
//
//     ; pass fold: 14 -> 9 nodes, 21 -> 13 ops, cost 95 -> 61
//     --- strip
//     +++ fold
//     @@ -1,3 +1,2 @@
//     ...
//
// The graphs are printed with names by place (compiler/shapes/print_graph.h), so that a node keeps its name when
// other nodes vanish.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/compile.h"

namespace fathom::compiler {

class PassDiff {
 public:
  explicit PassDiff(const Source& source) : source_(source) {}

  // Call after each pass and before the first, from CompileOptions::on_pass.
  void add(std::string_view pass, const Scene& scene);

  // Call last, with the fused program of the last graph.
  void add_fused(const vm::VerifiedProgram& program);

  // Returns one section per pass that changed something.
  std::string text() const;

 private:
  const Source& source_;
  std::string last_pass_, last_graph_, text_;
  std::optional<GraphSize> last_size_;
};

}  // namespace fathom::compiler
