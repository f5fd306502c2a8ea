// The programs of a compiled scene in one order, and a scene made of programs read in that order.
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

struct NamedProgram {
  std::string name;  // "distance", "surface", "medium 0 distance", "medium 0 surface", ..., "formula 0", ...
  const vm::VerifiedProgram* program;
};

std::vector<NamedProgram> programs_of(const CompiledScene& scene);

// True if a program has names or places of its instructions, or the name of its source.
bool has_debug(const vm::VerifiedProgram& program);

// Collects the programs of a scene in that order.
class ProgramList {
 public:
  ProgramList(std::size_t media, std::size_t formulas) : media_(media), formulas_(formulas) {}

  std::string next() const { return name(programs.size()); }  // the name of the program to be added next
  bool full() const { return programs.size() == 2 + 2 * media_ + formulas_; }
  void add(vm::VerifiedProgram program) { programs.push_back(std::move(program)); }

  // Returns a scene that has only the programs. The list must be full.
  CompiledScene scene() &&;

  std::vector<vm::VerifiedProgram> programs;

 private:
  std::string name(std::size_t index) const;

  std::size_t media_, formulas_;
};

// The first tag without a surface.
struct TagFault {
  std::size_t program;  // in the order of programs_of()
  std::uint32_t word;
  std::string reason;
};
std::optional<TagFault> check_tags(const CompiledScene& scene);

// Returns the number of surfaces that the program's tags need, at least 1.
std::size_t surfaces_named(const vm::VerifiedProgram& program);

// Returns what exceeds the limits: a program, the image's size or the number of samples. compile() applies the limits
// itself.
std::optional<Excess> excess_of(const CompiledScene& stored, const Limits& limits);

}  // namespace fathom::compiler
