// End-to-end tests of `fathom slice`.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_slice_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::kBall;
using fathom::test::png_size;
using fathom::test::Result;

}  // namespace

TEST_CASE("cli: slice counts the pixels inside and writes a picture of them", "[cli]") {
  const Folder folder;
  // An 8 by 8 grid over [-1, 1]^2 has 12 pixel centres within the radius 0.5: 4 by 4 without the corners.
  const Result sign = folder.run("slice ball.json -o a.png --show sign --box -1,-1,1,1 --size 8x8");
  CHECK(sign.code == 0);
  CHECK(sign.out == "inside 12 of 64 pixels\n");
  CHECK_THAT(sign.err, Contains("wrote a.png (8x8)"));
  CHECK(png_size(folder.read("a.png")) == std::pair(8, 8));
  const auto inside = [&](const std::string& flags) {
    return folder.run("slice two.json -o a.png --show sign --size 10x10 " + flags).out;
  };
  // The left ball's bounding box spans -3 to -1 in x, the right box 1 to 3.
  CHECK(inside("--box 1,-1,3,1") == "inside 100 of 100 pixels\n");
  CHECK(inside("--axis y --at 0.9 --box 1,-1,3,1") == "inside 100 of 100 pixels\n");
  CHECK(inside("--axis y --at 1.1 --box 1,-1,3,1") == "inside 0 of 100 pixels\n");
  CHECK(inside("--axis x --at 2 --box -2,-1,0,1") == "inside 50 of 100 pixels\n");
  CHECK(inside("--axis x --at 2 --box -2,-1,0,1 --threads 3") == "inside 50 of 100 pixels\n");
}

TEST_CASE("cli: slice says how far its lines are apart", "[cli]") {
  const Folder folder;
  const Result result = folder.run("slice ball.json --box -1,-1,1,1 --size 9x9");
  CHECK(result.code == 0);
  CHECK(result.out == "a line every 0.2 scene units, distances from -0.5 to 0.75707877\n");
  CHECK_THAT(result.err, Contains("the picture goes to ball-slice.png"));
  CHECK(folder.has("ball-slice.png"));
  CHECK(folder.run("slice - -o b.jpg --axis x --size 20x10", kBall).code == 0);
  CHECK(folder.has("b.jpg"));
  CHECK(folder.files() == 4);
}

TEST_CASE("cli: a picture that cannot be written is exit code 74 and prints no data", "[cli]") {
  const Folder folder;
  for (const char* output : {"ball.json/x/out.png", "ball.json/out.png"}) {
    const Result result = folder.run(std::string("slice ball.json -o ") + output);
    CHECK(result.code == 74);
    CHECK(result.out == "");
  }
}

}  // namespace fathom::cli_slice_test
