#include "runtime/image/image_io.h"

#include <fmt/format.h>
#include <stb_image_write.h>

#include <algorithm>
#include <bit>
#include <functional>

#include "runtime/image/image_png.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

constexpr int kJpegQuality = 95;  // of 100

// Returns the part after the name's last dot, in lower case; empty when there is no dot.
std::string ending_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || path.find('/', dot) != std::string::npos) return "";
  std::string ending = path.substr(dot + 1);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

void append_bytes(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(context);
  const auto* first = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

std::vector<std::uint8_t> encode_display(const DisplayImage& display, int bits, bool srgb) {
  std::vector<std::uint16_t> words(static_cast<std::size_t>(display.width()) * 3);
  return encode_png(display.width(), display.height(), bits, srgb, [&](int y, std::span<std::uint8_t> bytes) {
    if (bits == 8) {
      display.row(y, bytes);
      return;
    }
    display.row(y, words);
    for (std::size_t i = 0; i < words.size(); ++i) {
      bytes[2 * i] = static_cast<std::uint8_t>(words[i] >> 8);
      bytes[2 * i + 1] = static_cast<std::uint8_t>(words[i]);
    }
  });
}

// Writes `components` floats per pixel for row `y`, counted from the top.
using FloatRow = std::function<void(int y, std::span<float> values)>;

std::optional<std::string> write_pfm(int width, int height, int components, const FloatRow& fill, AtomicFile& file) {
  const std::string header =
      fmt::format("{}\n{} {}\n-1.0\n", components == 1 ? "Pf" : "PF", width, height);  // negative: little endian
  file.write({reinterpret_cast<const std::uint8_t*>(header.data()), header.size()});
  std::vector<float> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(components));
  std::vector<std::uint8_t> bytes(values.size() * 4);
  for (int y = height; y-- > 0;) {
    fill(y, values);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(values[i / 4]) >> (8 * (i % 4)));
    }
    file.write(bytes);
  }
  return file.commit();
}

std::optional<std::string> write_float_map(const LayerValues& layer, AtomicFile& file) {
  const PixelRect area = layer.area;
  const std::size_t components = layer.layer == Layer::Depth ? 1 : 3;
  const FloatRow fill = [&](int y, std::span<float> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const int x = area.x0 + static_cast<int>(i / components);
      values[i] = layer.at(x, area.y0 + y)[static_cast<int>(i % components)];
    }
  };
  return write_pfm(area.width(), area.height(), static_cast<int>(components), fill, file);
}

// Source: Ward, "Real Pixels", Graphics Gems II, 1991: 8 bits per colour and a common exponent.
std::vector<std::uint8_t> encode_hdr(const LayerValues& layer) {
  std::vector<float> values;
  values.reserve(layer.area.pixels() * 3);
  for (int y = layer.area.y0; y < layer.area.y1; ++y) {
    for (int x = layer.area.x0; x < layer.area.x1; ++x) {
      glm::vec3 value = layer.at(x, y);
      if (layer.layer == Layer::Normal && value != glm::vec3(0)) value = value * 0.5f + 0.5f;
      for (int i = 0; i < 3; ++i) values.push_back(value[i]);
    }
  }
  std::vector<std::uint8_t> bytes;
  const int done =
      stbi_write_hdr_to_func(append_bytes, &bytes, layer.area.width(), layer.area.height(), 3, values.data());
  if (done == 0) bytes.clear();
  return bytes;
}

std::optional<std::string> check_ending(const std::string& path) {
  if (image_format_of(path)) return std::nullopt;
  return fmt::format("cannot tell the format of `{}`: its name must end in one of {}", path, image_endings());
}

std::optional<std::string> write_encoded(const std::vector<std::uint8_t>& bytes, AtomicFile& file) {
  if (bytes.empty()) return fmt::format("cannot encode `{}`: too large for its format", file.name());
  file.write(bytes);
  return file.commit();
}

}  // namespace

const ImageFormatInfo* image_format_of(const std::string& path) {
  const std::string ending = ending_of(path);
  for (const ImageFormatInfo& known : kImageFormats) {
    if (ending == known.ending) return &known;
  }
  return nullptr;
}

std::string image_endings(bool display_only) {
  std::string endings;
  for (const ImageFormatInfo& format : kImageFormats) {
    if (display_only && !format.for_display) continue;
    endings += fmt::format("{}.{}", endings.empty() ? "" : ", ", format.ending);
  }
  return endings;
}

bool is_float_map(const std::string& path) { return ending_of(path) == "pfm"; }

std::optional<std::string> check_image_path(const std::string& path) {
  if (std::optional<std::string> problem = check_ending(path)) return problem;
  return check_file_path(path);
}

std::optional<std::string> write_layer(const LayerValues& layer, const ImageOptions& options,
                                       const std::string& path) {
  if (std::optional<std::string> problem = check_ending(path)) return problem;
  AtomicFile file(path);
  return write_layer(layer, options, image_format_of(path)->format, file);
}

std::optional<std::string> write_layer(const LayerValues& layer, const ImageOptions& options, ImageFormat format,
                                       AtomicFile& file) {
  switch (format) {
    case ImageFormat::Png: {
      const bool srgb = is_light(layer.layer) || layer.layer == Layer::Albedo;
      return write_encoded(encode_display(DisplayImage(layer, options.tone), options.bits, srgb), file);
    }
    case ImageFormat::Jpeg:
    case ImageFormat::Bmp:
      return write_encoded(encode_image(to_byte_image(DisplayImage(layer, options.tone)), format), file);
    case ImageFormat::Pfm:
      return write_float_map(layer, file);
    case ImageFormat::Hdr:
      return write_encoded(encode_hdr(layer), file);
    case ImageFormat::Exr:
      break;
  }
  CHECK(false, "an OpenEXR file holds more than a layer");
  return std::nullopt;
}

std::vector<std::uint8_t> encode_image(const ByteImage& image, ImageFormat format) {
  std::vector<std::uint8_t> bytes;
  const int w = image.width, h = image.height;
  const std::size_t row = static_cast<std::size_t>(w) * 3;
  const void* data = image.rgb.data();
  int done = 1;
  switch (format) {
    case ImageFormat::Png:
      bytes = encode_png(w, h, 8, false, [&](int y, std::span<std::uint8_t> out) {
        std::copy_n(image.rgb.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row), row,
                    out.begin());
      });
      break;
    case ImageFormat::Jpeg:
      done = stbi_write_jpg_to_func(append_bytes, &bytes, w, h, 3, data, kJpegQuality);
      break;
    case ImageFormat::Bmp:
      // The header's numbers have 32 bits, and rows are padded.
      done = image.rgb.size() < (std::size_t{1} << 31) - (std::size_t{1} << 20) &&
             stbi_write_bmp_to_func(append_bytes, &bytes, w, h, 3, data);
      break;
    default:
      CHECK(false, "bytes are not what this format holds");
  }
  if (done == 0) bytes.clear();
  return bytes;
}

std::optional<std::string> write_image(const ByteImage& image, const std::string& path) {
  if (std::optional<std::string> problem = check_ending(path)) return problem;
  AtomicFile file(path);
  return write_image(image, image_format_of(path)->format, file);
}

std::optional<std::string> write_image(const ByteImage& image, ImageFormat format, AtomicFile& file) {
  return write_encoded(encode_image(image, format), file);
}

std::optional<std::string> write_float_map(std::span<const float> values, int width, int height,
                                           const std::string& path) {
  const std::size_t row = static_cast<std::size_t>(width);
  CHECK(values.size() == row * static_cast<std::size_t>(height), "a map of another size than its values");
  const FloatRow fill = [&](int y, std::span<float> out) {
    const auto from = values.subspan(static_cast<std::size_t>(y) * row, row);
    std::copy(from.begin(), from.end(), out.begin());
  };
  AtomicFile file(path);
  return write_pfm(width, height, 1, fill, file);
}

}  // namespace fathom::runtime
