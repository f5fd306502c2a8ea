// Radiance's pictures of all kinds: the pixels are known beforehand, or the reason for a refusal.
#include "runtime/image/image_hdr.h"

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace fathom::runtime::image_hdr_test {
namespace {

using Values = std::vector<float>;
using Result = std::variant<FloatImage, std::string>;

// Pixels as in a file: mantissas of 256ths and an exponent, 129 for numbers below 2.
std::string pixel(int r, int g, int b, int e = 129) {
  return {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b), static_cast<char>(e)};
}
std::string grey(int mantissa) { return pixel(mantissa, mantissa, mantissa); }

Result decode(const std::string& file, double memory = 1e9) {
  return decode_hdr(std::vector<std::uint8_t>(file.begin(), file.end()), memory);
}

FloatImage image_of(const std::string& file) {
  Result result = decode(file);
  if (const auto* problem = std::get_if<std::string>(&result)) FAIL(*problem);
  return std::get<FloatImage>(std::move(result));
}

std::string problem_of(const std::string& file, double memory = 1e9) {
  const Result result = decode(file, memory);
  REQUIRE(std::holds_alternative<std::string>(result));
  return std::get<std::string>(result);
}

// A picture of one pixel of 1, 0.5, 0.25 with these lines in its header.
std::string with_lines(const std::string& lines) {
  return "#?RADIANCE\n" + lines + "\n-Y 1 +X 1\n" + pixel(128, 64, 32);
}

TEST_CASE("image_hdr: lines of the header change the light, or say nothing about it", "[image]") {
  const std::string format = "FORMAT=32-bit_rle_rgbe\n";
  const struct {
    std::string lines;
    Values light;
  } kCases[] = {
      {"", {1, 0.5f, 0.25f}},
      {format, {1, 0.5f, 0.25f}},
      {"FORMAT= 32-bit_rle_rgbe \n", {1, 0.5f, 0.25f}},
      {format + "EXPOSURE=2\n", {0.5f, 0.25f, 0.125f}},
      {format + "EXPOSURE= 0.5\n", {2, 1, 0.5f}},
      {format + "EXPOSURE=2\nEXPOSURE=4.0e0\n", {0.125f, 0.0625f, 0.03125f}},
      {format + "COLORCORR=1 2 0.5\n", {1, 0.25f, 0.5f}},
      {format + "COLORCORR= 2.0 1 1\nCOLORCORR=2 1 1\nEXPOSURE=+0.5\n", {0.5f, 1, 0.5f}},
      {format + "\tpfilt EXPOSURE=3 -1\nSOFTWARE=EXPOSURE=4\nVIEW=-vp 1 2 3\nPIXASPECT=2\n# EXPOSURE=5\n",
       {1, 0.5f, 0.25f}},
      {format + "GAMMA=1\n", {1, 0.5f, 0.25f}},
      {format + "PRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n", {1, 0.5f, 0.25f}},
      // sRGB's blue, green and red.
      {format + "PRIMARIES= 0.15 0.06  0.30 0.60  0.64 0.33  0.3127 0.3290\n", {0.25f, 0.5f, 1}},
      // IEC 61966-2-1.
      {"FORMAT=32-bit_rle_xyze\n",
       {3.2410f - 0.5f * 1.5374f - 0.25f * 0.4986f, -0.9692f + 0.5f * 1.8760f + 0.25f * 0.0416f,
        0.0556f - 0.5f * 0.2040f + 0.25f * 1.0570f}},
      {"FORMAT=32-bit_rle_xyze\nEXPOSURE=0.5\nPRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n",
       {2 * (3.2410f - 0.5f * 1.5374f - 0.25f * 0.4986f), 2 * (-0.9692f + 0.5f * 1.8760f + 0.25f * 0.0416f),
        2 * (0.0556f - 0.5f * 0.2040f + 0.25f * 1.0570f)}},
  };
  for (const auto& [lines, light] : kCases) {
    CAPTURE(lines);
    std::string file = with_lines(lines);
    for (const bool carriage_returns : {false, true}) {
      if (carriage_returns) {
        const std::size_t end = file.find("+X 1\n") + 5;
        std::string header;
        for (const char c : file.substr(0, end)) header += c == '\n' ? std::string("\r\n") : std::string(1, c);
        file = header + file.substr(end);
      }
      const FloatImage image = image_of(file);
      for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(image.values[c][0] - light[c]) < 1e-3f);
    }
  }
}

// A white whose numbers are equal in the file stays neutral: the primaries of Radiance itself have the white E.
TEST_CASE("image_hdr: another white is adapted", "[image]") {
  const FloatImage image =
      image_of("#?RADIANCE\nPRIMARIES=0.640 0.330 0.290 0.600 0.150 0.060 0.3333 0.3333\n\n-Y 1 +X 1\n" + grey(128));
  for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(image.values[c][0] - 1) < 1e-3f);
}

// Rows 1 2 3 and 4 5 6 as they are seen, in all orders of a file.
TEST_CASE("image_hdr: eight orientations", "[image]") {
  const struct {
    const char* size;
    std::vector<int> order;
  } kCases[] = {
      {"-Y 2 +X 3", {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3", {3, 2, 1, 6, 5, 4}}, {"+Y 2 +X 3", {4, 5, 6, 1, 2, 3}},
      {"+Y 2 -X 3", {6, 5, 4, 3, 2, 1}}, {"+X 3 -Y 2", {1, 4, 2, 5, 3, 6}}, {"+X 3 +Y 2", {4, 1, 5, 2, 6, 3}},
      {"-X 3 -Y 2", {3, 6, 2, 5, 1, 4}}, {"-X 3 +Y 2", {6, 3, 5, 2, 4, 1}},
  };
  for (const auto& [size, order] : kCases) {
    CAPTURE(size);
    std::string file = std::string("#?RGBE\n\n") + size + "\n";
    for (const int value : order) file += pixel(128, 128, 128, 129 + value);
    const FloatImage image = image_of(file);
    CHECK((image.width == 3 && image.height == 2));
    CHECK(image.values[1] == Values{2, 4, 8, 16, 32, 64});
  }
}

// Ten pixels, of which a run begins in the second, in all three encodings.
TEST_CASE("image_hdr: runs of bytes, runs of pixels and no runs", "[image]") {
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 10\n";
  const Values expected = {1, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.25f};
  std::string flat = grey(128);
  for (int i = 0; i < 8; ++i) flat += grey(64);
  flat += grey(32);
  CHECK(image_of(head + flat).values[0] == expected);
  CHECK(image_of(head + grey(128) + grey(64) + pixel(1, 1, 1, 7) + grey(32)).values[0] == expected);
  const std::string component = {1, char(128), char(128 + 8), 64, 1, 32}, exponent = {char(128 + 10), char(129)};
  const std::string runs = std::string("\2\2\0\12", 4) + component + component + component + exponent;
  CHECK(image_of(head + runs).values[0] == expected);
  // Two repetitions in a row: 2 + 256 x 1 pixels.
  const FloatImage image = image_of("#?RADIANCE\n\n-Y 1 +X 259\n" + grey(64) + pixel(1, 1, 1, 2) + pixel(1, 1, 1, 1));
  CHECK(image.values[2] == Values(259, 0.5f));
  // A row of the oldest kind that begins like one of runs of bytes, but with a blue above 127.
  CHECK(image_of(head + pixel(2, 2, 200) + pixel(1, 1, 1, 9)).values[2] == Values(10, 200.f / 128));
  // Exponents of 0 are black, and others reach far.
  CHECK(image_of("#?RADIANCE\n\n-Y 1 +X 2\n" + pixel(9, 9, 9, 0) + pixel(128, 0, 0, 255)).values[0] ==
        Values{0, std::ldexp(1.f, 126)});
}

TEST_CASE("image_hdr: what is not supported is named", "[image]") {
  const auto names = [](const std::string& file, const char* what) {
    CAPTURE(file, what);
    CHECK(problem_of(file).find(what) != std::string::npos);
  };
  names(with_lines("FORMAT=32-bit_rle_hsv\n"), "32-bit_rle_hsv");
  names(with_lines("FORMAT=\n"), "FORMAT");
  names(with_lines("EXPOSURE=0\n"), "EXPOSURE=0");
  names(with_lines("EXPOSURE=-1\n"), "EXPOSURE=-1");
  names(with_lines("EXPOSURE=bright\n"), "EXPOSURE=bright");
  names(with_lines("EXPOSURE=inf\n"), "EXPOSURE=inf");
  names(with_lines("EXPOSURE=1 2\n"), "EXPOSURE=1 2");
  names(with_lines("EXPOSURE=1e20\nEXPOSURE=1e20\n"), "EXPOSURE=1e20");
  names(with_lines("COLORCORR=1 1\n"), "COLORCORR");
  names(with_lines("COLORCORR=1 0 1\n"), "COLORCORR");
  names(with_lines("PRIMARIES=1 2 3\n"), "PRIMARIES");
  names(with_lines("PRIMARIES=0 0 0 0 0 0 0 0\n"), "PRIMARIES");
  names(with_lines("GAMMA=2.2\n"), "GAMMA=2.2");
  for (const char* size :
       {"-Y 1 +Y 1", "-Z 1 +X 1", "-Y 1", "Y 1 X 1", "-Y 1 +X 1 2", "-Y -1 +X 1", "-Y 1.5 +X 1", "+x 1 +y 1"}) {
    names("#?RADIANCE\n\n" + std::string(size) + "\n" + grey(9), size);
  }
  names("#?RADIANCE\n\n-Y 0 +X 4\n" + grey(9), "no pixels");
  names("#?RADIANCE\n\n-Y 99999 +X 99999\n" + grey(9), "too large");
  names("#?RADIANCE\n\n-Y 999 +X 999\n" + grey(9), "too early");
  names("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n-Y 1 +X 1\n" + grey(9), "header");
  names("#?RADIANCE\n\n-Y 1 +X 1", "header");
  names("RADIANCE\n\n-Y 1 +X 1\n" + grey(9), "header");
}

TEST_CASE("image_hdr: damaged rows, and memory", "[image]") {
  const std::string head = "#?RADIANCE\n\n-Y 1 +X 10\n";
  CHECK(problem_of(head + pixel(1, 1, 1, 9) + grey(9)).find("run") != std::string::npos);
  CHECK(problem_of(head + grey(9) + pixel(1, 1, 1, 10)).find("run") != std::string::npos);
  std::string forever = grey(9);
  for (int i = 0; i < 9; ++i) forever += pixel(1, 1, 1, 0);
  CHECK(problem_of(head + forever + pixel(1, 1, 1, 1)).find("run") != std::string::npos);
  CHECK(problem_of(head + grey(9) + grey(9) + grey(9)).find("too early") != std::string::npos);
  CHECK(problem_of(head + pixel(2, 2, 0, 9) + grey(9)).find("length") != std::string::npos);
  CHECK(problem_of(head + pixel(2, 2, 0, 10) + std::string("\0\0\0\0", 4)).find("run") != std::string::npos);
  CHECK(problem_of(head + pixel(2, 2, 0, 10) + std::string("\x8b\1\1\1", 4)).find("run") != std::string::npos);
  CHECK(problem_of(head + pixel(2, 2, 0, 10) + std::string("\x8a\1\x8a\1", 4)).find("too early") !=
        std::string::npos);
  const std::string small = with_lines("");
  CHECK(std::holds_alternative<FloatImage>(decode(small, static_cast<double>(small.size()) + 16)));
  CHECK(problem_of(small, static_cast<double>(small.size()) + 15).find("memory") != std::string::npos);
}

}  // namespace
}  // namespace fathom::runtime::image_hdr_test
