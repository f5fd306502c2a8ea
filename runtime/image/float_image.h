// An image of floats: channels by name, as in an OpenEXR file, whole in memory or row by row.
//
// runtime/film/film_channels.h lists the channels of a render. All are means over a pixel's samples unless said
// otherwise (docs/reference/layers.md).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "runtime/base/pixel_rect.h"

namespace fathom::runtime {

// Limits on a file that is read: larger than any image of ours, and small enough that a broken header does not take
// all memory.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28, kMaxValues = std::int64_t{1} << 31;

// Maximum number of bytes that deflate makes of one: 258 of a length and a distance of one bit each (RFC 1951,
// section 3.2.5).
inline constexpr double kMaxDeflated = 1032;

// Metadata of a file: name -> value. Matrices act on row vectors from the right (p M), row by row, as OpenEXR keeps
// and pbrt writes them.
using Matrix4 = std::array<float, 16>;
using Attribute = std::variant<int, float, std::string, Matrix4, std::vector<std::string>>;
using Attributes = std::map<std::string, Attribute>;

struct ChannelName {
  std::string name;
  // Integers from 0, kept as such; floats hold them exactly below 2^24.
  bool whole = false;
};

// Description of the part within `area` of an image of width x height pixels.
struct ImageShape {
  int width = 0, height = 0;
  PixelRect area;
  std::vector<ChannelName> channels;
  Attributes attributes;

  // Returns the channel's index in `channels`; -1 when there is none of that name.
  int find(std::string_view name) const {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].name == name) return static_cast<int>(i);
    }
    return -1;
  }
};

// Returns "A, R, layer.Z".
inline std::string channel_names(const ImageShape& image) {
  std::string names;
  for (const ChannelName& channel : image.channels) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", channel.name);
  }
  return names;
}

// Returns the reason for not reading an image that takes `needed` bytes of memory.
inline std::string too_much_memory(double needed, double allowed) {
  return fmt::format("it takes {:.15g} bytes of memory, and {:.15g} are allowed", needed, std::max(0.0, allowed));
}

// Returns the reason for not reading a file that is too short for its number of pixels even at the best compression.
inline std::string too_few_bytes(int width, int height, double least, double has) {
  return fmt::format("it ends too early: {} by {} pixels take {:.0f} bytes at least, and it has {:.0f}", width,
                     height, std::ceil(least), has);
}

struct FloatImage : ImageShape {
  std::vector<std::vector<float>> values;  // [channel][y][x] over `area`

  // Returns the channel's values [y][x]; nullptr when there is none of that name.
  const std::vector<float>* channel(std::string_view name) const {
    const int at = find(name);
    return at < 0 ? nullptr : &values[static_cast<std::size_t>(at)];
  }
};

// An image that is made while it is written: fill(y, rows) writes rows[channel][x - area.x0].
struct ImageRows : ImageShape {
  std::function<void(int y, std::span<const std::span<float>> rows)> fill;
};

// Returns the image's rows. They refer to `image`.
inline ImageRows rows_of(const FloatImage& image) {
  ImageRows rows{image, {}};
  rows.fill = [&image](int y, std::span<const std::span<float>> out) {
    for (std::size_t c = 0; c < out.size(); ++c) {
      const auto row = image.values[c].begin() + static_cast<std::ptrdiff_t>(image.area.index(image.area.x0, y));
      std::copy(row, row + image.area.width(), out[c].begin());
    }
  };
  return rows;
}

}  // namespace fathom::runtime
