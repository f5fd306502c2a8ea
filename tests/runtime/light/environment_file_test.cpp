// Environment maps read from files, and the messages about bad files.
#include "runtime/light/environment_file.h"

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "runtime/image/image_exr.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::environment_file_test {
namespace {

std::string reason(const std::string& path) {
  const auto read = read_environment(path);
  const auto* why = std::get_if<ImageReadError>(&read);
  return why ? why->problem : "";
}

void write(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

TEST_CASE("environment file: a Radiance picture", "[light]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("sky.HDR");
  // Two pixels without run-length encoding: (1, 0.5, 0.25) and (16, 0, 32), as mantissas / 256 times 2^(e - 128).
  const unsigned char pixels[] = {128, 64, 32, 129, 64, 0, 128, 134};
  write(path,
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string(reinterpret_cast<const char*>(pixels), 8));
  const auto read = read_environment(path);
  REQUIRE(std::holds_alternative<EnvironmentImage>(read));
  const auto& image = std::get<EnvironmentImage>(read);
  CHECK((image.width == 2 && image.height == 1));
  CHECK(image.pixels[0] == glm::vec3(1, 0.5, 0.25));
  CHECK(image.pixels[1] == glm::vec3(16, 0, 32));
}

TEST_CASE("environment file: an OpenEXR picture, and what is no radiance in it", "[light]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("sky.exr");
  FloatImage written;
  written.width = 3, written.height = 2;
  written.area = {0, 0, 3, 2};
  written.channels = {{"R"}, {"G"}, {"B"}};
  written.values = {{1, 100, -1, 0, 2, 3}, {0.5f, 0, NAN, 0, 2, 3}, {0.25f, 3, INFINITY, 0, 2, 3}};
  REQUIRE_FALSE(write_exr(rows_of(written), path));
  const auto read = read_environment(path);
  REQUIRE(std::holds_alternative<EnvironmentImage>(read));
  const auto& image = std::get<EnvironmentImage>(read);
  CHECK((image.width == 3 && image.height == 2));
  CHECK(image.pixels[0] == glm::vec3(1, 0.5, 0.25));
  CHECK(image.pixels[1] == glm::vec3(100, 0, 3));
  CHECK((image.pixels[2].x == 0 && image.pixels[2].y == 0 && std::isfinite(image.pixels[2].z)));
  CHECK(image.pixels[5] == glm::vec3(3));
}

TEST_CASE("environment file: bad files say why", "[light]") {
  const test::TemporaryFolder folder;
  write(folder.file("a.hdr"), "no picture");
  write(folder.file("b.exr"), "no picture");
  CHECK(reason(folder.file("a.hdr")).find("begin") != std::string::npos);
  CHECK(reason(folder.file("b.exr")).find("exr") != std::string::npos);
  CHECK(!reason(folder.file("none.hdr")).empty());
  CHECK(!reason(folder.file("none.exr")).empty());
}

}  // namespace
}  // namespace fathom::runtime::environment_file_test
