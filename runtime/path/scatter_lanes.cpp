// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/path/scatter_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/path/scatter_lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "runtime/sampling/warp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

HWY_INLINE Vectors load(const VertexRows3<float>& rows, std::size_t i) {
  return {Floats::load(&rows.x[i]), Floats::load(&rows.y[i]), Floats::load(&rows.z[i])};
}
HWY_INLINE void store(Vectors v, VertexRows3<float>& rows, std::size_t i) {
  v.x.store(&rows.x[i]);
  v.y.store(&rows.y[i]);
  v.z.store(&rows.z[i]);
}

void sample_diffuse_lanes(VertexBatch& batch) {
  for (std::size_t i = 0; i < batch.count; i += vm::HWY_NAMESPACE::kLanes) {
    const Vectors normal = load(batch.normal, i);
    const Vectors local = square_to_cosine_hemisphere(Floats::load(&batch.u[i]), Floats::load(&batch.v[i]));
    const Vectors wi = to_frame(normal, local);
    const Floats cosine = dot(wi, normal);
    store(wi, batch.wi, i);
    store(load(batch.albedo, i), batch.weight, i);
    select(cosine > number(0), cosine * number(kInversePi), number(0)).store(&batch.pdf[i]);
  }
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(sample_diffuse_lanes);

void sample_diffuse(VertexBatch& batch) { HWY_DYNAMIC_DISPATCH(sample_diffuse_lanes)(batch); }

}  // namespace fathom::runtime
#endif  // HWY_ONCE
