#include "compiler/artefact/load.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "vm/interpret/evaluate.h"
#include "vm/program/opcode.h"
#include "vm/range/slope.h"

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
  const bool bounded = known && is_outside_free(field.distance, grown);
  field.bound = bounded ? grown : Box::everything();
  field.contents = bounded ? grown : Box();
  vm::Workspace workspace;
  const Box all = Box::everything();
  const double steepest = vm::evaluate_slope(field.distance, all.lo, all.hi, workspace).lipschitz;
  const bool shown = steepest > 0 && std::isfinite(steepest);
  field.lipschitz = shown ? steepest : std::max(field.lipschitz, 1.0);
  const double error = vm::evaluate_slope(field.distance, field.bound.lo, field.bound.hi, workspace).float_error;
  if (std::isfinite(error)) field.magnitude = std::max(field.magnitude, error / vm::kFloatError);
}

// "... (proved)" becomes what it is here.
std::string as_claimed(std::string summary) {
  constexpr std::string_view kProved = " (proved)";
  for (std::size_t at; (at = summary.find(kProved)) != summary.npos;) summary.erase(at, kProved.size());
  return "not proved, but said by the file: " + summary;
}

}  // namespace

std::variant<StoredScene, FileError> read_stored(std::span<const std::uint8_t> bytes, const std::string& path) {
  auto file = open_file(bytes);
  if (auto* error = std::get_if<FileError>(&file)) return std::move(*error);
  auto scene = read_file(std::get<CompiledFile>(file), path);
  if (auto* error = std::get_if<FileError>(&scene)) return std::move(*error);
  auto& opened = std::get<CompiledFile>(file);
  FileContents contents{!opened.debug.empty(), opened.text.has_value(), std::move(opened.definitions)};
  return StoredScene{std::get<CompiledScene>(std::move(scene)), std::move(contents)};
}

std::variant<StoredText, FileError> read_stored_text(std::span<const std::uint8_t> bytes, const std::string& path) {
  auto opened = open_file(bytes);
  if (auto* error = std::get_if<FileError>(&opened)) return std::move(*error);
  auto& file = std::get<CompiledFile>(opened);
  if (file.text) return StoredText{beside(*file.text, path), std::move(file.definitions)};
  return FileError{"it holds programs without the scene they were compiled from", "compile the scene's own file",
                   true};
}

CompiledScene unproved(CompiledScene stored) {
  distrust(stored);
  for (Medium& medium : stored.media) distrust(medium);
  stored.lamps.clear();
  stored.summary = as_claimed(std::move(stored.summary));
  return stored;
}

}  // namespace fathom::compiler
