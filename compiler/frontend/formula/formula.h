// Formula as a DAG of operations, named after the machine's functions (vm/program/functions.def).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler {

// Function of the machine.
struct FunctionSpec {
  std::string_view name;
  int arity;
};

// DAG: a subexpression that is used twice is one node.
struct Formula {
  struct Node {
    // "const", "x", "y", "z", or a function of the machine: "add", "minus", "multiply", "divide", "negate", "square"
    // and "power" come from operators, the others from calls. The characters live as long as the table of functions.
    std::string_view function;
    double value = 0;  // for "const" only
    std::vector<std::uint32_t> arguments;
    Span span;  // source text that the node comes from
  };
  std::vector<Node> nodes;  // in topological order, arguments first; the last node is the result
};

}  // namespace fathom::compiler
