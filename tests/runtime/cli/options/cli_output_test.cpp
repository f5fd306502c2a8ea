// Images on standard output: `-o -` of every verb that writes images.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_output_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::kBall;
using fathom::test::png_size;
using fathom::test::Result;

}  // namespace

TEST_CASE("cli: -o - writes the bytes of the file to standard output", "[cli]") {
  const Folder folder;
  const Result both = folder.run("render ball.json -o a.png -o -");
  CHECK(both.code == 0);
  CHECK(png_size(both.out) == std::pair(32, 16));
  CHECK(both.out == folder.read("a.png"));
  CHECK_THAT(both.err, Contains("wrote png to standard output (32x16)"));
  for (const std::string format : {"png", "jpg", "bmp", "exr", "pfm", "hdr", "film"}) {
    INFO(format);
    REQUIRE(folder.run("render ball.json -q -o b." + format).code == 0);
    const Result result = folder.run("render ball.json -q -o - --format " + format);
    CHECK(result.code == 0);
    CHECK(result.err == "");
    CHECK((result.out == folder.read("b." + format)));
  }
  CHECK(folder.run("render - -q -o -", kBall).out == both.out);
  CHECK((folder.run("merge b.film -q -o - --format exr").out == folder.read("b.exr")));
  REQUIRE(folder.run("tonemap b.exr -o c.jpg").code == 0);
  CHECK((folder.run("tonemap b.exr -o - --format jpg").out == folder.read("c.jpg")));
}

// Text that normally goes to standard output goes to standard error instead.
TEST_CASE("cli: slice and diff write their pictures to standard output, and their numbers elsewhere", "[cli]") {
  const Folder folder;
  const Result slice = folder.run("slice ball.json --show sign --size 8x8 -o -");
  CHECK(slice.code == 0);
  CHECK(png_size(slice.out) == std::pair(8, 8));
  CHECK_THAT(slice.err, Contains("inside ") && Contains("wrote png to standard output (8x8)"));
  REQUIRE(folder.run("render ball.json -q -o a.png").code == 0);
  const Result diff = folder.run("diff a.png a.png -o - --format bmp");
  CHECK(diff.code == 0);
  CHECK(diff.out.starts_with("BM"));
  CHECK_THAT(diff.err, Contains("mse     0\n"));
}

TEST_CASE("cli: what does not go with -o - is exit code 2", "[cli]") {
  const Folder folder;
  struct Case {
    const char* arguments;
    const char* message;
  };
  const Case cases[] = {
      {"render ball.json -o - -o -", "given twice"},
      {"render ball.json -o a.png --format png", "--format is for `-o -`"},
      {"render ball.json -o - --format gif", "`gif` is not one of png"},
      {"render ball.json -o - --stats-json -", "both write to standard output"},
      {"render ball.json -o - --watch", "--watch does not go with `-o -`"},
      {"render ball.json -o - -d", "write files beside"},
      {"render ball.json -o - --resume", "name it with --checkpoint FILE"},
      {"render ball.json -o - --format jpg --bits 16", "--bits 16: `jpg`"},
      {"tonemap a.exr -o - --format exr", "`exr` is not one of png, jpg, jpeg, bmp"},
      {"slice ball.json --format png", "--format is for `-o -`"},
  };
  for (const Case& c : cases) {
    INFO(c.arguments);
    const Result result = folder.run(c.arguments);
    CHECK(result.code == 2);
    CHECK(result.out == "");
    CHECK_THAT(result.err, Contains(c.message));
  }
  CHECK(folder.files() == 2);
}

TEST_CASE("cli: standard output that takes no more is exit code 74, and a render is kept", "[cli]") {
  const Folder folder;
  const Result result = folder.run_script("$fathom render ball.json -o - --checkpoint kept.film >/dev/full");
  CHECK(result.code == 74);
  CHECK_THAT(result.err, Contains("cannot write to standard output") && Contains("kept.film"));
  CHECK(folder.run("render ball.json -o - --checkpoint kept.film --resume -q").code == 0);
}

}  // namespace fathom::cli_output_test
