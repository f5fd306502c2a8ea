// Marching: finds the first surface that each ray meets.
//
// A ray is followed along g(t) = side * f(origin + t direction), which is positive in the space that the ray travels
// through (side is -1 inside a solid). A hit is a change of sign bracketed to float resolution, never "f is small".
// There are three tiers:
//
//   clip    in double: the ray restarts where it enters the scene's bound, so that float t stays small (clip.h)
//   stream  in float, many rays at once: certified steps, then brackets that shrink (tiered-inl.h)
//   certify in double: the few rays that float cannot decide, collected until there are enough to be searched side by
//           side (certify.h)
//
// Every ray ends as Hit, Miss, NearMiss or Invalid. No ray runs out of steps.
//
//     const auto marcher = make_marcher(field);
//     marcher->add(id, ray);            // as long as there is room()
//     marcher->advance();               // one evaluation of the field for every ray within the bound
//     marcher->take_ray_hits(ray_hits);  // the rays that ended since the last call
//
// The result of a ray depends on nothing but the ray, the field and the method.
// Tested by: tests/runtime/march/march_test.cpp
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "runtime/base/stats.h"
#include "runtime/field/field.h"
#include "runtime/march/marcher.h"
#include "runtime/march/method.h"
#include "runtime/march/ray.h"

namespace fathom::runtime {

std::unique_ptr<Marcher> make_marcher(const Field& field, const Marching& marching = {});

// Follows all `rays`, whose ids are their indices, and calls `use` with each result.
MarchCounters march_each(const Field& field, std::span<const Ray> rays, const Marching& marching,
                         const std::function<void(const RayHit&)>& use);

// The results of all rays, in order: ray_hits[i].id == i.
struct MarchResult {
  std::vector<RayHit> ray_hits;
  MarchCounters counters;
};
MarchResult march(const Field& field, std::span<const Ray> rays, const Marching& marching = {});

}  // namespace fathom::runtime
