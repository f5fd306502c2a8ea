// A picture as numbers: channels by name, as an OpenEXR file holds them, whole in memory or row by row.
//
// The channels of a render, all means over a pixel's samples unless said (docs/LAYERS.md):
// runtime/film/film_channels.h.
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

// Of a file that is read: more than any of ours has, and few enough that a broken header does not take all memory.
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 28, kMostValues = std::int64_t{1} << 31;

// Deflate makes at most so many bytes of one: 258 of a length and a distance of a bit each (RFC 1951, section 3.2.5).
inline constexpr double kMostDeflated = 1032;

// What a file says of itself: name -> value. Matrices act on row vectors from the right (p M), row by row: what
// OpenEXR keeps and pbrt writes.
using Matrix4 = std::array<float, 16>;
using Attribute = std::variant<int, float, std::string, Matrix4, std::vector<std::string>>;
using Attributes = std::map<std::string, Attribute>;

struct ChannelName {
  std::string name;
  bool whole = false;  // whole numbers from 0, kept as such; floats hold them exactly below 2^24
};

// Of a picture of width x height pixels the part within `area`.
struct ImageShape {
  int width = 0, height = 0;
  PixelRect area;
  std::vector<ChannelName> channels;
  Attributes attributes;

  // The channel's place in `channels`; -1 when there is none of that name.
  int find(std::string_view name) const {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].name == name) return static_cast<int>(i);
    }
    return -1;
  }
};

// Why an image is not read that takes so many bytes.
inline std::string too_much_memory(double needed, double allowed) {
  return fmt::format("it takes {:.15g} bytes of memory, and {:.15g} are allowed", needed, std::max(0.0, allowed));
}

// Why an image is not read whose file is shorter than the best compression makes so many pixels.
inline std::string too_few_bytes(int width, int height, double least, double has) {
  return fmt::format("it ends too early: {} by {} pixels take {:.0f} bytes at least, and it has {:.0f}", width,
                     height, std::ceil(least), has);
}

struct FloatImage : ImageShape {
  std::vector<std::vector<float>> values;  // [channel][y][x] over `area`

  // The channel's values [y][x]; nullptr when there is none of that name.
  const std::vector<float>* channel(std::string_view name) const {
    const int at = find(name);
    return at < 0 ? nullptr : &values[static_cast<std::size_t>(at)];
  }
};

// The same made as it is written: fill(y, rows) writes rows[channel][x - area.x0].
struct ImageRows : ImageShape {
  std::function<void(int y, std::span<const std::span<float>> rows)> fill;
};

// The image's rows; refers to it.
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
