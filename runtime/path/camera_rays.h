// The stage of camera rays: begins paths.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <cstdint>
#include <span>

#include "runtime/field/field.h"
#include "runtime/path/path_state.h"
#include "runtime/path/render_context.h"

namespace fathom::runtime {

// Maximum number of paths that begin at once.
inline constexpr std::size_t kCameraBatch = 64;

// Sets paths[ids[i]] to the beginning of path keys[i]. The ray is the camera ray.
void begin_paths(const RenderContext& context, std::span<const PathKey> keys, std::span<const std::uint32_t> ids,
                 std::span<PathState> paths, RealScratch& scratch);

}  // namespace fathom::runtime
