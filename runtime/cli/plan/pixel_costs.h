// Seconds that the pixels of a frame take, by a small picture of it.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <vector>

#include "runtime/film/film.h"
#include "runtime/path/options.h"

namespace fathom::cli {

class PixelCosts {
 public:
  // Renders at most 160 pixels across with at most 4 samples, as long as a frame of that size and as many samples.
  PixelCosts(const compiler::CompiledScene& scene, runtime::RenderOptions options, int width, int height,
             std::uint32_t spp);

  // Seconds that a sample of all pixels in an area of the frame takes, on all threads.
  double sum(const runtime::PixelRect& area) const;

 private:
  int frame_width_, frame_height_;  // pixels of the frame
  int width_, height_;              // of the small picture
  std::vector<double> seconds_;     // [y][x], of a sample of one pixel
};

}  // namespace fathom::cli
