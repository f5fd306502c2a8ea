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

// Whether a program says where its instructions come from, or of which source.
bool has_debug(const vm::VerifiedProgram& program);

// Collects them, in that order.
class ProgramList {
 public:
  ProgramList(std::size_t media, std::size_t formulas) : media_(media), formulas_(formulas) {}

  std::string next() const { return name(programs.size()); }  // the name of the one that is wanted
  bool full() const { return programs.size() == 2 + 2 * media_ + formulas_; }
  void add(vm::VerifiedProgram program) { programs.push_back(std::move(program)); }

  // With nothing but the programs. The list must be full.
  CompiledScene scene() &&;

  std::vector<vm::VerifiedProgram> programs;

 private:
  std::string name(std::size_t index) const;

  std::size_t media_, formulas_;
};

// The first tag that names no surface.
struct TagFault {
  std::size_t program;  // in the order of programs_of()
  std::uint32_t word;
  std::string reason;
};
std::optional<TagFault> check_tags(const CompiledScene& scene);

// As many surfaces as the program's tags name, at least one.
std::size_t surfaces_named(const vm::VerifiedProgram& program);

// What of a stored scene goes beyond the limits: a program, the picture's size, or its samples. A scene that is
// compiled here has been held to them.
std::optional<Excess> excess_of(const CompiledScene& stored, const Limits& limits);

}  // namespace fathom::compiler
