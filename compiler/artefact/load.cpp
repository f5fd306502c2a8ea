#include "compiler/artefact/load.h"

#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "vm/evaluate.h"

namespace fathom::compiler {
namespace {

// Whether interval arithmetic shows that the field is not negative in each of the half-spaces outside the box.
bool is_outside_free(const vm::VerifiedProgram& program, const Box& box) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  vm::Workspace workspace;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 lo(-kEndless), hi(kEndless);
    hi[axis] = box.lo[axis];
    const vm::Range below = vm::evaluate_range(program, lo, hi, workspace);
    std::swap(lo[axis], hi[axis]);
    lo[axis] = box.hi[axis];
    hi[axis] = kEndless;
    const vm::Range above = vm::evaluate_range(program, lo, hi, workspace);
    if (!(below.lo >= 0 && above.lo >= 0)) return false;
  }
  return true;
}

void distrust(CompiledField& field) {
  constexpr double kRounding = 1e-12;  // of the intervals, per unit of the box
  field.certified = false;
  const bool known = field.bound.finite() && !field.bound.empty();
  const Box grown = field.bound.grown(known ? kRounding * glm::length(field.bound.hi - field.bound.lo) : 0);
  field.bound = known && is_outside_free(field.distance, grown) ? grown : Box::everything();
}

}  // namespace

std::variant<StoredScene, FileError> read_stored(std::span<const std::uint8_t> bytes, const std::string& path) {
  auto file = open_file(bytes);
  if (auto* error = std::get_if<FileError>(&file)) return std::move(*error);
  auto scene = read_file(std::get<CompiledFile>(file), path);
  if (auto* error = std::get_if<FileError>(&scene)) return std::move(*error);
  return StoredScene{std::get<CompiledScene>(std::move(scene)), std::get<CompiledFile>(file).text.has_value(),
                     std::get<CompiledFile>(file).definitions};
}

std::variant<StoredText, FileError> read_stored_text(std::span<const std::uint8_t> bytes, const std::string& path) {
  auto opened = open_file(bytes);
  if (auto* error = std::get_if<FileError>(&opened)) return std::move(*error);
  auto& file = std::get<CompiledFile>(opened);
  if (file.text) return StoredText{beside(*file.text, path), std::move(file.definitions)};
  return FileError{"it holds programs without the scene they were compiled from", "compile the scene's own file"};
}

CompiledScene unproved(CompiledScene stored) {
  distrust(stored);
  for (Medium& medium : stored.media) distrust(medium);
  stored.lamps.clear();
  stored.summary += " (as its file says; not proved)";
  return stored;
}

}  // namespace fathom::compiler
