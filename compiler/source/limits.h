// Limits on the size of scenes, in one table that `--limit NAME=VALUE`, `fathom help limits`,
// docs/reference/limits.md and the tests read. Code that enforces a limit takes the Limits and reports where the
// scene exceeds the limit, by how much, and how to allow it (`raise()`). Tested by:
// tests/compiler/source/limits_test.cpp, tests/runtime/cli/input/cli_limits_test.cpp, tests/hostile
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace fathom::vm {
struct Limits;
class VerifiedProgram;
}  // namespace fathom::vm

namespace fathom::compiler {

// Values in the units of the table below. All except `coordinate` are whole numbers.
struct Limits {
  double file_size = 32 << 20;
  double tokens = 4e6;
  double nesting = 4096;
  double formula_nesting = 1000;
  double steps = 1e7;
  double nodes = 1e6;
  double made_nodes = 120000;
  double copies = 512;
  double iterations = 256;
  double instructions = 1e6;
  double media = 1e6;
  double stack = 4096;
  double locals = 65536;
  double coordinate = 1e18;
  double image_side = 65535;
  double pixels = 1 << 28;
  double samples = 1 << 20;
  double memory = 0;  // 0: three quarters of the memory that the process may use
};

struct LimitRow {
  std::string_view name;
  double Limits::*value;
  double largest;  // maximum that the limit can be set to; the minimum is 1
  std::string_view unit;
  std::string_view bounds;
  std::string_view why;  // reason for `largest`
};

inline constexpr double kAnySize = 1e15;

// Bytes of memory per node of the graph, from its text to its programs: 200,000 balls of two nodes each take 1,600
// per node, and 1,700 where regions are built.
inline constexpr double kBytesPerNode = 1800;

inline constexpr std::array<LimitRow, 18> kLimits = {{
    {"file-size", &Limits::file_size, 1 << 30, "bytes", "a scene, a listing, a list of points",
     "places in a text have 32 bits"},
    {"tokens", &Limits::tokens, 1 << 30, "values and names", "a scene's text", "places in a text have 32 bits"},
    {"nesting", &Limits::nesting, 4096, "levels", "lists and objects within each other", "the stack's size"},
    {"formula-nesting", &Limits::formula_nesting, 1000, "levels", "parentheses and signs within each other",
     "the stack's size"},
    {"steps", &Limits::steps, kAnySize, "expressions", "the evaluation of a text's functions and loops",
     "no machine has the time"},
    {"nodes", &Limits::nodes, 1e9, "nodes",
     "the graph before it is optimised, each node in every object that paints it anew",
     "nodes are numbered in 32 bits"},
    {"made-nodes", &Limits::made_nodes, 1e9, "nodes",
     "what a text's functions and loops make, or one for each word of the text", "nodes are numbered in 32 bits"},
    {"copies", &Limits::copies, 512, "copies", "evaluations of its node for each point, of each repetition",
     "the program of one node"},
    {"iterations", &Limits::iterations, 256, "iterations", "a fractal's loop, and its power",
     "the opcodes that loop"},
    {"instructions", &Limits::instructions, 16e6, "instructions", "a program", "places in a program have 24 bits"},
    {"media", &Limits::media, 1e9, "nodes", "the solids of all transparent materials together, and their programs",
     "nodes are numbered in 32 bits"},
    {"stack", &Limits::stack, 65536, "values", "either stack of the machine", "the machine's scratch memory"},
    {"locals", &Limits::locals, 262143, "values", "what a program remembers for later uses",
     "operands that name one have 18 bits"},
    {"coordinate", &Limits::coordinate, 1e18, "scene units", "every number of a scene's geometry, in magnitude",
     "squares of floats end at 1e38"},
    {"image-side", &Limits::image_side, 65535, "pixels", "a picture's width and height",
     "what image formats can say"},
    {"pixels", &Limits::pixels, 1 << 28, "pixels", "a picture", "films and pictures of floats hold no more"},
    {"samples", &Limits::samples, 1 << 20, "samples a pixel", "a render", "samples are numbered in 20 bits"},
    {"memory", &Limits::memory, kAnySize, "bytes",
     "compiling a scene; a render's film and regions; the sum of a merge; each picture and film that is read",
     "no machine has more"},
}};

constexpr const LimitRow* find_limit(std::string_view name) {
  for (const LimitRow& row : kLimits) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

// Returns the table's row of a field.
constexpr const LimitRow& limit_row(double Limits::*value) {
  for (const LimitRow& row : kLimits) {
    if (row.value == value) return row;
  }
  return kLimits.front();
}

// Returns a line of help on how to allow `needed`: "--limit nodes=2000000 allows more", or why nothing allows it.
std::string raise(double Limits::*value, double needed);

// Returns the maxima of the table as limits of the machine. Files are read and programs compiled within these limits.
// excess_of() then reports the excess over the user's limits.
vm::Limits largest_machine();

// A size beyond the user's limits, and how to allow it.
struct Excess {
  std::string what, remedy;
};
// Checks a program that largest_machine() allows. Returns nullopt if the program is within the limits.
std::optional<Excess> excess_of(const vm::VerifiedProgram& program, const Limits& limits);

// Checks a graph of `nodes` nodes in the same way.
std::optional<Excess> excess_of(double nodes, const Limits& limits);

}  // namespace fathom::compiler
