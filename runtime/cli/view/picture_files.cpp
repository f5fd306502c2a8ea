#include "runtime/cli/view/picture_files.h"

#include <algorithm>
#include <optional>
#include <span>

#include "runtime/chart/colormap.h"
#include "runtime/cli/picture/cost_map.h"
#include "runtime/denoise/denoise.h"
#include "runtime/film/film_layers.h"
#include "runtime/image/image_io.h"
#include "runtime/image/image_png.h"

namespace fathom::cli {
namespace {

using runtime::Layer;

constexpr int kFewSamples = 32;

std::optional<Layer> find_layer(std::string_view name) {
  if (name == "color") return Layer::Beauty;
  for (const runtime::LayerInfo& row : runtime::kLayers) {
    if (row.name == name && !is_light(row.layer)) return row.layer;
  }
  return std::nullopt;
}

// Returns the map of a cost, logarithmic from dark violet to yellow; black where there is none.
Bytes cost_file(const runtime::Film& film, const CostMap& map) {
  const std::vector<float> values = cost_values(film, map);
  const runtime::ColorScale scale = runtime::scale_for(values, true);
  runtime::ByteImage image{film.width(), film.height(), {}};
  for (const float each : values) {
    const runtime::Rgb color = scale.color(static_cast<double>(each));
    image.rgb.insert(image.rgb.end(), color.begin(), color.end());
  }
  return encode_image(image, runtime::ImageFormat::Png);
}

// Returns the file that `fathom render` would write.
Bytes layer_file(const runtime::Film& film, Layer layer, const runtime::ToneMapping& tone) {
  const runtime::DisplayImage image(layer_of(film, layer), tone);
  const bool srgb = is_light(layer) || layer == Layer::Albedo;
  return runtime::encode_png(image.width(), image.height(), 8, srgb,
                             [&](int y, std::span<std::uint8_t> row) { image.row(y, row); });
}

}  // namespace

Bytes mask_file(const std::vector<bool>& pixels, int width, int height) {
  runtime::ByteImage image{width, height, {}};
  for (const bool pixel : pixels) image.rgb.insert(image.rgb.end(), 3, pixel ? 255 : 0);
  return encode_image(image, runtime::ImageFormat::Png);
}

Bytes PictureFiles::encode(const std::shared_ptr<const Picture>& picture, std::string_view layer, double exposure,
                           Denoise denoise) {
  for (const CostMap& map : kCostMaps) {
    if (layer == map.name) return cost_file(picture->film, map);
  }
  const std::optional<Layer> found = find_layer(layer);
  if (!found) return {};
  const compiler::Film& film = picture->scene->scene().film;
  const runtime::ToneMapping tone{std::clamp(film.exposure + exposure, -100.0, 100.0), film.tone};
  const bool is_wanted = denoise == Denoise::On || (denoise == Denoise::Auto && picture->samples < kFewSamples);
  if (*found == Layer::Beauty && is_wanted && picture->samples >= 2) {
    if (const auto clean = denoised(picture)) return layer_file(*clean, *found, tone);
  }
  return layer_file(picture->film, *found, tone);
}

std::shared_ptr<const runtime::Film> PictureFiles::denoised(const std::shared_ptr<const Picture>& picture) {
  const int before = cancelled_;
  const std::lock_guard lock(mutex_);
  if (number_ != picture->number) {
    auto film = std::make_shared<runtime::Film>(picture->film);
    if (!runtime::denoise(*film, threads_, [&] { return cancelled_ != before; })) return nullptr;
    denoised_ = std::move(film);
    number_ = picture->number;
  }
  return denoised_;
}

}  // namespace fathom::cli
