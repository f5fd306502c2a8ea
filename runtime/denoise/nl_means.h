// Non-local means of an image given as two copies with independent noise.
//
// A pixel becomes the weighted mean of a round window that fades out. A neighbour's weight grows with the similarity
// of the patches around both pixels (Buades, Coll, Morel, "A Non-Local Algorithm for Image Denoising", CVPR 2005),
// less the difference that noise explains (Rousselle, Knaus, Zwicker, "Adaptive Rendering with Non-Local Means
// Filtering", SIGGRAPH Asia 2012, section 3), and with the similarity of the features (Rousselle, Manzi, Zwicker
// 2013). Each copy's weights come from the other copy.
//
// Since weights do not depend on the noise they weigh, Stein's unbiased risk estimate is short: a mean F of y with
// the share s for the pixel itself has the expected squared error E |F - y|^2 + (2 s - 1) var y. The filter tries
// three sets of weights, and every pixel takes the set with the least error around it.
//
// Tested by: tests/runtime/denoise/denoise_test.cpp
#pragma once

#include <array>
#include <functional>

#include "runtime/denoise/plane.h"

namespace fathom::runtime {

struct NlMeansInput {
  int width = 0, height = 0;
  std::array<std::array<Plane, 3>, 2> copies;  // finite
  std::array<Plane, 6> features;               // finite, in [-1,1]: differences below a tenth count little
  Plane depth;                                 // finite; a neighbour differs where it leaves the pixel's slope
  Plane valid;                                 // 1, or 0 for pixels whose colour is not used
};

// Returns the filtered image. A pixel without any similar valid pixel keeps the mean of its copies. The image is
// unspecified if `is_cancelled`, which may be empty, has returned true.
std::array<Plane, 3> nl_means(const NlMeansInput& input, int threads, const std::function<bool()>& is_cancelled);

}  // namespace fathom::runtime
