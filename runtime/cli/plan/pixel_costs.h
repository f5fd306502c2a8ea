// Estimates the seconds per pixel of a frame from a small render of the frame.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <vector>

#include "runtime/film/film.h"
#include "runtime/path/options.h"

namespace fathom::cli {

class PixelCosts {
 public:
  // Renders a frame of at most 160 pixels in width with at most 4 samples per pixel. `width`, `height` and `spp` are
  // those of the full frame, which the small frame does not exceed.
  PixelCosts(const compiler::CompiledScene& scene, runtime::RenderOptions options, int width, int height,
             std::uint32_t spp);

  // Returns the seconds for one sample per pixel in an area of the frame, on all threads.
  double sum(const runtime::PixelRect& area) const;

 private:
  int frame_width_, frame_height_;  // pixels of the full frame
  int width_, height_;              // pixels of the small frame
  std::vector<double> seconds_;     // [y][x], per sample of one pixel of the small frame
};

}  // namespace fathom::cli
