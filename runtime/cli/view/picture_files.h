// Layers of the viewer's picture as PNG files.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "runtime/cli/view/true_picture.h"

namespace fathom::cli {

using Bytes = std::vector<std::uint8_t>;

// Returns white pixels where `pixels`, [y][x], is true, and black ones elsewhere.
Bytes mask_file(const std::vector<bool>& pixels, int width, int height);

enum class Denoise { Auto, On, Off };  // Auto: while a pixel has few samples

class PictureFiles {
 public:
  explicit PictureFiles(int threads) : threads_(threads) {}

  // Returns a layer: color, albedo, normal, depth, evaluations or instructions; empty for any other name. `exposure`:
  // stops added to the scene's exposure. A picture whose denoising is cancelled is returned with its noise.
  Bytes encode(const std::shared_ptr<const Picture>& picture, std::string_view layer, double exposure,
               Denoise denoise);

  // Cancels the denoising that runs now, because its picture is out of date. A large one takes a second.
  void cancel() { ++cancelled_; }

 private:
  // Returns null if it is cancelled.
  std::shared_ptr<const runtime::Film> denoised(const std::shared_ptr<const Picture>& picture);

  const int threads_;
  std::atomic<int> cancelled_ = 0;
  std::mutex mutex_;
  int number_ = 0;  // of the picture that denoised_ comes from
  std::shared_ptr<const runtime::Film> denoised_;
};

}  // namespace fathom::cli
