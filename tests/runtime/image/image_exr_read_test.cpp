// OpenEXR files of every kind, written by the library's own classes and read back: the numbers are known beforehand.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/image/image_exr.h"
#include "tests/fuzz/target.h"
#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::image_exr_read_test {
namespace {

constexpr int kWidth = 37, kHeight = 131, kX = -5, kY = 3;

// The same numbers in every sample type. Half is as exact as the others below 2^11.
struct FieldSamples {
  std::vector<half> halves;
  std::vector<float> floats;
  std::vector<unsigned> wholes;
};

FieldSamples random_samples() {
  test::Random random(5);
  FieldSamples samples;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const int value = random.chance(0.5) ? i % 64 : random.below(2048);
    samples.halves.emplace_back(static_cast<float>(value));
    samples.floats.push_back(std::ldexp(static_cast<float>(value), -30));
    samples.wholes.push_back(static_cast<unsigned>(value));
  }
  return samples;
}

// Places the values at the image's data window.
template <class T>
Imf::Slice slice_of(Imf::PixelType type, std::vector<T>& values) {
  return Imf::Slice::Make(type, values.data(), Imath::Box2i({kX, kY}, {kX + kWidth - 1, kY + kHeight - 1}));
}

enum class Storage { Lines, Tiles, Mipmap };

void write(const std::string& path, Storage storage, Imf::Compression compression, Imf::LineOrder order,
           FieldSamples& samples) {
  Imf::Header header(Imath::Box2i({0, 0}, {99, 199}), Imath::Box2i({kX, kY}, {kX + kWidth - 1, kY + kHeight - 1}));
  header.compression() = compression;
  header.lineOrder() = order;
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  header.channels().insert("G", Imf::Channel(Imf::FLOAT));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  Imf::FrameBuffer buffer;
  buffer.insert("R", slice_of(Imf::HALF, samples.halves));
  buffer.insert("G", slice_of(Imf::FLOAT, samples.floats));
  buffer.insert("id", slice_of(Imf::UINT, samples.wholes));
  if (storage == Storage::Lines) {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    return file.writePixels(kHeight);
  }
  header.setTileDescription(
      Imf::TileDescription(16, 24, storage == Storage::Mipmap ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL));
  Imf::TiledOutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  for (int level = 0; level < file.numLevels(); ++level) {
    file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  }
}

TEST_CASE("image_exr_read: lines and tiles, every type of sample, every compression", "[image]") {
  const test::TemporaryFolder folder;
  FieldSamples samples = random_samples();
  for (const Storage storage : {Storage::Lines, Storage::Tiles, Storage::Mipmap}) {
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION}) {
      for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
        CAPTURE(static_cast<int>(storage), compression, order);
        write(folder.file("a.exr"), storage, compression, order, samples);
        const auto read = decode_exr(fuzz::read_file(folder.file("a.exr")));
        if (const auto* problem = std::get_if<std::string>(&read)) FAIL(*problem);
        const auto& image = std::get<FloatImage>(read);
        CHECK(image.width == 100);
        CHECK(image.height == 200);
        REQUIRE(image.area == PixelRect{kX, kY, kX + kWidth, kY + kHeight});
        const std::vector<float> wholes(samples.wholes.begin(), samples.wholes.end());
        CHECK((image.values[static_cast<std::size_t>(image.find("G"))] == samples.floats));
        CHECK((image.values[static_cast<std::size_t>(image.find("id"))] == wholes));
        // B44 rounds halves.
        if (compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION) continue;
        CHECK((image.values[static_cast<std::size_t>(image.find("R"))] == wholes));
      }
    }
  }
}

TEST_CASE("image_exr_read: DWA is refused, and so is a chunk that ends early", "[image]") {
  const test::TemporaryFolder folder;
  FieldSamples samples = random_samples();
  const auto problem_of = [&](const std::vector<std::uint8_t>& bytes) {
    const auto read = decode_exr(bytes);
    REQUIRE(std::holds_alternative<std::string>(read));
    return std::get<std::string>(read);
  };
  write(folder.file("a.exr"), Storage::Lines, Imf::DWAA_COMPRESSION, Imf::INCREASING_Y, samples);
  CHECK(problem_of(fuzz::read_file(folder.file("a.exr"))).find("DWA") != std::string::npos);
  write(folder.file("a.exr"), Storage::Lines, Imf::ZIP_COMPRESSION, Imf::INCREASING_Y, samples);
  std::vector<std::uint8_t> bytes = fuzz::read_file(folder.file("a.exr"));
  bytes.resize(bytes.size() - 100);
  problem_of(bytes);
  // The last chunk, of three lines: its data has the declared length, but is a zlib stream of no bytes.
  bytes = fuzz::read_file(folder.file("a.exr"));
  const std::uint8_t line[] = {kY + 128, 0, 0, 0}, nothing[] = {0x78, 0xda, 0x03, 0, 0, 0, 0, 0x01};
  const auto chunk = std::find_end(bytes.begin(), bytes.end(), std::begin(line), std::end(line));
  REQUIRE(bytes.end() - chunk > 16);
  std::copy(std::begin(nothing), std::end(nothing), chunk + 8);
  problem_of(bytes);
}

}  // namespace
}  // namespace fathom::runtime::image_exr_read_test
