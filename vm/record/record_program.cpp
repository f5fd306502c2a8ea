#include "vm/record/record_program.h"

#include "vm/interpret/blocks-inl.h"
#include "vm/number/convexity-inl.h"
#include "vm/number/dual-inl.h"
#include "vm/number/tagged-inl.h"
#include "vm/record/recorded-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
namespace {

using RecordedFloat = Recorded<Batch>;
using RecordedSurface = Tagged<Convex<Dual<RecordedFloat>>>;

std::vector<Ref> refs(const RecordedFloat& distance) { return {distance.ref}; }
std::vector<Ref> refs(const Convex<RecordedFloat>& value) { return {value.v.ref, value.convex.ref}; }
std::vector<Ref> refs(const RecordedSurface& value) {
  const Dual<RecordedFloat>& distance = value.v.v;
  return {distance.v.ref,
          zero_unless_finite(distance.dx).ref,
          zero_unless_finite(distance.dy).ref,
          zero_unless_finite(distance.dz).ref,
          value.v.convex.ref,
          value.surface.ref};
}

template <class T, Immediate kFrom = Immediate::Program>
std::vector<Ref> run_program(const Code& program) {
  Workspace workspace;
  Interpreter<T, kFrom> machine(program, workspace, 1);
  set_point(*machine.first_point(), RecordedFloat::parameter(0), RecordedFloat::parameter(1),
            RecordedFloat::parameter(2));
  machine.interpret();
  return refs(*machine.result());
}

}  // namespace

RecordedFunction record_function(const Code& program, RecordedResults results) {
  RecordedFunction function;
  const Recording recording(function);
  switch (results) {
    case RecordedResults::Distance:
      function.results = run_program<RecordedFloat>(program);
      break;
    case RecordedResults::DistanceAndConvexity:
      function.results = run_program<Convex<RecordedFloat>>(program);
      break;
    case RecordedResults::Surface:
      function.results = run_program<RecordedSurface>(program);
      break;
    case RecordedResults::DistanceOfRow:
      function.results = run_program<RecordedFloat, Immediate::PerLane>(program);
      break;
  }
  return function;
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace fathom::vm {

RecordedFunction record_program(const Code& program, RecordedResults results) {
  return HWY_NAMESPACE::record_function(program, results);
}

}  // namespace fathom::vm
