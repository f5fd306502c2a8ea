// The C++ interface of the library: renders and their images.
#include <atomic>
#include <chrono>
#include <cmath>
#include <fathom/fathom.hpp>
#include <thread>

#include "runtime/image/image_read.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::library_render_test {

namespace {

const std::string kScenes = std::string(FATHOM_SOURCE_DIR) + "/scenes/";

// Renders with the library and with the program, and compares the bytes of PNG files.
void compare_with_program(const std::string& scene, const std::string& options, const RenderOptions& request) {
  const test::Folder folder;
  const test::Result drawn = folder.run("render '" + scene + "' -o program.png " + options);
  INFO(drawn.err);
  REQUIRE(drawn.code == 0);
  const Compiled compiled = load(scene);
  REQUIRE(compiled.scene);
  const Rendered rendered = compiled.scene.render(request);
  INFO(rendered.error.message);
  REQUIRE_FALSE(rendered.error);
  CHECK(rendered.image.complete());
  REQUIRE_FALSE(rendered.image.write((folder.path() / "library.png").string()));
  CHECK(folder.read("library.png") == folder.read("program.png"));
}

}  // namespace

TEST_CASE("the library renders as fathom render does", "[library]") {
  RenderOptions small;
  small.width = 32;
  small.height = 20;
  small.samples = 2;
  compare_with_program(kScenes + "showcase.json", "--size 32x20 -s 2", small);
  small.seed = 5;
  small.threads = 3;
  compare_with_program(kScenes + "gallery/toy.fathom", "--size 32x20 -s 2 --seed 5", small);
  compare_with_program(std::string(FATHOM_SOURCE_DIR) + "/tests/data/hi.vm", "--size 32x20 -s 2 --seed 5", small);
  small.denoise = true;
  compare_with_program(kScenes + "gallery/toy.fathom", "--size 32x20 -s 2 --seed 5 --denoise", small);
}

TEST_CASE("a camera with an open shutter blurs in the library, too", "[library]") {
  const test::Folder folder;
  folder.write("moving.fathom",
               "fathom 1\nparam time = 0\nobject \"a\" sphere(1).translate([time * 20, 0, 0])\n"
               "camera (position = [0, 0, 6], shutter = 1)\nbackground [1, 1, 1]\nrender (spp = 4)\n");
  RenderOptions small;
  small.width = 32;
  small.height = 20;
  compare_with_program((folder.path() / "moving.fathom").string(), "--size 32x20", small);
}

TEST_CASE("layers of an image show the first hits", "[library]") {
  const Compiled compiled = compile(
      "fathom 1\nobject \"ball\" sphere(1).translate([1000, 0, 0])\n"
      "camera (position = [1000, 0, 4], target = [1000, 0, 0])\nbackground [1, 1, 1]\n");
  REQUIRE(compiled.scene);
  RenderOptions options;
  options.width = options.height = 9;
  options.samples = 4;
  const Image image = compiled.scene.render(options).image;
  REQUIRE(image);
  CHECK(image.samples() == 9 * 9 * 4);
  constexpr std::size_t kPixels = 81, kMiddle = 40;
  std::vector<float> position(3 * kPixels), normal(3 * kPixels), depth(kPixels);
  std::vector<std::uint32_t> object(kPixels);
  REQUIRE_FALSE(image.read(Layer::Position, position));
  REQUIRE_FALSE(image.read(Layer::Normal, normal));
  REQUIRE_FALSE(image.read_depth(depth));
  REQUIRE_FALSE(image.read_objects(object));
  CHECK(position[3 * kMiddle] == Approx(1000).margin(0.1));
  CHECK(position[3 * kMiddle + 2] == Approx(1).margin(0.05));
  CHECK(normal[3 * kMiddle + 2] == Approx(1).margin(0.05));
  CHECK(depth[kMiddle] == Approx(3).margin(0.05));
  CHECK(object[kMiddle] == 0);
  CHECK(object[0] == Image::kNoObject);
  CHECK(depth[0] == 0);
  std::vector<std::uint8_t> short_span(5);
  CHECK(image.read_display(short_span).kind == Error::Kind::BadArgument);
  CHECK(image.write("picture.gif").kind == Error::Kind::BadArgument);
  CHECK(image.write("/dev/null/picture.png").kind == Error::Kind::File);
}

TEST_CASE("another thread ends a render of the library", "[library]") {
  const Compiled compiled = load(kScenes + "showcase.json");
  REQUIRE(compiled.scene);
  RenderOptions options;
  options.width = 64;
  options.height = 36;
  options.samples = 1 << 20;  // days
  std::atomic<double> fraction = -1;
  options.progress = [&](double share) { fraction = share; };
  std::stop_source stop;
  options.stop = stop.get_token();
  std::thread watcher([&] {
    while (fraction < 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    stop.request_stop();
  });
  const Rendered rendered = compiled.scene.render(options);
  watcher.join();
  REQUIRE_FALSE(rendered.error);
  CHECK_FALSE(rendered.image.complete());
  CHECK(rendered.image.samples() > 0);
  CHECK(fraction < 1);
}

TEST_CASE("options of a render are checked", "[library]") {
  const Compiled compiled = compile("fathom 1\nobject \"a\" sphere(1)\n");
  REQUIRE(compiled.scene);
  const auto kind_of = [&](const RenderOptions& options) { return compiled.scene.render(options).error.kind; };
  RenderOptions options;
  options.width = 0;
  CHECK(kind_of(options) == Error::Kind::BadArgument);
  options.width = 1 << 20;
  CHECK(kind_of(options) == Error::Kind::BadArgument);
  options = {};
  options.samples = -1;
  CHECK(kind_of(options) == Error::Kind::BadArgument);
  options = {};
  options.samples = 1;
  options.denoise = true;
  CHECK(kind_of(options) == Error::Kind::BadArgument);
  options = {};
  options.threads = -2;
  CHECK(kind_of(options) == Error::Kind::BadArgument);
  CHECK(Scene().render().error.kind == Error::Kind::BadArgument);
}

}  // namespace fathom::library_render_test
