#include "runtime/image/image_read.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "compiler/scene/srgb.h"
#include "runtime/film/film_layers.h"
#include "runtime/image/image_io.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::image_read_test {
namespace {

// 16 x 9 pixels that get brighter and bluer. The last pixel has no hit.
Film ramp() {
  Film film(16, 9);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 16; ++x) {
      PathSample sample;
      sample.radiance = glm::vec3(static_cast<float>(x) / 15, static_cast<float>(y) / 8, 0.37f);
      sample.hit = x + y < 23;
      sample.albedo = glm::vec3(0.25f, 0.5f, 0.75f);
      sample.normal = glm::vec3(0, -0.6f, 0.8f);
      sample.depth = 1 + x + y;
      film.add(x, y, sample);
    }
  }
  return film;
}

// Returns the largest error of channels R, G, B of a layer that was written and read.
double error_of(const test::TemporaryFolder& folder, const std::string& name, Layer layer, int bits = 8) {
  const Film film = ramp();
  const LayerValues values = layer_of(film, layer);
  REQUIRE(write_layer(values, {{}, bits}, folder.file(name)) == std::nullopt);
  const auto read = read_image(folder.file(name));
  REQUIRE(std::holds_alternative<FloatImage>(read));
  const auto& image = std::get<FloatImage>(read);
  REQUIRE(image.area == film.area());
  REQUIRE(image.channels.size() == 3);
  double worst = 0;
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 16; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = static_cast<double>(image.values[c][image.area.index(x, y)]);
        const double truth = static_cast<double>(values.at(x, y)[static_cast<int>(c)]);
        worst = std::max(worst, std::abs(value - truth));
      }
    }
  }
  return worst;
}

TEST_CASE("image_read: what is written comes back as exactly as its format says", "[image]") {
  const test::TemporaryFolder folder;
  // Half a step of 8 or 16 bits, times the steepest slope of the sRGB decoding, 2.3 at white.
  CHECK(error_of(folder, "a.png", Layer::Beauty) <= 2.3 / 255 / 2);
  CHECK(error_of(folder, "b.png", Layer::Beauty, 16) <= 2.3 / 65535 / 2 + 1e-7);
  CHECK(error_of(folder, "a.bmp", Layer::Beauty) <= 2.3 / 255 / 2);
  CHECK(error_of(folder, "a.jpg", Layer::Beauty) <= 0.1);
  CHECK(error_of(folder, "a.pfm", Layer::Beauty) == 0);
  CHECK(error_of(folder, "n.pfm", Layer::Normal) == 0);
  CHECK(error_of(folder, "d.pfm", Layer::Depth) == 0);  // stored as grey
  CHECK(error_of(folder, "a.hdr", Layer::Beauty) <= 1.0 / 128);
  CHECK(error_of(folder, "b.png", Layer::Beauty, 16) > 0);
}

TEST_CASE("image_read: 8 bits are the nearest bytes", "[image]") {
  const test::TemporaryFolder folder;
  ByteImage picture{256, 1, {}};
  for (int i = 0; i < 256; ++i) picture.rgb.insert(picture.rgb.end(), 3, static_cast<std::uint8_t>(i));
  for (const char* name : {"a.png", "a.bmp"}) {
    REQUIRE(write_image(picture, folder.file(name)) == std::nullopt);
    const auto image = std::get<FloatImage>(read_image(folder.file(name)));
    for (std::size_t i = 0; i < 256; ++i) {
      CHECK(image.values[1][i] == static_cast<float>(compiler::srgb_decode(static_cast<double>(i) / 255)));
    }
  }
}

// Decodes two hexadecimal digits per byte.
std::string bytes_of(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

FloatImage image_of(const test::TemporaryFolder& folder, std::string_view name, std::string_view digits) {
  std::ofstream(folder.file(std::string(name)), std::ios::binary) << bytes_of(digits);
  const auto read = read_image(folder.file(std::string(name)));
  if (const auto* unread = std::get_if<ImageReadError>(&read)) FAIL(unread->problem);
  return std::get<FloatImage>(read);
}

TEST_CASE("image_read: every kind of png", "[image]") {
  const test::TemporaryFolder folder;
  using Values = std::vector<std::vector<float>>;
  CHECK(image_of(
            folder, "grey-of-1-bit.png",
            "89504e470d0a1a0a0000000d4948445200000003000000010100000000339b29190000000a4944415478da6358000000a200a1"
            "7105cb410000000049454e44ae426082")
            .values == Values{{1, 0, 1}, {1, 0, 1}, {1, 0, 1}});
  CHECK(image_of(
            folder, "palette-with-alpha.png",
            "89504e470d0a1a0a0000000d4948445200000002000000010803000000c3fc8fb800000006504c5445ff000000ff00d287ef71"
            "0000000174524e5380ad5e5b460000000b4944415478da63606400000005000242c2449f0000000049454e44ae426082")
            .values == Values{{0, 1}, {1, 0}, {0, 0}, {1, 128.f / 255}});
  CHECK(image_of(
            folder, "grey-and-alpha-of-16-bits.png",
            "89504e470d0a1a0a0000000d4948445200000001000000011004000000e58cd0410000000d4944415478da63f8ffdf81010007"
            "7e023fea81688e0000000049454e44ae426082")
            .values == Values{{1}, {1}, {1}, {0x4000 / 65535.f}});
  // The content, not the file name, decides the format.
  CHECK(image_of(
            folder, "interlaced.jpg",
            "89504e470d0a1a0a0000000d49484452000000020000000208020000018ad3aae50000000f4944415478da63f8cf0004100208"
            "0020ee05fb4c50558d0000000049454e44ae426082")
            .values == Values{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}});
  CHECK(image_of(
            folder, "more-data-than-a-picture.png",
            "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b550000001c4944415478daedc1210100000002"
            "20ff9fd61536200d0000000070378a1e0100cb6d2efe0000000049454e44ae426082")
            .values == Values{{1}, {1}, {1}});
}

// libpng accepts the first three as whole images and leaves the pixels without data black.
TEST_CASE("image_read: a png whose data ends before its picture is refused", "[image]") {
  const test::TemporaryFolder folder;
  const auto problem_of = [&](std::string_view digits) {
    std::ofstream(folder.file("a.png"), std::ios::binary) << bytes_of(digits);
    const auto read = read_image(folder.file("a.png"));
    REQUIRE(std::holds_alternative<ImageReadError>(read));
    return std::get<ImageReadError>(read).problem;
  };
  const std::string_view
      half =
          "89504e470d0a1a0a0000000d49484452000000030000000408000000006e46dadb0000000e4944415478da63606462660062"
          "000034000d6e4bc9860000000049454e44ae426082",
      none =
          "89504e470d0a1a0a0000000d49484452000000030000000408000000006e46dadb000000084944415478da0300000000016f"
          "ddc9910000000049454e44ae426082",
      nonsense_after_half =
          "89504e470d0a1a0a0000000d49484452000000030000000408000000006e46dadb000000134944415478da62606462660062"
          "00000000ffffffffffffbed4fe120000000049454e44ae426082",
      one_row_of_interlaced =
          "89504e470d0a1a0a0000000d49484452000000030000000408000000011941ea4d0000000a4944415478da63600400000300"
          "02e67da7670000000049454e44ae426082",
      of_30000_by_30000 =
          "89504e470d0a1a0a0000000d4948445200007530000075300800000000434ca7660000000949444154789c63000000010001"
          "5eff7df90000000049454e44ae426082";
  for (const std::string_view digits : {half, none, nonsense_after_half, one_row_of_interlaced}) {
    INFO(digits);
    CHECK(problem_of(digits).find("too early") != std::string::npos);
  }
  CHECK(problem_of(of_30000_by_30000).find("too large") != std::string::npos);
}

// R, G and B are each a copy of grey.
TEST_CASE("image_read: the memory of a grey picture is counted before it is taken", "[image]") {
  const test::TemporaryFolder folder;
  const std::string png = bytes_of(
      "89504e470d0a1a0a0000000d4948445200000003000000010100000000339b29190000000a4944415478da6358000000a200a1"
      "7105cb410000000049454e44ae426082");
  std::ofstream(folder.file("a.png"), std::ios::binary) << png;
  const std::string pfm = "Pf\n3 1\n-1.0\n" + std::string(12, '\0');
  std::ofstream(folder.file("a.pfm"), std::ios::binary) << pfm;
  for (const auto& [name, needed] :
       {std::pair{"a.png", png.size() + 3 * (2 + 12)}, {"a.pfm", pfm.size() + 3 * (4 + 12)}}) {
    INFO(name);
    CHECK(std::holds_alternative<FloatImage>(read_image(folder.file(name), {static_cast<double>(needed)})));
    CHECK(std::holds_alternative<ImageReadError>(read_image(folder.file(name), {static_cast<double>(needed) - 1})));
  }
}

TEST_CASE("image_read: a float map of either byte order", "[image]") {
  const test::TemporaryFolder folder;
  std::ofstream(folder.file("a.pfm"), std::ios::binary)
      << "PF\n1 2\n1.0\n"
      << std::string("\x3f\x80\0\0\x40\0\0\0\x40\x40\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 24);
  const auto image = std::get<FloatImage>(read_image(folder.file("a.pfm")));
  CHECK(image.height == 2);
  CHECK(image.values[0] == std::vector<float>{0, 1});  // the file starts with the lower row
  CHECK(image.values[2] == std::vector<float>{0, 3});
}

TEST_CASE("image_read: what cannot be read is refused with its name and a reason", "[image]") {
  const test::TemporaryFolder folder;
  const auto problem = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.file(name), std::ios::binary) << text;
    const auto read = read_image(folder.file(name));
    REQUIRE(std::holds_alternative<ImageReadError>(read));
    CHECK_FALSE(std::get<ImageReadError>(read).missing);
    CHECK(std::get<ImageReadError>(read).problem.find(name) != std::string::npos);
    return std::get<ImageReadError>(read).problem;
  };
  for (const char* name : {"a.png", "a.jpg", "a.bmp", "a.exr", "a.pfm", "a.hdr"}) {
    problem(name, "");
    problem(name, "not a picture at all");
  }
  // Past the end of an .hdr file, stb_image would read run lengths forever. In other formats, it would make up rows.
  for (const char* name : {"e.hdr", "e.bmp", "e.png", "e.jpg", "e.pfm"}) {
    REQUIRE(write_layer(layer_of(ramp(), Layer::Beauty), {}, folder.file(name)) == std::nullopt);
    std::ifstream file(folder.file(name), std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(file), {});
    for (const std::size_t part : {whole.size() / 4, whole.size() / 2, whole.size() - 3}) {
      CAPTURE(part);
      problem(name, whole.substr(0, part));
    }
  }
  CHECK(problem("a.tga", "x").find(".exr") != std::string::npos);
  CHECK(problem("b.pfm", "PF\n2 2\n-1.0\n1234").find("too early") != std::string::npos);
  CHECK(problem("c.pfm", "PF\n2000000 2000000\n-1.0\n1234").find("too large") != std::string::npos);
  // A factor that is no float made every 0 a NaN.
  for (const char* factor : {"-1e40", "-1e-50"}) {
    CHECK(problem("e.pfm", std::string("Pf\n1 1\n") + factor + "\n1234").find("header") != std::string::npos);
  }
  CHECK(problem("d.pfm", "PF\n-2 2\n-1.0\n1234").find("header") != std::string::npos);
  const auto missing = read_image(folder.file("none.png"));
  REQUIRE(std::holds_alternative<ImageReadError>(missing));
  CHECK(std::get<ImageReadError>(missing).missing);
  CHECK(std::get<ImageReadError>(missing).problem.find("No such file") != std::string::npos);
  std::filesystem::create_directory(folder.file("folder.png"));
  CHECK(std::get<ImageReadError>(read_image(folder.file("folder.png"))).missing);
  CHECK(std::get<ImageReadError>(read_image("folder/.")).problem.find("format") != std::string::npos);
}

}  // namespace
}  // namespace fathom::runtime::image_read_test
