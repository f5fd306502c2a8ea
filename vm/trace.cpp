#include "vm/trace.h"

#include "vm/evaluate.h"
#include "vm/interpret-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
namespace {

float first_lane(const Batch& batch) {
  alignas(64) float lanes[kLanes];
  batch.store(lanes);
  return lanes[0];
}

void trace_prefixes(Code program, glm::dvec3 p, const std::function<void(const TraceStep&)>& each) {
  Workspace workspace;
  const std::size_t size = program.size;
  std::size_t values = 0, points = 1;
  for (std::size_t at = 0; at < size;) {
    const StackEffect effect = effect_of(program.words[at]);
    const std::size_t offset = at;
    at += instruction_length(program.words[at]);
    values += static_cast<std::size_t>(effect.values_change);
    points += static_cast<std::size_t>(effect.points_change);
    program.size = at;
    Machine<Batch> machine(program, workspace, 1);
    *machine.first_point() = {Batch::broadcast(p.x), Batch::broadcast(p.y), Batch::broadcast(p.z)};
    machine.interpret();
    TraceStep step{offset, {}, {}};
    for (std::size_t i = 0; i < points; ++i) {
      const auto& place = machine.first_point()[i * Machine<Batch>::kBlock];
      step.points.emplace_back(first_lane(place.x), first_lane(place.y), first_lane(place.z));
    }
    for (std::size_t i = 0; i < values; ++i) {
      step.values.push_back(first_lane(machine.result()[i * Machine<Batch>::kBlock]));
    }
    each(step);
  }
}

}  // namespace
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace fathom::vm {

void trace(const Code& program, glm::dvec3 point, const std::function<void(const TraceStep&)>& each) {
  HWY_NAMESPACE::trace_prefixes(program, point, each);
}

}  // namespace fathom::vm
