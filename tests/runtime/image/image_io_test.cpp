#include "runtime/image/image_io.h"

#include <cstring>
#include <fstream>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::image_io_test {
namespace {

ByteImage gradient(int width, int height) {
  ByteImage picture{width, height, {}};
  for (int i = 0; i < width * height * 3; ++i) picture.rgb.push_back(static_cast<std::uint8_t>(i));
  return picture;
}

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("image_io: the ending chooses the format, in any case", "[image]") {
  const auto format = [](const char* path) { return image_format_of(path)->format; };
  CHECK(format("a.png") == ImageFormat::Png);
  CHECK(format("dir.x/a.PNG") == ImageFormat::Png);
  CHECK(format("a.b.Jpg") == ImageFormat::Jpeg);
  CHECK(format("a.jpeg") == ImageFormat::Jpeg);
  CHECK(format("a.BMP") == ImageFormat::Bmp);
  CHECK(format("a.Exr") == ImageFormat::Exr);
  CHECK(format("a.pfm") == ImageFormat::Pfm);
  CHECK(format("a.hdr") == ImageFormat::Hdr);
  for (const char* bad : {"a", "a.", "png", "a.gif", "a.png/b", "a.pngx"}) CHECK_FALSE(image_format_of(bad));
}

TEST_CASE("image_io: each file has its format's header, and the size", "[image]") {
  const test::TemporaryFolder folder;
  const ByteImage picture = gradient(7, 5);
  CHECK(write_image(picture, folder.file("a.png")) == std::nullopt);
  CHECK(write_image(picture, folder.file("a.jpg")) == std::nullopt);
  CHECK(write_image(picture, folder.file("a.bmp")) == std::nullopt);
  CHECK(folder.files() == 3);
  const std::string png = read(folder.file("a.png")), jpg = read(folder.file("a.jpg")),
                    bmp = read(folder.file("a.bmp"));
  CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  CHECK(png[19] == 7);
  CHECK(png[23] == 5);
  CHECK(jpg.substr(0, 3) == "\xff\xd8\xff");
  CHECK(bmp.substr(0, 2) == "BM");
  CHECK(bmp[18] == 7);
}

TEST_CASE("image_io: a failure leaves what was there and nothing else", "[image]") {
  const test::TemporaryFolder folder;
  CHECK(write_image(gradient(2, 2), "/dev/null/a.png").has_value());
  CHECK(write_image(gradient(2, 2), folder.file("a.gif")).has_value());
  std::filesystem::create_directory(folder.file("b.png"));
  CHECK(write_image(gradient(2, 2), folder.file("b.png")).has_value());
  CHECK(folder.files() == 1);
}

TEST_CASE("image_io: an existing file is replaced", "[image]") {
  const test::TemporaryFolder folder;
  REQUIRE(write_image(gradient(2, 2), folder.file("a.bmp")) == std::nullopt);
  REQUIRE(write_image(gradient(4, 4), folder.file("a.bmp")) == std::nullopt);
  CHECK(folder.files() == 1);
  CHECK(read(folder.file("a.bmp"))[18] == 4);
}

TEST_CASE("image_io: a float map holds the values, the lowest row first", "[image]") {
  const test::TemporaryFolder folder;
  const std::vector<float> values = {1, -2.5f, 0, 1e-3f, 1e9f, std::numeric_limits<float>::infinity()};
  REQUIRE(write_float_map(values, 3, 2, folder.file("a.PFM")) == std::nullopt);
  const std::string bytes = read(folder.file("a.PFM")), header = "Pf\n3 2\n-1.0\n";
  REQUIRE(bytes.size() == header.size() + 6 * 4);
  CHECK(bytes.substr(0, header.size()) == header);
  CHECK(bytes.substr(header.size() + 3 * 4, 4) == std::string("\0\0\x80\x3f", 4));  // 1.0, the upper left
  for (std::size_t i = 0; i < values.size(); ++i) {
    float value;
    std::memcpy(&value, bytes.data() + header.size() + 4 * ((i + 3) % 6), 4);
    CHECK(value == values[i]);
  }
  CHECK(is_float_map("a.b/c.pfm"));
  CHECK_FALSE(is_float_map("a.pfm/c"));
  CHECK_FALSE(is_float_map("pfm"));
  CHECK(write_float_map(values, 3, 2, folder.file("a.PFM/b.pfm")).has_value());
  CHECK(folder.files() == 1);
}

TEST_CASE("image_io: a path is refused before rendering, with the reason", "[image]") {
  for (const char* ending : {".png", ".jpg", ".jpeg", ".bmp", ".exr", ".pfm", ".hdr"}) {
    CHECK(check_image_path("a.tga")->find(ending) != std::string::npos);
  }
  CHECK(check_image_path("/dev/null/folder/a.png")->find("/dev/null/folder") != std::string::npos);
  CHECK(check_image_path("a.png") == std::nullopt);
}

}  // namespace
}  // namespace fathom::runtime::image_io_test
