#include "runtime/image/image_exr.h"

#include <fstream>
#include <iterator>

#include "runtime/film/film_channels.h"
#include "runtime/image/image_read.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::image_exr_test {
namespace {

std::vector<std::uint8_t> read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A crop of an image of 50 x 60 pixels with all layers. No two numbers of a pixel are equal.
Film varied_film() {
  Film film(PixelRect{11, 7, 33, 50}, kAllLayers);
  const PixelRect area = film.area();
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      for (int i = 0; i < 3; ++i) {
        const float value = static_cast<float>(1 + x * 3 + y * 200 + i);
        PathSample sample;
        sample.radiance = glm::vec3(value, value * 1.5f, 1 / value);
        sample.number = static_cast<std::uint32_t>(i);
        sample.hit = (x + y + i) % 4 != 0;
        sample.albedo = glm::vec3(0.1f, 0.2f, 1 / value);
        sample.normal = glm::vec3(0.6f, -0.8f, 0);
        sample.depth = 3.0 + i;
        sample.position = glm::dvec3(x, y, -i);
        sample.surface = static_cast<std::uint32_t>(x);
        sample.material = static_cast<std::uint32_t>(y);
        sample.evaluations = static_cast<std::uint64_t>(x * y);
        sample.instructions = sample.evaluations * 7;
        film.add(x, y, sample);
      }
    }
  }
  return film;
}

TEST_CASE("image_exr: every channel of a film comes back, at its place in the picture", "[image]") {
  const test::TemporaryFolder folder;
  const Film film = varied_film();
  const glm::dvec3 origin{1000, 0, -5};
  const ImageRows rows = rows_of(film, 50, 60, origin, {});
  REQUIRE(write_exr(rows, folder.file("a.exr")) == std::nullopt);
  CHECK(folder.files() == 1);
  const auto found = decode_exr(read(folder.file("a.exr")));
  REQUIRE(std::holds_alternative<FloatImage>(found));
  const auto& image = std::get<FloatImage>(found);
  CHECK(image.width == 50);
  CHECK(image.height == 60);
  CHECK(image.area == film.area());
  CHECK(image.channels.size() == film_channels().size() - 3);
  int wrong = 0;
  for (const FilmChannel& channel : film_channels()) {
    if (channel.name.starts_with("noisy")) continue;  // the film was not denoised
    INFO(channel.name);
    const std::vector<float>* values = image.channel(channel.name);
    REQUIRE(values != nullptr);
    CHECK(image.channels[static_cast<std::size_t>(image.find(channel.name))].whole == channel.whole);
    for (int y = image.area.y0; y < image.area.y1; ++y) {
      for (int x = image.area.x0; x < image.area.x1; ++x) {
        PixelMeans pixel = film.means(x, y);
        if (pixel.hits > 0) pixel.position += origin;
        wrong += (*values)[image.area.index(x, y)] != static_cast<float>(channel.value(pixel));
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(image.channel("P.X")->front() > 1000);
  CHECK(image.channel("sampleCount")->front() == 3);
  CHECK(image.channel("none") == nullptr);
}

TEST_CASE("image_exr: layers that a film does not keep are not there", "[image]") {
  const Film film(2, 2, {.first_hit = false});
  const ImageRows rows = rows_of(film, 2, 2, glm::dvec3(0), {});
  CHECK(rows.find("R") >= 0);
  CHECK(rows.find("sampleCount") >= 0);
  for (const char* name : {"Z", "N.X", "P.X", "id.object", "variance.R", "evaluations"}) CHECK(rows.find(name) < 0);
}

TEST_CASE("image_exr: an image read and written again has the same bytes", "[image]") {
  const test::TemporaryFolder folder;
  const Film film = varied_film();
  Attributes attributes = {{"samplesPerPixel", 3}, {"a.float", 0.5f}, {"a.text", std::string("word")}};
  attributes["a.list"] = std::vector<std::string>{"one", "", "three"};
  Matrix4 matrix;
  for (std::size_t i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i);
  attributes["worldToNDC"] = matrix;
  const ImageRows rows = rows_of(film, 50, 60, glm::dvec3(0), attributes);
  REQUIRE(write_exr(rows, folder.file("a.exr")) == std::nullopt);
  REQUIRE(write_exr(rows, folder.file("b.exr")) == std::nullopt);
  CHECK(read(folder.file("a.exr")) == read(folder.file("b.exr")));
  const auto decoded = decode_exr(read(folder.file("a.exr")));
  const auto& image = std::get<FloatImage>(decoded);
  for (const auto& [name, value] : attributes) {
    INFO(name);
    REQUIRE(image.attributes.count(name) == 1);
    CHECK(image.attributes.at(name) == value);
  }
  REQUIRE(write_exr(rows_of(image), folder.file("c.exr")) == std::nullopt);
  CHECK(read(folder.file("c.exr")) == read(folder.file("a.exr")));
}

TEST_CASE("image_exr: what is cut short or no picture is refused with a reason", "[image]") {
  const test::TemporaryFolder folder;
  const Film film(4, 4);
  REQUIRE(write_exr(rows_of(film, 4, 4, glm::dvec3(0), {}), folder.file("a.exr")) == std::nullopt);
  std::vector<std::uint8_t> bytes = read(folder.file("a.exr"));
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, bytes.size() / 3, bytes.size() - 5}) {
    INFO(size << " of " << bytes.size());
    const auto cut = decode_exr({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    REQUIRE(std::holds_alternative<std::string>(cut));
    CHECK_FALSE(std::get<std::string>(cut).empty());
  }
  bytes[0] = 'x';
  CHECK(std::holds_alternative<std::string>(decode_exr(bytes)));
}

TEST_CASE("image_exr: a file that cannot be written leaves nothing", "[image]") {
  const test::TemporaryFolder folder;
  const Film film(4, 4);
  const ImageRows rows = rows_of(film, 4, 4, glm::dvec3(0), {});
  CHECK(write_exr(rows, "/dev/null/a.exr")->find("Not a directory") != std::string::npos);
  std::filesystem::create_directory(folder.file("b.exr"));
  CHECK(write_exr(rows, folder.file("b.exr")).has_value());
  CHECK(write_exr(rows, "/dev/null")->find("not a regular file") != std::string::npos);
  CHECK(folder.files() == 1);
}

}  // namespace
}  // namespace fathom::runtime::image_exr_test
