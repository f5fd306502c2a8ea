// The evaluator of f32 ranges over boxes. FATHOM_TARGET as in vm/interpret/evaluate.cpp.
#include "vm/range/enclose.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vm/range/enclose.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
void enclose_boxes(const Code& program, const Boxes& boxes, float* lo, float* hi, ChoiceBounds* choices,
                   Workspace& workspace);
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_TARGET == FATHOM_TARGET
#include "vm/range/enclosed-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Returns a coordinate's range. Points are finite, so infinite bounds are clamped to the largest float.
HWY_INLINE FloatInterval coordinate(const Boxes& boxes, std::size_t axis, std::size_t at) {
  return {max(-largest(), Batch::load(boxes.lo[axis] + at)), min(largest(), Batch::load(boxes.hi[axis] + at))};
}

void enclose_boxes(const Code& program, const Boxes& boxes, float* lo, float* hi, ChoiceBounds* choices,
                   Workspace& workspace) {
  constexpr std::size_t kSize = kSlot<FloatInterval>;
  Interpreter<FloatInterval> machine(program, workspace, kSize);
  machine.observer().bounds = choices;
  for (std::size_t i = 0; i < kSize; ++i) {
    const std::size_t at = i * kLanes;
    machine.first_point()[i] = PointTraits<FloatInterval>::place(
        {coordinate(boxes, 0, at), coordinate(boxes, 1, at), coordinate(boxes, 2, at)});
  }
  machine.interpret();
  for (std::size_t i = 0; i < kSize; ++i) {
    machine.result()[i].lo.store(lo + i * kLanes);
    machine.result()[i].hi.store(hi + i * kLanes);
  }
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE && FATHOM_TARGET == 0
namespace fathom::vm {

HWY_EXPORT(enclose_boxes);

void enclose(const Code& program, const Boxes& boxes, float* lo, float* hi, std::vector<ChoiceBounds>& choices,
             Workspace& workspace) {
  choices.resize(program.choices);
  HWY_DYNAMIC_DISPATCH(enclose_boxes)(program, boxes, lo, hi, choices.data(), workspace);
}

}  // namespace fathom::vm
#endif
