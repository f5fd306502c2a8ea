#include "runtime/image/image_exr_color.h"

#include <ImfRgbaYca.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <set>
#include <utility>

namespace fathom::runtime {
namespace {

namespace yca = Imf::RgbaYca;

// Luminance and chroma of an image, in the library's type: r is RY, g is Y, b is BY.
struct YcaImage {
  int width, height;
  std::vector<Imf::Rgba> pixels;

  Imf::Rgba* row(int y) { return pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
};

// Fills in the chroma between every second column, then between every second row, as Imf::RgbaInputFile does.
void reconstruct_chroma(YcaImage& image) {
  std::vector<Imf::Rgba> padded(static_cast<std::size_t>(image.width + yca::N - 1));
  for (int y = 0; y < image.height; y += 2) {
    Imf::Rgba* const row = image.row(y);
    // The last column with chroma is the last but one.
    for (int i = 0; i < yca::N2; ++i) {
      padded[static_cast<std::size_t>(i)] = row[0];
      padded[static_cast<std::size_t>(yca::N2 + image.width + i)] = row[image.width - 2];
    }
    std::copy_n(row, image.width, padded.begin() + yca::N2);
    yca::reconstructChromaHoriz(image.width, padded.data(), row);
  }
  for (int y = 1; y < image.height; y += 2) {
    std::array<const Imf::Rgba*, yca::N> rows;
    for (int i = 0; i < yca::N; ++i) {
      const int at = y + i - yca::N2;
      rows[static_cast<std::size_t>(i)] = image.row(i == yca::N2 ? y : std::clamp(at, 0, image.height - 2));
    }
    yca::reconstructChromaVert(image.width, rows.data(), image.row(y));
  }
}

// Converts filtered chroma to R, G, B, and takes back what the filter added to the saturation.
void filtered_to_rgb(YcaImage& image, const Imath::V3f& weights, std::array<std::vector<float>*, 3> channels) {
  for (int y = 0; y < image.height; ++y) yca::YCAtoRGBA(weights, image.width, image.row(y), image.row(y));
  std::vector<Imf::Rgba> fixed(static_cast<std::size_t>(image.width));
  std::size_t at = 0;
  for (int y = 0; y < image.height; ++y) {
    const Imf::Rgba* const rows[] = {image.row(std::max(0, y - 1)), image.row(y),
                                     image.row(std::min(y + 1, image.height - 1))};
    yca::fixSaturation(weights, image.width, rows, fixed.data());
    for (const Imf::Rgba& pixel : fixed) {
      (*channels[0])[at] = pixel.r;
      (*channels[1])[at] = pixel.g;
      (*channels[2])[at] = pixel.b;
      ++at;
    }
  }
}

class ColorDecoder {
 public:
  ColorDecoder(FloatImage& image, const Chromaticities& from, const std::set<std::string>& subsampled)
      : image_(image), from_(from), subsampled_(subsampled) {}

  std::optional<std::string> decode() {
    const auto matrix = to_srgb(from_);
    const auto weights = luminance_weights(from_);
    if (!matrix || !weights) return fmt::format("its chromaticities make no sense: {}", to_text(from_));
    for (const std::string& layer : color_layers(image_.channels, true)) {
      constexpr double kLeast = 1e-6;  // of green, which is what red and blue leave of Y
      if (std::abs(weights->y) < kLeast) return fmt::format("its green is no light: {}", to_text(from_));
      decode_luminance(layer, glm::vec3(*weights));
    }
    for (const std::string& name : subsampled_) {
      if (image_.find(name) < 0) continue;  // it has become a colour
      return fmt::format("its channel `{}` is subsampled, and there is no luminance and chroma to go with it", name);
    }
    const std::set<std::string> colors = color_layers(image_.channels);
    for (const std::string& layer : colors) convert(layer, *matrix);
    if (colors.size() == 1) leave_out(*colors.begin());
    return std::nullopt;
  }

 private:
  std::vector<float>* values_of(const std::string& name) {
    const int at = image_.find(name);
    return at < 0 ? nullptr : &image_.values[static_cast<std::size_t>(at)];
  }

  void rename(const std::string& from, const std::string& to) {
    image_.channels[static_cast<std::size_t>(image_.find(from))].name = to;
  }

  void decode_luminance(const std::string& layer, const glm::vec3& weights) {
    std::vector<float>*red = values_of(layer + "RY"), *blue = values_of(layer + "BY");
    if (red == nullptr || blue == nullptr) {
      for (const char* name : {"G", "B"}) {
        image_.channels.push_back({layer + name, false});
        image_.values.push_back(std::vector<float>(*values_of(layer + "Y")));
      }
      return rename(layer + "Y", layer + "R");
    }
    std::vector<float>& grey = *values_of(layer + "Y");
    if (subsampled_.contains(layer + "RY") || subsampled_.contains(layer + "BY")) {
      constexpr float kLargestHalf = 65504;
      YcaImage image{image_.area.width(), image_.area.height(), std::vector<Imf::Rgba>(grey.size())};
      for (std::size_t i = 0; i < grey.size(); ++i) {
        image.pixels[i] = Imf::Rgba((*red)[i], std::min(grey[i], kLargestHalf), (*blue)[i]);
      }
      reconstruct_chroma(image);
      filtered_to_rgb(image, {weights.x, weights.y, weights.z}, {red, &grey, blue});
    } else {
      // As yca::YCAtoRGBA(), which computes in halfs.
      for (std::size_t i = 0; i < grey.size(); ++i) {
        const float y = grey[i], r = ((*red)[i] + 1) * y, b = ((*blue)[i] + 1) * y;
        grey[i] = (*red)[i] == 0 && (*blue)[i] == 0 ? y : (y - r * weights.x - b * weights.z) / weights.y;
        (*red)[i] = r;
        (*blue)[i] = b;
      }
    }
    rename(layer + "RY", layer + "R");
    rename(layer + "Y", layer + "G");
    rename(layer + "BY", layer + "B");
  }

  void convert(const std::string& layer, const glm::dmat3& matrix) {
    const auto red = values_of(layer + "R"), green = values_of(layer + "G"), blue = values_of(layer + "B");
    if (green != nullptr && blue != nullptr) convert_colors(matrix, *red, *green, *blue);
  }

  void leave_out(const std::string& layer) {
    for (ChannelName& channel : image_.channels) {
      if (!channel.name.starts_with(layer)) continue;
      const std::string name = channel.name.substr(layer.size());
      if (image_.find(name) < 0) channel.name = name;
    }
  }

  FloatImage& image_;
  const Chromaticities& from_;
  const std::set<std::string>& subsampled_;
};

}  // namespace

std::string_view name_in_layer(std::string_view channel) {
  return channel.substr(channel.rfind('.') + 1);  // npos + 1 is 0
}

std::set<std::string> color_layers(const std::vector<ChannelName>& channels, bool luminance) {
  std::set<std::string> red, grey, vectors;
  for (const ChannelName& channel : channels) {
    const std::string_view name = name_in_layer(channel.name);
    std::string layer = channel.name.substr(0, channel.name.size() - name.size());
    if (name == "R") red.insert(std::move(layer));
    if (name == "X") vectors.insert(std::move(layer));
    if (name == "Y") grey.insert(std::move(layer));
  }
  std::erase_if(grey, [&](const std::string& layer) { return red.contains(layer) || vectors.contains(layer); });
  if (!luminance) grey.merge(red);
  return grey;
}

std::optional<std::string> decode_colors(FloatImage& image, const Chromaticities& from,
                                         const std::set<std::string>& subsampled) {
  return ColorDecoder(image, from, subsampled).decode();
}

}  // namespace fathom::runtime
