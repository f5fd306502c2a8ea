// A formula as a graph of operations, in the names of the machine's functions (vm/program/opcodes.def).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "compiler/source/source.h"

namespace fathom::compiler {

// A function of the machine.
struct FunctionSpec {
  std::string_view name;
  int arity;
};

// A directed acyclic graph: what is used twice is one node.
struct Formula {
  struct Node {
    // "const", "x", "y", "z", or a function of the machine: "add", "minus", "multiply", "divide", "negate", "square",
    // "power" from operators, the others from calls. Lives as long as the table of functions does.
    std::string_view function;
    double value = 0;  // of a "const"
    std::vector<std::uint32_t> arguments;
    Span span;  // what it was made of
  };
  std::vector<Node> nodes;  // arguments before what they are arguments of; the last is the result
};

}  // namespace fathom::compiler
