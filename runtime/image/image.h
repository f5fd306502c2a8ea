// 8-bit and 16-bit images for display, made from a film or from a file with its layers. The bits are the same.
// Tested by: tests/runtime/image/image_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/image/float_image.h"
#include "runtime/image/tone.h"

namespace fathom::runtime {

// An image of 8 bits, sRGB or in the encoding of its layer.
struct ByteImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // [y][x][rgb], y downwards
};

// Layers that can be shown.
enum class Layer {
  Beauty,  // radiance, through a ToneMapping, sRGB encoded
  Albedo,  // colour of the first hit, sRGB encoded; black for misses
  // The image's smallest depth over the pixel's, along the rays, not sRGB encoded. White is nearest, twice as far is
  // half as bright, infinitely far or a miss is black. A horizon leaves the foreground its greys.
  Depth,
  // Mean normal n of the first hit as n/2 + 1/2, not sRGB encoded: +x is red, +y green, +z blue. Black for misses. A
  // pixel that only some samples hit shows the mean of these samples.
  Normal,
  Noisy,  // like Beauty, before denoising
};
struct LayerInfo {
  Layer layer;
  std::string_view name;
  std::array<std::string_view, 3> channels;  // channels the layer is made of
};
inline constexpr std::array<LayerInfo, 5> kLayers = {{
    {Layer::Beauty, "beauty", {"R", "G", "B"}},
    {Layer::Albedo, "albedo", {"albedo.R", "albedo.G", "albedo.B"}},
    {Layer::Depth, "depth", {"Z", "Z", "Z"}},
    {Layer::Normal, "normal", {"N.X", "N.Y", "N.Z"}},
    {Layer::Noisy, "noisy", {"noisy.R", "noisy.G", "noisy.B"}},
}};
constexpr bool is_light(Layer layer) { return layer == Layer::Beauty || layer == Layer::Noisy; }
constexpr const LayerInfo& info(Layer layer) { return kLayers[static_cast<std::size_t>(layer)]; }

// The floats of a layer, pixel by pixel, as an OpenEXR file keeps them. Refers to the object it was made from.
struct LayerValues {
  Layer layer;
  PixelRect area;
  std::function<glm::vec3(int x, int y)> at;
};
std::optional<LayerValues> layer_of(const FloatImage& image, Layer layer);  // nullopt: a channel is missing

// Returns how many pixels have NaN and how many infinity, and where the first is; nullopt if there are none.
std::optional<std::string> not_finite(const LayerValues& values);

// An image for display that is made row by row, while it is written. Refers to the object it was made from.
class DisplayImage {
 public:
  // `tone` applies to radiance alone.
  explicit DisplayImage(LayerValues values, ToneMapping tone = {});

  int width() const { return values_.area.width(); }
  int height() const { return values_.area.height(); }
  // Writes the samples of row `y` from the top, [x][rgb].
  void row(int y, std::span<std::uint8_t> rgb) const;
  void row(int y, std::span<std::uint16_t> rgb) const;

 private:
  // Returns the value for the display, in [0,1] up to rounding. If encoded_ is set, row() then encodes it as sRGB.
  glm::dvec3 color(int x, int y) const;

  LayerValues values_;
  bool encoded_;
  ToneCurve curve_;
  double factor_;
  double nearest_ = 0;  // smallest value of a depth layer
};

ByteImage to_byte_image(const DisplayImage& display);

}  // namespace fathom::runtime
