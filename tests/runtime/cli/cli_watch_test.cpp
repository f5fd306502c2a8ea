// End-to-end tests of `fathom render` with --denoise, --preview and --watch.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_watch_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::kBall;
using fathom::test::png_size;
using fathom::test::Result;

// A ball on a floor in soft light, so that the image is noisy.
const char* const kNoisy = R"({
  "version": 1,
  "camera": {"position": [0, 1.5, 4], "target": [0, 0, 0]},
  "film": {"width": 24, "height": 18},
  "render": {"spp": 4},
  "materials": {"glow": {"type": "emissive", "emission": [20, 20, 20]}},
  "objects": [{"type": "torus", "major_radius": 0.4, "minor_radius": 0.1, "translate": [0, 2, 0.5], "material": "glow"},
              {"type": "sphere", "radius": 0.5, "translate": [0, 0.5, 0]},
              {"type": "box", "half_size": [4, 0.1, 4], "translate": [0, -0.1, 0]}]
})";

}  // namespace

TEST_CASE("cli: --denoise keeps the noisy picture beside the denoised one", "[cli]") {
  const Folder folder;
  folder.write("noisy.json", kNoisy);
  const Result result = folder.run("render noisy.json -o a.png -o a.exr --denoise");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("wrote a.png (24x18)") && Contains("wrote a-noisy.png (24x18)"));
  REQUIRE(folder.run("render noisy.json -o plain.png --no-denoise").code == 0);
  CHECK(folder.read("a-noisy.png") == folder.read("plain.png"));
  CHECK(folder.read("a.png") != folder.read("plain.png"));
  // The layer in the EXR file is the same image.
  REQUIRE(folder.run("tonemap a.exr --layer noisy -o layer.png").code == 0);
  CHECK(folder.read("layer.png") == folder.read("plain.png"));
  REQUIRE(folder.run("tonemap a.exr -o denoised.png").code == 0);
  CHECK(folder.read("denoised.png") == folder.read("a.png"));
  // The bits do not depend on the number of threads.
  REQUIRE(folder.run("render noisy.json -o b.exr --denoise --threads 1").code == 0);
  REQUIRE(folder.run("render noisy.json -o c.exr --denoise --threads 3").code == 0);
  CHECK(folder.read("b.exr") == folder.read("c.exr"));
}

TEST_CASE("cli: what cannot be denoised is a matter of usage", "[cli]") {
  const Folder folder;
  const Result single = folder.run("render ball.json -o a.png --denoise -s 1");
  CHECK(single.code == 2);
  CHECK_THAT(single.err, Contains("--spp 2"));
  CHECK(folder.run("render ball.json -o a.png --denoise --no-denoise").code == 2);
  CHECK(folder.run("render ball.json -o a.png -o a-noisy.png --denoise").code == 2);
  CHECK(folder.files() == 2);
}

TEST_CASE("cli: --preview is a quarter of each side, of few samples, denoised", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -o a.png --preview").code == 0);
  CHECK(png_size(folder.read("a.png")) == std::pair(8, 4));
  CHECK(folder.has("a-noisy.png"));
  REQUIRE(folder.run("render ball.json -o b.png --size 8x4 -s 4 --denoise").code == 0);
  CHECK(folder.read("a.png") == folder.read("b.png"));
  REQUIRE(folder.run("render ball.json -o c.png --preview --no-denoise -s 1").code == 0);
  CHECK(!folder.has("c-noisy.png"));
  REQUIRE(folder.run("render ball.json -o d.png --preview -r 2").code == 0);
  CHECK(png_size(folder.read("d.png")) == std::pair(1, 1));
}

TEST_CASE("cli: --watch draws again when the file changes, and outlives errors", "[cli]") {
  const Folder folder;
  folder.write("flat.json",
               R"({"version": 1, "film": {"width": 16, "height": 8}, "render": {"spp": 2}, "background": [1, 1, 1],
                                "objects": [{"type": "box", "half_size": [1, 0.2, 1]}]})");
  // Waits until the condition holds, for up to minutes on a busy machine.
  const Result result = folder.run_script(R"(
    wait_for() { for i in $(seq 2400); do if eval "$1"; then return 0; fi; sleep 0.05; done; exit 9; }
    "$fathom" render ball.json -o a.png --watch 2>log & watcher=$!
    trap 'kill $watcher' EXIT
    wait_for 'grep -q drawing log'
    test -f a.png || exit 3
    echo '{ broken' > ball.json
    wait_for 'grep -q error log'
    rm a.png
    cat flat.json > ball.json
    wait_for 'test -f a.png'
    wait_for 'test $(grep -c drew log) -ge 2'
    trap - EXIT
    kill -TERM $watcher
    wait $watcher
    test $? = 143)");
  INFO(folder.read("log"));
  CHECK(result.code == 0);
  REQUIRE(folder.run("render flat.json -o b.png").code == 0);
  CHECK(folder.read("a.png") == folder.read("b.png"));
}

TEST_CASE("cli: standard input cannot be watched", "[cli]") {
  const Result result = Folder().run("render - -o a.png --watch", kBall);
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Contains("standard input"));
}

}  // namespace fathom::cli_watch_test
