// Pictures for the eye, and how each is made from a film or from a file with its layers: the same bits either way.
// Tested by: tests/runtime/image/image_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/image/float_image.h"
#include "runtime/image/tone.h"

namespace fathom::runtime {

// 8 bits, sRGB or whatever is shown.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // [y][x][rgb], y downwards
};

// What can be shown.
enum class Layer {
  Beauty,  // radiance, through a ToneMapping, sRGB encoded
  Albedo,  // colour of the first surface met, sRGB encoded; black where there is none
  // The nearest distance over the pixel's, along the rays, not sRGB encoded: white is nearest, half as bright twice
  // as far, black infinitely far or nothing. A horizon leaves the foreground its greys.
  Depth,
  // Mean normal n of the first surface as n/2 + 1/2, not sRGB encoded: +x is red, +y green, +z blue. Black where no
  // sample hit; pixels that hit with a part of their samples show the mean of those.
  Normal,
  Noisy,  // as Beauty, before it was denoised
};
struct LayerInfo {
  Layer layer;
  std::string_view name;
  std::array<std::string_view, 3> channels;  // that it is made of
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

// The numbers of a layer, pixel by pixel, in float: what an OpenEXR file keeps. Refers to what it was made from.
struct LayerValues {
  Layer layer;
  PixelRect area;
  std::function<glm::vec3(int x, int y)> at;
};
std::optional<LayerValues> layer_of(const FloatImage& image, Layer layer);  // nullopt: it lacks a channel

// A picture that is made row by row, as it is written. Refers to what it was made from.
class Shown {
 public:
  // `tone` is for light alone.
  explicit Shown(LayerValues values, ToneMapping tone = {});

  int width() const { return values_.area.width(); }
  int height() const { return values_.area.height(); }
  // The samples of row `y` from the top, [x][rgb].
  void row(int y, std::span<std::uint8_t> rgb) const;
  void row(int y, std::span<std::uint16_t> rgb) const;

 private:
  // As the display has it, in [0,1] but for rounding; sRGB encoded afterwards when encoded_.
  glm::dvec3 color(int x, int y) const;

  LayerValues values_;
  bool encoded_;
  ToneCurve curve_;
  double factor_;
  double nearest_ = 0;  // of a depth
};

Picture to_picture(const Shown& shown);

}  // namespace fathom::runtime
