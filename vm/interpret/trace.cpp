#include "vm/interpret/trace.h"

#include <algorithm>
#include <cmath>

#include "vm/interpret/interpret-inl.h"
#include "vm/interpret/workspace.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
namespace {

float first_lane(const Batch& batch) {
  alignas(64) float lanes[kLanes];
  batch.store(lanes);
  return lanes[0];
}

// The program up to and including an instruction.
struct Prefix {
  std::size_t offset, size;    // offset of the instruction's opcode word; number of words up to its end
  std::size_t values, points;  // heights of the stacks at its end
};

std::vector<Prefix> prefixes_of(const Code& program) {
  std::vector<Prefix> prefixes;
  Prefix prefix{0, 0, 0, 1};
  while (prefix.size < program.size) {
    const std::uint32_t word = program.words[prefix.size];
    const StackEffect effect = effect_of(word);
    prefix.offset = prefix.size;
    prefix.size += instruction_length(word);
    prefix.values += static_cast<std::size_t>(effect.values_change);
    prefix.points += static_cast<std::size_t>(effect.points_change);
    prefixes.push_back(prefix);
  }
  return prefixes;
}

TraceStep step_after(Code program, const Prefix& prefix, glm::dvec3 p, Workspace& workspace) {
  program.size = prefix.size;
  Interpreter<Batch> machine(program, workspace, 1);
  *machine.first_point() = {Batch::broadcast(p.x), Batch::broadcast(p.y), Batch::broadcast(p.z)};
  machine.interpret();
  TraceStep step{prefix.offset, {}, {}};
  for (std::size_t i = 0; i < prefix.points; ++i) {
    const auto& place = machine.first_point()[i * Interpreter<Batch>::kBlock];
    step.points.emplace_back(first_lane(place.x), first_lane(place.y), first_lane(place.z));
  }
  for (std::size_t i = 0; i < prefix.values; ++i) {
    step.values.push_back(first_lane(machine.result()[i * Interpreter<Batch>::kBlock]));
  }
  return step;
}

void trace_prefixes(const Code& program, glm::dvec3 p, const std::function<void(const TraceStep&)>& each) {
  Workspace workspace;
  for (const Prefix& prefix : prefixes_of(program)) each(step_after(program, prefix, p, workspace));
}

bool is_finite(const TraceStep& step) {
  const auto finite = [](const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  return std::all_of(step.points.begin(), step.points.end(), finite) &&
         std::all_of(step.values.begin(), step.values.end(), [](float v) { return std::isfinite(v); });
}

// Bisects: the stacks are finite after the first `lo` instructions, but not after the first `hi`.
std::optional<std::size_t> bisect(const Code& program, glm::dvec3 p) {
  Workspace workspace;
  const std::vector<Prefix> prefixes = prefixes_of(program);
  std::size_t lo = 0, hi = prefixes.size();
  if (hi == 0 || is_finite(step_after(program, prefixes.back(), p, workspace))) return std::nullopt;
  while (hi - lo > 1) {
    const std::size_t middle = (lo + hi) / 2;
    (is_finite(step_after(program, prefixes[middle - 1], p, workspace)) ? lo : hi) = middle;
  }
  return prefixes[lo].offset;
}

}  // namespace
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace fathom::vm {

void trace(const Code& program, glm::dvec3 point, const std::function<void(const TraceStep&)>& each) {
  HWY_NAMESPACE::trace_prefixes(program, point, each);
}

std::optional<std::size_t> first_not_finite(const Code& program, glm::dvec3 point) {
  return HWY_NAMESPACE::bisect(program, point);
}

}  // namespace fathom::vm
