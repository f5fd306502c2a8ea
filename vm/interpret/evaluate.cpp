// The f32 evaluators.
// Compiled once per instruction set, which FATHOM_TARGET names, and once with FATHOM_TARGET=0 for the dispatch at run
// time.
#include "vm/interpret/evaluate.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vm/interpret/evaluate.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
void distance_batch(const Code& program, Points points, std::size_t count, float* distance, Workspace& workspace);
void convex_batch(const Code& program, Points points, std::size_t count, float* distance, float* convex,
                  Workspace& workspace);
void surface_batch(const Code& program, Points points, std::size_t count, SurfaceValues out, Workspace& workspace);
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_TARGET == FATHOM_TARGET
#include "vm/interpret/blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

void distance_batch(const Code& program, Points points, std::size_t count, float* distance, Workspace& workspace) {
  for_each_block<Batch>(program, points, count, workspace,
                        [&](std::size_t begin, std::size_t size, std::size_t used, const Batch* result) HWY_ATTR {
                          store(size, used, distance + begin, [&](std::size_t i) HWY_ATTR { return result[i]; });
                        });
}

void convex_batch(const Code& program, Points points, std::size_t count, float* distance, float* convex,
                  Workspace& workspace) {
  using T = Convex<Batch>;
  for_each_block<T>(program, points, count, workspace,
                    [&](std::size_t begin, std::size_t size, std::size_t used, const T* result) HWY_ATTR {
                      store(size, used, distance + begin, [&](std::size_t i) HWY_ATTR { return result[i].v; });
                      store(size, used, convex + begin, [&](std::size_t i) HWY_ATTR { return result[i].convex; });
                    });
}

void surface_batch(const Code& program, Points points, std::size_t count, SurfaceValues out, Workspace& workspace) {
  using T = Tagged<Convex<Dual<Batch>>>;
  for_each_block<T>(
      program, points, count, workspace,
      [&](std::size_t begin, std::size_t size, std::size_t used, const T* result) HWY_ATTR {
        store(size, used, out.distance + begin, [&](std::size_t i) HWY_ATTR { return result[i].v.v.v; });
        store(size, used, out.gradient_x + begin,
              [&](std::size_t i) HWY_ATTR { return zero_unless_finite(result[i].v.v.dx); });
        store(size, used, out.gradient_y + begin,
              [&](std::size_t i) HWY_ATTR { return zero_unless_finite(result[i].v.v.dy); });
        store(size, used, out.gradient_z + begin,
              [&](std::size_t i) HWY_ATTR { return zero_unless_finite(result[i].v.v.dz); });
        if (out.convex != nullptr) {
          store(size, used, out.convex + begin, [&](std::size_t i) HWY_ATTR { return result[i].v.convex; });
        }
        float surfaces[kSlot<T> * kLanes];
        store(size, used, surfaces, [&](std::size_t i) HWY_ATTR { return result[i].surface; });
        std::transform(surfaces, surfaces + size, out.surface + begin,
                       [](float s) { return s < 0 ? 0 : static_cast<std::uint32_t>(s); });
      });
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE && FATHOM_TARGET == 0
namespace fathom::vm {

HWY_EXPORT(distance_batch);
HWY_EXPORT(convex_batch);
HWY_EXPORT(surface_batch);

void evaluate_distance(const Code& program, Points points, std::size_t count, float* distance, Workspace& workspace) {
  HWY_DYNAMIC_DISPATCH(distance_batch)(program, points, count, distance, workspace);
}

void evaluate_convex(const Code& program, Points points, std::size_t count, float* distance, float* convex,
                     Workspace& workspace) {
  HWY_DYNAMIC_DISPATCH(convex_batch)(program, points, count, distance, convex, workspace);
}

void evaluate_surface(const Code& program, Points points, std::size_t count, SurfaceValues out,
                      Workspace& workspace) {
  HWY_DYNAMIC_DISPATCH(surface_batch)(program, points, count, out, workspace);
}

namespace {

struct Isa {
  std::string_view name;
  std::int64_t target;
};

// Best first.
constexpr Isa kIsas[] = {
    {"avx512", HWY_AVX3}, {"avx2", HWY_AVX2}, {"sse4", HWY_SSE4}, {"neon", HWY_NEON}, {"scalar", HWY_STATIC_TARGET}};

// Removes any override of Highway's targets. Returns the targets that this computer can run.
std::int64_t supported_targets() {
  hwy::SetSupportedTargetsForTest(0);
  return (hwy::SupportedTargets() & HWY_TARGETS) | HWY_STATIC_TARGET;
}

// Applies FATHOM_ISA before main(), when no evaluation can have begun.
const bool kEnvironmentApplied = [] {
  const char* wanted = std::getenv("FATHOM_ISA");
  if (wanted == nullptr || *wanted == 0 || force_isa(wanted)) return true;
  std::fprintf(stderr, "warning: FATHOM_ISA=%s: this machine cannot run that; using %.*s\n", wanted,
               static_cast<int>(isa_name().size()), isa_name().data());
  return false;
}();

}  // namespace

std::vector<std::string_view> available_isas() {
  const std::string_view in_use = isa_name();
  const std::int64_t supported = supported_targets();
  force_isa(in_use);
  std::vector<std::string_view> names;
  for (const Isa& isa : kIsas) {
    if (supported & isa.target) names.push_back(isa.name);
  }
  return names;
}

bool force_isa(std::string_view name) {
  const std::string_view before = isa_name();
  const std::int64_t supported = supported_targets();
  bool found = false;
  for (const Isa& isa : kIsas) found = found || (isa.name == name && (supported & isa.target) != 0);
  // Enables the instruction set and all below it, so that a function that is not compiled for the instruction set
  // runs on the next lower one and not on the portable code.
  std::int64_t targets = 0;
  for (const Isa& isa : kIsas) {
    if (targets != 0 || isa.name == (found ? name : before)) targets |= isa.target;
  }
  hwy::SetSupportedTargetsForTest(targets & supported);
  hwy::GetChosenTarget().DeInit();
  return found;
}

std::string_view isa_name() {
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  for (const Isa& isa : kIsas) {
    if (supported & isa.target) return isa.name;
  }
  return "scalar";
}

}  // namespace fathom::vm
#endif
