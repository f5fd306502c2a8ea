#include "runtime/image/image_jpeg.h"
#include "tests/support/catch.h"

#include <array>
#include <cstdio>
#include <cstdlib>

// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>

namespace fathom::runtime::image_jpeg_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kMemory = 1e6;
constexpr int kSide = 24;  // more than one block, and not a multiple of the 16-pixel blocks

enum Kind { Baseline, Progressive, Arithmetic };

// The value of a sample before encoding: a ramp, steeper in each component.
int sample(int x, int y, int component) { return 40 + x * (2 + component) + y; }

Bytes encoded(int components, J_COLOR_SPACE space, Kind kind) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &out, &size);
  jpeg.image_width = jpeg.image_height = kSide;
  jpeg.input_components = components;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg.arith_code = kind == Arithmetic ? TRUE : FALSE;
  if (kind == Progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < kSide; ++y) {
    std::vector<JSAMPLE> row;
    for (int i = 0; i < kSide * components; ++i)
      row.push_back(static_cast<JSAMPLE>(sample(i / components, y, i % components)));
    JSAMPROW rows = row.data();
    jpeg_write_scanlines(&jpeg, &rows, 1);
  }
  jpeg_finish_compress(&jpeg);
  const Bytes bytes(out, out + size);
  jpeg_destroy_compress(&jpeg);
  std::free(out);
  return bytes;
}

std::string problem_of(const Bytes& bytes, double memory = kMemory) {
  const auto read = decode_jpeg(bytes, memory);
  return std::holds_alternative<std::string>(read) ? std::get<std::string>(read) : "";
}

TEST_CASE("image_jpeg: baseline and progressive, grey and coloured", "[image]") {
  for (const Kind kind : {Baseline, Progressive}) {
    for (const int components : {1, 3}) {
      CAPTURE(kind, components);
      const auto read = decode_jpeg(encoded(components, components == 1 ? JCS_GRAYSCALE : JCS_RGB, kind), kMemory);
      REQUIRE(std::holds_alternative<JpegImage>(read));
      const auto& picture = std::get<JpegImage>(read);
      REQUIRE(picture.width == kSide);
      REQUIRE(picture.height == kSide);
      REQUIRE(picture.components == components);
      REQUIRE(picture.samples.size() == static_cast<std::size_t>(kSide * kSide * components));
      for (int i = 0; i < kSide * kSide * components; ++i) {
        const int pixel = i / components, truth = sample(pixel % kSide, pixel / kSide, i % components);
        // Chroma has half the horizontal resolution.
        CHECK(std::abs(picture.samples[static_cast<std::size_t>(i)] - truth) <= 12);
      }
    }
  }
}

// Regression: stb_image made up the missing data of a truncated file, and reported nothing when an end marker
// followed.
TEST_CASE("image_jpeg: a file that is cut off is refused wherever that is", "[image]") {
  for (const Kind kind : {Baseline, Progressive}) {
    const Bytes whole = encoded(3, JCS_RGB, kind);
    REQUIRE(problem_of(whole).empty());
    for (std::size_t size = 0; size < whole.size(); ++size) {
      Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      CAPTURE(kind, size, whole.size());
      CHECK_FALSE(problem_of(part).empty());
      part.insert(part.end(), {0xff, 0xd9});
      const bool may_be_whole =
          // Exceptions: a progressive file cut after some scans, and a file that lacks only the padding of its last
          // byte.
          kind == Progressive || size + 4 > whole.size();
      if (!may_be_whole) CHECK_FALSE(problem_of(part).empty());
    }
  }
}

TEST_CASE("image_jpeg: what is not read is refused by name", "[image]") {
  CHECK(problem_of(encoded(4, JCS_CMYK, Baseline)).find("CMYK") != std::string::npos);
  CHECK(problem_of(encoded(3, JCS_RGB, Arithmetic)).find("arithmetic") != std::string::npos);
}

TEST_CASE("image_jpeg: memory is counted before it is taken", "[image]") {
  const double pixels = kSide * kSide;
  const Bytes grey = encoded(1, JCS_GRAYSCALE, Baseline), progressive = encoded(1, JCS_GRAYSCALE, Progressive);
  const double needed = static_cast<double>(grey.size()) + pixels * (1 + 12);
  CHECK(problem_of(grey, needed).empty());
  CHECK(problem_of(grey, needed - 1).find("bytes of memory") != std::string::npos);
  // For a progressive file, the decoder also holds the coefficients of all blocks.
  const double more = static_cast<double>(progressive.size()) + pixels * (1 + 12 + 2);
  CHECK(problem_of(progressive, more).empty());
  CHECK(problem_of(progressive, more - 1).find("bytes of memory") != std::string::npos);
}

}  // namespace
}  // namespace fathom::runtime::image_jpeg_test
