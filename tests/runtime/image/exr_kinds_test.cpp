// OpenEXR files of all kinds of headers, written by the library's own classes and read as pictures: the pixels are
// known beforehand, or the reason for a refusal.
#include <ImfChromaticitiesAttribute.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfEnvmapAttribute.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfRgbaYca.h>
#include <ImfStandardAttributes.h>
#include <ImfStringVectorAttribute.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "runtime/image/color_space.h"
#include "runtime/image/image_read.h"
#include "runtime/light/environment_map.h"
#include "tests/runtime/image/exr_files.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::exr_kinds_test {
namespace {

using namespace test::exr;

FloatImage picture(const std::string& path) {
  auto read = read_image(path);
  if (const auto* unread = std::get_if<ImageReadError>(&read)) FAIL(unread->problem);
  return std::get<FloatImage>(std::move(read));
}

// Checks the light of the display window: what `data` does not have is black.
void check_light(const FloatImage& image, const Spec& spec, const std::function<V3f(V3f)>& shown) {
  REQUIRE(image.area == PixelRect{0, 0, kWidth, kHeight});
  double worst = 0;
  const std::vector<float>* channels[] = {image.channel("R"), image.channel("G"), image.channel("B")};
  REQUIRE((channels[0] && channels[1] && channels[2]));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool has = spec.data.intersects(Imath::V2i(x, y) + spec.display.min);
      const V3f right = has ? shown(light_at(x, y)) : V3f(0);
      for (int c = 0; c < 3; ++c) {
        const double value = static_cast<double>((*channels[c])[image.area.index(x, y)]);
        const double truth = static_cast<double>(right[c]);
        worst = std::max(worst, std::abs(value - truth) / std::max(1.0, std::abs(truth)));
      }
    }
  }
  CHECK(worst < 1e-3);
}

struct ReadCase {
  std::string name;
  Spec spec;
  std::function<V3f(V3f)> shown = [](V3f light) { return light; };
};

Spec crop(int x0, int y0, int x1, int y1, Box2i display = Spec().display) {
  Spec spec;
  spec.display = display;
  spec.data = Box2i(display.min + Imath::V2i(x0, y0), display.min + Imath::V2i(x1 - 1, y1 - 1));
  return spec;
}

TEST_CASE("exr kinds: data windows within, around, across and beside the display window", "[image]") {
  const Box2i moved({-7, 30}, {-7 + kWidth - 1, 30 + kHeight - 1});
  const std::vector<ReadCase> cases = {
      {"equal", crop(0, 0, kWidth, kHeight)},
      {"equal, not at zero", crop(0, 0, kWidth, kHeight, moved)},
      {"left half", crop(0, 0, 8, kHeight)},
      {"inside", crop(3, 2, 9, 5)},
      {"inside, not at zero", crop(3, 2, 9, 5, moved)},
      {"one pixel", crop(15, 7, 16, 8)},
      {"around", crop(-2, -3, kWidth + 5, kHeight + 1)},
      {"across the corner", crop(-3, -2, 4, 3, moved)},
      {"across the right side", crop(10, 1, 20, 4)},
      {"beside", crop(20, 0, 30, 8)},
      {"above", crop(0, -8, 16, 0)},
  };
  const test::TemporaryFolder folder;
  for (const ReadCase& one : cases) {
    CAPTURE(one.name);
    write(folder.file("a.exr"), one.spec);
    check_light(picture(folder.file("a.exr")), one.spec, one.shown);
  }
}

TEST_CASE("exr kinds: a display window far larger than the data is refused", "[image]") {
  const test::TemporaryFolder folder;
  write(folder.file("a.exr"), crop(0, 0, 2, 2, Box2i({0, 0}, {4095, 4095})));
  const auto read = read_image(folder.file("a.exr"));
  REQUIRE(std::holds_alternative<ImageReadError>(read));
  CHECK(std::get<ImageReadError>(read).problem.find("display window of 4096 by 4096") != std::string::npos);
  // A crop of a large picture is a picture.
  write(folder.file("a.exr"), crop(0, 0, 2, 2, Box2i({0, 0}, {2047, 1023})));
  CHECK(picture(folder.file("a.exr")).area == PixelRect{0, 0, 2048, 1024});
}

TEST_CASE("exr kinds: compressions, orders, storage and types", "[image]") {
  std::vector<ReadCase> cases;
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                             Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION}) {
    Spec spec = crop(2, 1, 15, 8);
    spec.compression = compression;
    cases.push_back({"compression " + std::to_string(compression), spec});
  }
  for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
    Spec spec = crop(2, 1, 15, 8);
    spec.tiles = mode;
    cases.push_back({"tiles of mode " + std::to_string(mode), spec});
  }
  Spec spec;
  spec.order = Imf::DECREASING_Y;
  spec.compression = Imf::ZIPS_COMPRESSION;
  cases.push_back({"from below", spec});
  spec = Spec();
  spec.kinds = rgb("", Imf::FLOAT);
  cases.push_back({"floats", spec});
  spec.kinds = rgb("", Imf::UINT);
  cases.push_back({"whole numbers", spec,
                   [](V3f light) { return V3f(std::floor(light.x), std::floor(light.y), std::floor(light.z)); }});
  spec.kinds = {component("R", 0), component("G", 1, Imf::FLOAT), component("B", 2), constant("A", 0.5f)};
  cases.push_back({"mixed types, and alpha", spec});
  spec = Spec();
  spec.attributes = [](Imf::Header& header) {
    header.pixelAspectRatio() = 2;
    Imf::addWhiteLuminance(header, 80);
    Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
    Imf::addMultiView(header, {"right", "left"});
  };
  spec.kinds = with(rgb(), {constant("left.R", 9), constant("left.G", 9), constant("left.B", 9), constant("Z", 3)});
  cases.push_back({"other attributes, views and depth", spec});
  const test::TemporaryFolder folder;
  for (const ReadCase& one : cases) {
    CAPTURE(one.name);
    write(folder.file("a.exr"), one.spec);
    check_light(picture(folder.file("a.exr")), one.spec, one.shown);
  }
}

TEST_CASE("exr kinds: grey, and layers", "[image]") {
  const auto grey = [](V3f light) { return V3f(light.x); };
  const std::vector<ReadCase> cases = {
      {"grey", {{component("Y", 0)}}, grey},
      {"grey of floats, and alpha", {{component("Y", 0, Imf::FLOAT), constant("A", 1)}}, grey},
      {"a layer", {rgb("beauty.")}},
      {"a layer in a layer, and depth", {with(rgb("View.Combined."), {constant("View.Depth.Z", 2)})}},
      {"a grey layer", {{component("beauty.Y", 0)}}, grey},
      {"a layer beside a picture", {with(rgb(), {constant("a.R", 7), constant("a.G", 7), constant("a.B", 7)})}},
      {"a layer beside vectors", {with(rgb("a."), {constant("N.X", 7), constant("N.Y", 7), constant("N.Z", 7)})}},
      {"colours and luminance", {with(rgb(), {constant("Y", 7)})}},
  };
  const test::TemporaryFolder folder;
  for (const ReadCase& one : cases) {
    CAPTURE(one.name);
    write(folder.file("a.exr"), one.spec);
    check_light(picture(folder.file("a.exr")), one.spec, one.shown);
    CHECK(std::holds_alternative<EnvironmentImage>(read_environment(folder.file("a.exr"))));
  }
}

// Numbers whose conversion gives the light: the inverse matrix is the library's, which does not adapt whites.
Spec in_primaries(const Chromaticities& c, bool is_xyz = false) {
  const auto v = [](glm::dvec2 xy) { return Imath::V2f(static_cast<float>(xy.x), static_cast<float>(xy.y)); };
  const Imf::Chromaticities file(v(c.red), v(c.green), v(c.blue), v(c.white)), srgb;
  const Imath::M44f matrix = is_xyz ? Imf::RGBtoXYZ(srgb, 1) : Imf::RGBtoXYZ(srgb, 1) * Imf::XYZtoRGB(file, 1);
  Spec spec;
  spec.kinds.clear();
  for (int i = 0; i < 3; ++i) {
    const char* names[] = {"R", "G", "B"};
    spec.kinds.push_back({names[i], [matrix, i](V3f light) { return (light * matrix)[i]; }, Imf::FLOAT});
  }
  spec.attributes = [file](Imf::Header& header) { Imf::addChromaticities(header, file); };
  return spec;
}

TEST_CASE("exr kinds: other primaries", "[image]") {
  const Chromaticities srgb;
  const glm::dvec2 d65 = srgb.white;
  const std::vector<ReadCase> cases = {
      {"Rec. 709", in_primaries(srgb)},
      {"a permutation", in_primaries({srgb.blue, srgb.green, srgb.red, d65})},
      {"another permutation", in_primaries({srgb.green, srgb.blue, srgb.red, d65})},
      {"Rec. 2020", in_primaries({{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65})},
      {"P3-D65", in_primaries({{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65})},
      {"Adobe RGB", in_primaries({{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, d65})},
      {"XYZ", in_primaries(kCieXyz, true)},
  };
  const test::TemporaryFolder folder;
  for (const ReadCase& one : cases) {
    CAPTURE(one.name);
    write(folder.file("a.exr"), one.spec);
    check_light(picture(folder.file("a.exr")), one.spec, one.shown);
  }
  // Neutral under another white: ACES 2065-1 and ACEScg of D60, ProPhoto of D50.
  for (const Chromaticities& other : {Chromaticities{{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}},
                                      {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}},
                                      {{0.7347, 0.2653}, {0.1596, 0.8404}, {0.0366, 0.0001}, {0.3457, 0.3585}}}) {
    CAPTURE(to_text(other));
    Spec spec = in_primaries(other);
    spec.kinds = {component("R", 0), component("G", 0), component("B", 0)};
    write(folder.file("a.exr"), spec);
    check_light(picture(folder.file("a.exr")), spec, [](V3f light) { return V3f(light.x); });
  }
}

// The library's own reader is the reference: chroma has a quarter of the pixels, and neither reader knows the rest.
TEST_CASE("exr kinds: luminance and chroma", "[image]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.exr");
  const Imf::Chromaticities xyz({1, 0}, {0, 1}, {0, 0}, {1.f / 3, 1.f / 3});
  for (const Imf::RgbaChannels channels : {Imf::WRITE_YC, Imf::WRITE_YCA, Imf::WRITE_Y}) {
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
      for (const bool in_xyz : {false, true}) {
        CAPTURE(channels, compression, in_xyz);
        const Box2i window({0, 0}, {kWidth - 1, kHeight - 1});
        Imf::Header header(window, window);
        header.compression() = compression;
        if (in_xyz) Imf::addChromaticities(header, xyz);
        std::vector<Imf::Rgba> written, expected(kWidth * kHeight);
        for (int i = 0; i < kWidth * kHeight; ++i) {
          const V3f light = light_at(i % kWidth, i / kWidth);
          written.emplace_back(light.x, light.y, light.z, 1);
        }
        {
          Imf::RgbaOutputFile file(path.c_str(), header, channels);
          file.setFrameBuffer(written.data(), 1, kWidth);
          file.writePixels(kHeight);
        }
        Imf::RgbaInputFile file(path.c_str());
        file.setFrameBuffer(expected.data(), 1, kWidth);
        file.readPixels(0, kHeight - 1);
        const FloatImage image = picture(path);
        const glm::dmat3 matrix = in_xyz ? *to_srgb(kCieXyz) : glm::dmat3(1);
        const std::vector<float>*red = image.channel("R"), *green = image.channel("G"), *blue = image.channel("B");
        REQUIRE((red && green && blue));
        for (std::size_t i = 0; i < expected.size(); ++i) {
          const glm::dvec3 right = matrix * glm::dvec3(expected[i].r, expected[i].g, expected[i].b);
          const glm::dvec3 error = glm::dvec3((*red)[i], (*green)[i], (*blue)[i]) - right;
          CAPTURE(i);
          for (int c = 0; c < 3; ++c) CHECK(std::abs(error[c]) < 1e-3 * std::max(1.0, std::abs(right[c])));
        }
      }
    }
  }
}

TEST_CASE("exr kinds: chroma for every pixel, and in a layer", "[image]") {
  const test::TemporaryFolder folder;
  const V3f weights = Imf::RgbaYca::computeYw(Imf::Chromaticities());
  const auto luminance = [weights](V3f light) { return light.dot(weights); };
  Spec spec;
  spec.kinds = {{"left.Y", luminance},
                {"left.RY", [=](V3f light) { return light.x / luminance(light) - 1; }},
                {"left.BY", [=](V3f light) { return light.z / luminance(light) - 1; }}};
  write(folder.file("a.exr"), spec);
  const FloatImage image = picture(folder.file("a.exr"));
  const std::vector<float>& green = *image.channel("G");
  for (int x = 0; x < kWidth; ++x) {
    CAPTURE(x);
    // Halves round the luminance, of which green is what red and blue leave.
    CHECK(std::abs(green[static_cast<std::size_t>(x)] - light_at(x, 0).y) < 1e-2f);
  }
}

// Chroma for every pixel went through halfs: a sun above 65504 had an infinite luminance, and no green.
TEST_CASE("exr kinds: luminance and chroma of floats keep the light of a sun", "[image]") {
  const test::TemporaryFolder folder;
  Spec spec;
  spec.kinds = {constant("Y", 1e6f), constant("RY", 0.5f), constant("BY", -0.25f)};
  for (Kind& kind : spec.kinds) kind.type = Imf::FLOAT;
  write(folder.file("a.exr"), spec);
  const FloatImage image = picture(folder.file("a.exr"));
  const V3f weights = Imf::RgbaYca::computeYw(Imf::Chromaticities());
  CHECK(image.channel("R")->front() == Approx(1.5e6));
  CHECK(image.channel("G")->front() == Approx((1e6 - 1.5e6 * weights.x - 0.75e6 * weights.z) / weights.y));
  CHECK(image.channel("B")->front() == Approx(0.75e6));
}

// Writes the picture as one part and 7 as the others, in this order of channels.
void write_parts(const std::string& path, const std::vector<std::vector<Kind>>& parts) {
  std::vector<Imf::Header> headers;
  std::vector<Spec> specs;
  for (const std::vector<Kind>& kinds : parts) {
    Spec spec;
    spec.kinds = kinds;
    Imf::Header header = spec.header();
    header.setName("part" + std::to_string(headers.size()));
    header.setType(Imf::SCANLINEIMAGE);
    headers.push_back(header);
    specs.push_back(spec);
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < specs.size(); ++i) {
    Pixels pixels(specs[i]);
    Imf::OutputPart part(file, static_cast<int>(i));
    part.setFrameBuffer(pixels.buffer);
    part.writePixels(kHeight);
  }
}

TEST_CASE("exr kinds: of several parts, the first with colours is read", "[image]") {
  const test::TemporaryFolder folder;
  const std::vector<Kind> sevens = {constant("R", 7), constant("G", 7), constant("B", 7)}, depth = {constant("Z", 7)};
  for (const auto& parts : {std::vector<std::vector<Kind>>{rgb(), sevens},
                            {rgb(), depth},
                            {depth, rgb(), sevens},
                            {depth, depth, rgb("beauty.")}}) {
    write_parts(folder.file("a.exr"), parts);
    check_light(picture(folder.file("a.exr")), Spec(), [](V3f light) { return light; });
  }
}

void write_deep(const std::string& path) {
  Spec spec;
  Imf::Header header = spec.header();
  header.setType(Imf::DEEPSCANLINE);
  Imf::DeepScanLineOutputFile file(path.c_str(), header);
  std::vector<unsigned> counts(kWidth * kHeight, 1);
  std::vector<half> samples(kWidth * kHeight, half(1.f));
  std::vector<half*> places;
  for (half& sample : samples) places.push_back(&sample);
  Imf::DeepFrameBuffer buffer;
  buffer.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), spec.data));
  for (const Kind& kind : spec.kinds) {
    buffer.insert(kind.name, Imf::DeepSlice(Imf::HALF, reinterpret_cast<char*>(places.data()), sizeof(half*),
                                            sizeof(half*) * kWidth, sizeof(half)));
  }
  file.setFrameBuffer(buffer);
  file.writePixels(kHeight);
}

TEST_CASE("exr kinds: what cannot be a background is refused with the reason", "[image]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.exr");
  const auto refused = [&](const std::string& reason) {
    CAPTURE(reason);
    const auto read = read_environment(path);
    REQUIRE(std::holds_alternative<ImageReadError>(read));
    const ImageReadError& error = std::get<ImageReadError>(read);
    CAPTURE(error.problem);
    CHECK_FALSE(error.missing);
    CHECK(error.problem.find(reason) != std::string::npos);
  };
  Spec spec;
  spec.attributes = [](Imf::Header& header) { Imf::addEnvmap(header, Imf::ENVMAP_CUBE); };
  write(path, spec);
  refused("cube");
  CHECK(picture(path).area.pixels() == kWidth * kHeight);  // the faces are a picture for tonemap and diff
  for (const Imf::Compression compression : {Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    spec = Spec();
    spec.compression = compression;
    write(path, spec);
    refused("DWA");
  }
  for (const Imf::Chromaticities& bad :
       {Imf::Chromaticities({0, 0}, {0, 0}, {0, 0}, {0, 0}),
        Imf::Chromaticities({0.6f, 0.3f}, {0.6f, 0.3f}, {0.1f, 0.1f}, {0.3f, 0.3f}),
        Imf::Chromaticities({NAN, 0.3f}, {0.3f, 0.6f}, {0.1f, 0.1f}, {0.3f, 0.3f})}) {
    spec = Spec();
    spec.attributes = [&](Imf::Header& header) { Imf::addChromaticities(header, bad); };
    write(path, spec);
    refused("chromaticities");
  }
  write(path, {with(rgb("a."), rgb("b."))});
  refused("its channels: a.B, a.G, a.R, b.B, b.G, b.R");
  write(path, {{constant("Z", 1)}});
  refused("its channels: Z");
  write(path, {{constant("R", 1)}});
  refused("its channels: R");
  spec = Spec();
  for (Kind& kind : spec.kinds) kind.sampling = 2;
  write(path, spec);
  refused("`B` is subsampled by 2 and 2");
  spec.kinds = {constant("Y", 1), constant("RY", 1), constant("BY", 1)};
  spec.kinds[1].sampling = spec.kinds[2].sampling = 4;
  write(path, spec);
  refused("`BY` is subsampled by 4 and 4");
  spec.kinds = {constant("RY", 1), constant("BY", 1)};
  spec.kinds[0].sampling = spec.kinds[1].sampling = 2;
  write(path, spec);
  refused("no luminance");
  write_deep(path);
  refused("deep");
}

TEST_CASE("exr kinds: NaN and infinity are named", "[image]") {
  const test::TemporaryFolder folder;
  Spec spec;
  spec.kinds[1].number = [](V3f light) { return light.x == 3 && light.y == 1 ? NAN : light.y; };
  spec.kinds[2].number = [](V3f light) { return light.x > 15 ? INFINITY : light.z; };
  for (const bool in_primaries : {false, true}) {
    if (in_primaries) {
      spec.attributes = [](Imf::Header& header) {
        Imf::addChromaticities(header, Imf::Chromaticities({0.7f, 0.3f}, {0.2f, 0.7f}, {0.1f, 0.1f}, {0.3f, 0.3f}));
      };
    }
    write(folder.file("a.exr"), spec);
    const auto read = read_background(folder.file("a.exr"), {});
    REQUIRE(std::holds_alternative<std::shared_ptr<const EnvironmentMap>>(read));
    const std::string& warning = std::get<std::shared_ptr<const EnvironmentMap>>(read)->warning;
    CHECK(warning.starts_with("the scene's background: `"));
    CHECK(warning.find("1 pixel with NaN and 8 pixels with infinity, the first in column 15 of row 0") !=
          std::string::npos);
  }
  write(folder.file("a.exr"), Spec());
  CHECK(std::get<EnvironmentImage>(read_environment(folder.file("a.exr"))).warning.empty());
}

}  // namespace
}  // namespace fathom::runtime::exr_kinds_test
