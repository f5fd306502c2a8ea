// The evaluator of many points in double. Compiled for the instruction sets whose registers hold four doubles or
// more; on others, one point at a time is as fast. FATHOM_TARGET as in vm/interpret/evaluate.cpp.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vm/interpret/evaluate_real_batch.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "vm/interpret/evaluate.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
void real_distances(const Code& program, RealPoints points, std::size_t count, double* distance, Workspace& workspace);
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_TARGET == FATHOM_TARGET
#include "vm/interpret/blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

void real_distances(const Code& program, RealPoints points, std::size_t count, double* distance,
                    Workspace& workspace) {
#if HWY_TARGET == HWY_STATIC_TARGET
  for (std::size_t i = 0; i < count; ++i) {
    distance[i] = evaluate_distance(program, glm::dvec3(points.x[i], points.y[i], points.z[i]), workspace);
  }
#else
  for_each_block<RealBatch>(
      program, points, count, workspace,
      [&](std::size_t begin, std::size_t size, std::size_t used, const RealBatch* result)
          HWY_ATTR { store(size, used, distance + begin, [&](std::size_t i) HWY_ATTR { return result[i]; }); });
#endif
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE && FATHOM_TARGET == 0
namespace fathom::vm {

HWY_EXPORT(real_distances);

void evaluate_distance(const Code& program, RealPoints points, std::size_t count, double* distance,
                       Workspace& workspace) {
  HWY_DYNAMIC_DISPATCH(real_distances)(program, points, count, distance, workspace);
}

}  // namespace fathom::vm
#endif
