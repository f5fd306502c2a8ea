// The pixels in which an instruction matters: those whose value at the hit depends on it, because no choice of the
// program (min, max and their smooth variants) leaves its operand out there.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

class Relevance {
 public:
  // Follows the rays through the pixels of a small picture of that camera, at most as large as width x height.
  Relevance(const compiler::CompiledScene& scene, const compiler::Camera& camera, int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  // Returns [y][x], true where the instruction at `offset` of the surface program matters.
  std::vector<bool> pixels(std::uint32_t offset) const;

 private:
  int width_, height_;
  std::vector<std::vector<std::uint32_t>> sources_;  // [y][x] offsets of the instructions that matter, in order
};

}  // namespace fathom::cli
