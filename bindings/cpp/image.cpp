#include <algorithm>
#include <fathom/fathom.hpp>

#include "bindings/cpp/guard.h"
#include "bindings/cpp/image_data.h"
#include "compiler/scene/settings.h"
#include "runtime/film/film_channels.h"
#include "runtime/film/film_layers.h"
#include "runtime/image/image_exr.h"
#include "runtime/image/image_io.h"
#include "runtime/image/image_png.h"

namespace fathom {
namespace {

constexpr std::string_view kNoImage = "the image is empty: it was not rendered";
constexpr std::string_view kWrongLength = "the span does not have the number of elements that the image has";

glm::dvec3 value_of(const runtime::PixelMeans& pixel, Layer layer, glm::dvec3 origin) {
  switch (layer) {
    case Layer::Radiance:
      return pixel.radiance;
    case Layer::Albedo:
      return pixel.albedo;
    case Layer::Normal:
      return runtime::normal_of_hits(pixel);
    case Layer::Position:
      return pixel.hits == 0 ? glm::dvec3(0) : pixel.position + origin;
  }
  return glm::dvec3(0);
}

// Calls use(index, pixel) for every pixel in the order [y][x], if `length` is `components` per pixel.
template <class Use>
Error for_pixels(const std::shared_ptr<const Image::Data>& data, std::size_t length, std::size_t components,
                 Use use) {
  return library::guard([&]() -> Error {
    if (!data) return library::bad_argument(kNoImage);
    const runtime::PixelRect area = data->film.area();
    if (length != components * static_cast<std::size_t>(area.pixels())) return library::bad_argument(kWrongLength);
    std::size_t index = 0;
    for (int y = area.y0; y < area.y1; ++y) {
      for (int x = area.x0; x < area.x1; ++x) use(index++, data->film.means(x, y));
    }
    return {};
  });
}

// Attributes of an OpenEXR file.
runtime::Attributes attributes_of(const Image::Data& data) {
  return {
      {"fathom.version", std::string(version())},
      {"fathom.exposure", static_cast<float>(data.tone.exposure)},
      {"fathom.tone", std::string(compiler::kToneCurves[static_cast<std::size_t>(data.tone.curve)])},
      {"fathom.objects", data.objects},
  };
}

}  // namespace

int Image::width() const noexcept { return data_ ? data_->film.width() : 0; }
int Image::height() const noexcept { return data_ ? data_->film.height() : 0; }
bool Image::complete() const noexcept { return data_ && data_->complete; }
std::uint64_t Image::samples() const noexcept { return data_ ? data_->film.samples() : 0; }

Error Image::read(Layer layer, std::span<float> out) const noexcept {
  return for_pixels(data_, out.size(), 3, [&](std::size_t index, const runtime::PixelMeans& pixel) {
    const glm::dvec3 value = value_of(pixel, layer, data_->origin);
    for (int i = 0; i < 3; ++i) out[3 * index + static_cast<std::size_t>(i)] = static_cast<float>(value[i]);
  });
}

Error Image::read_depth(std::span<float> out) const noexcept {
  return for_pixels(data_, out.size(), 1, [&](std::size_t index, const runtime::PixelMeans& pixel) {
    out[index] = static_cast<float>(pixel.depth);
  });
}

// The film counts objects from 1.
Error Image::read_objects(std::span<std::uint32_t> out) const noexcept {
  return for_pixels(data_, out.size(), 1, [&](std::size_t index, const runtime::PixelMeans& pixel) {
    out[index] = pixel.surface_id == 0 ? kNoObject : pixel.surface_id - 1;
  });
}

Error Image::read_display(std::span<std::uint8_t> out) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(kNoImage);
    const runtime::ByteImage shown = runtime::layer_image(data_->film, runtime::Layer::Beauty, data_->tone);
    if (out.size() != shown.rgb.size()) return library::bad_argument(kWrongLength);
    std::ranges::copy(shown.rgb, out.begin());
    return {};
  });
}

Error Image::encode_png(std::vector<std::uint8_t>& out) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(kNoImage);
    const runtime::DisplayImage shown(runtime::layer_of(data_->film, runtime::Layer::Beauty), data_->tone);
    out = runtime::encode_png(width(), height(), 8, true,
                              [&](int y, std::span<std::uint8_t> bytes) { shown.row(y, bytes); });
    return out.empty() ? Error{Error::Kind::Internal, "the picture cannot be encoded"} : Error{};
  });
}

Error Image::write(const std::string& path) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(kNoImage);
    if (Error error = library::check_path("path", path)) return error;
    const runtime::ImageFormatInfo* const info = runtime::image_format_of(path);
    if (const auto problem = runtime::check_image_path(path)) {
      return library::error_of(info == nullptr ? Error::Kind::BadArgument : Error::Kind::File, *problem);
    }
    const runtime::ImageFormat format = info->format;
    const auto problem =
        format == runtime::ImageFormat::Exr
            ? runtime::write_exr(
                  runtime::rows_of(data_->film, width(), height(), data_->origin, attributes_of(*data_)), path)
            : runtime::write_layer(runtime::layer_of(data_->film, runtime::Layer::Beauty), {data_->tone, 8}, path);
    return problem ? Error{Error::Kind::File, *problem} : Error{};
  });
}

}  // namespace fathom
