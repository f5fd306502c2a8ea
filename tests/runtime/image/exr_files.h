// OpenEXR files with any channels, windows, types and storage, written by the library's own classes.
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fathom::test::exr {

using Imath::Box2i;
using Imath::V3f;

inline constexpr int kWidth = 16, kHeight = 8;  // of the display window

// The light that every file shows, in linear sRGB: numbers that halves hold exactly.
inline V3f light_at(int x, int y) {
  return V3f(static_cast<float>(x + 1), static_cast<float>(y + 1) / 2, static_cast<float>(x + y) / 16 + 1);
}

// A channel and its number in a pixel of this light.
struct Kind {
  std::string name;
  std::function<float(V3f)> number;
  Imf::PixelType type = Imf::HALF;
  int sampling = 1;
};
inline Kind component(const std::string& name, int i, Imf::PixelType type = Imf::HALF) {
  return {name, [i](V3f light) { return light[i]; }, type};
}
inline std::vector<Kind> rgb(const std::string& layer = "", Imf::PixelType type = Imf::HALF) {
  return {component(layer + "R", 0, type), component(layer + "G", 1, type), component(layer + "B", 2, type)};
}
inline Kind constant(const std::string& name, float value) {
  return {name, [value](V3f) { return value; }};
}
inline std::vector<Kind> with(std::vector<Kind> kinds, const std::vector<Kind>& more) {
  kinds.insert(kinds.end(), more.begin(), more.end());
  return kinds;
}

struct Spec {
  std::vector<Kind> kinds = rgb();
  Box2i display{{0, 0}, {kWidth - 1, kHeight - 1}};
  Box2i data = display;
  Imf::Compression compression = Imf::NO_COMPRESSION;
  Imf::LineOrder order = Imf::INCREASING_Y;
  std::optional<Imf::LevelMode> tiles = std::nullopt;
  std::function<void(Imf::Header&)> attributes = [](Imf::Header&) {};

  Imf::Header header() const {
    Imf::Header header(display, data);
    header.compression() = compression;
    header.lineOrder() = order;
    for (const Kind& kind : kinds) {
      header.channels().insert(kind.name, Imf::Channel(kind.type, kind.sampling, kind.sampling));
    }
    if (tiles) header.setTileDescription(Imf::TileDescription(5, 3, *tiles));
    attributes(header);
    return header;
  }
};

// The pixels of a file, in the types of its channels.
struct Pixels {
  std::vector<std::vector<half>> halves;
  std::vector<std::vector<float>> floats;
  std::vector<std::vector<unsigned>> wholes;
  Imf::FrameBuffer buffer;

  explicit Pixels(const Spec& spec) {
    for (const Kind& kind : spec.kinds) {
      if (kind.type == Imf::HALF) add(spec, kind, halves);
      if (kind.type == Imf::FLOAT) add(spec, kind, floats);
      if (kind.type == Imf::UINT) add(spec, kind, wholes);
    }
  }

  template <typename T>
  void add(const Spec& spec, const Kind& kind, std::vector<std::vector<T>>& lists) {
    std::vector<T> list;
    for (int y = spec.data.min.y; y <= spec.data.max.y; y += kind.sampling) {
      for (int x = spec.data.min.x; x <= spec.data.max.x; x += kind.sampling) {
        list.push_back(static_cast<T>(kind.number(light_at(x - spec.display.min.x, y - spec.display.min.y))));
      }
    }
    lists.push_back(std::move(list));
    buffer.insert(kind.name, Imf::Slice::Make(kind.type, lists.back().data(), spec.data, sizeof(T), 0, kind.sampling,
                                              kind.sampling));
  }
};

inline void write(const std::string& path, const Spec& spec) {
  Pixels pixels(spec);
  if (!spec.tiles) {
    Imf::OutputFile file(path.c_str(), spec.header());
    file.setFrameBuffer(pixels.buffer);
    return file.writePixels(spec.data.max.y - spec.data.min.y + 1);
  }
  Imf::TiledOutputFile file(path.c_str(), spec.header());
  file.setFrameBuffer(pixels.buffer);
  const bool both = *spec.tiles == Imf::RIPMAP_LEVELS;
  for (int i = 0; i < file.numXLevels(); ++i) {
    for (int j = both ? 0 : i; j < (both ? file.numYLevels() : i + 1); ++j) {
      file.writeTiles(0, file.numXTiles(i) - 1, 0, file.numYTiles(j) - 1, i, j);
    }
  }
}

}  // namespace fathom::test::exr
