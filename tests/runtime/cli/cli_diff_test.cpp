// End-to-end tests of `fathom diff`.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_diff_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::png_size;
using fathom::test::Result;

// A portable float map of 2x1 pixels, little endian.
std::string float_map(const std::vector<float>& values) {
  std::string text = "PF\n2 1\n-1.0\n";
  for (const float value : values) text.append(reinterpret_cast<const char*>(&value), sizeof value);
  return text;
}

struct Pictures : Folder {
  Pictures() {
    write("a.pfm", float_map({1, 2, 3, 0, 0, 0.5f}));
    write("b.pfm", float_map({1, 0, 3, 1, 0, 0}));
  }
};

}  // namespace

TEST_CASE("cli: diff prints what two pictures differ in", "[cli]") {
  const Pictures folder;
  const Result result = folder.run("diff a.pfm b.pfm");
  CHECK(result.code == 0);
  CHECK_THAT(result.out, Contains("mse     0.875\n") && Contains("max     2\n") && Contains("mean    0.25\n"));
  const auto json = nlohmann::json::parse(folder.run("diff a.pfm b.pfm --json").out);
  CHECK(json["mse"] == 0.875);
  CHECK(json["relmse"].get<double>() == Approx((4 / 0.01 + 1 / 1.01 + 0.25 / 0.01) / 6));
  CHECK(json["flip"] > 0.3);
  CHECK(json["invalid"] == 0);
  const Result same = folder.run("diff a.pfm a.pfm --tol 0 --metric flip");
  CHECK(same.code == 0);
  CHECK_THAT(same.out, Contains("mse     0\n") && Contains("flip    0\n"));
}

TEST_CASE("cli: diff ends with 1 above the tolerance of its metric", "[cli]") {
  const Pictures folder;
  CHECK(folder.run("diff a.pfm b.pfm --tol 0.88").code == 0);
  CHECK(folder.run("diff a.pfm b.pfm --tol 2 --metric max").code == 0);
  const Result more = folder.run("diff a.pfm b.pfm --tol 0.87");
  CHECK(more.code == 1);
  CHECK_THAT(more.err, Contains("mse is 0.875, more than 0.87"));
  CHECK(folder.run("diff a.pfm b.pfm --tol 1.9 --metric max").code == 1);
  CHECK(folder.run("diff a.pfm b.pfm --tol 50 --metric relmse").code == 1);
  // NaN and infinity exceed every tolerance.
  folder.write("nan.pfm", float_map({NAN, 2, 3, 0, 0, 0.5f}));
  const Result invalid = folder.run("diff a.pfm nan.pfm --tol 100");
  CHECK(invalid.code == 1);
  CHECK_THAT(invalid.err, Contains("1 pixel"));
  CHECK_THAT(invalid.out, Contains("invalid 1"));
}

TEST_CASE("cli: diff draws where pictures differ", "[cli]") {
  const Pictures folder;
  const Result result = folder.run("diff a.pfm b.pfm -o map.png");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("wrote map.png (2x1)"));
  CHECK(png_size(folder.read("map.png")) == std::pair(2, 1));
  CHECK(folder.run("diff map.png b.pfm -o map.png").code == 2);
}

TEST_CASE("cli: a render differs from itself by the rounding of its file alone", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -o a.png -o a.exr -o a.pfm").code == 0);
  REQUIRE(folder.run("render ball.json -o b.png --seed 5").code == 0);
  CHECK(folder.run("diff a.exr a.pfm --tol 0 --metric max").code == 0);
  CHECK(folder.run("diff a.png a.exr --tol 0.005 --metric max").code == 0);
  CHECK(folder.run("diff a.png b.png --tol 0.005 --metric max").code == 1);
}

TEST_CASE("cli: pictures that cannot be compared", "[cli]") {
  const Pictures folder;
  REQUIRE(folder.run("render ball.json -o ball.png").code == 0);
  const Result sizes = folder.run("diff a.pfm ball.png");
  CHECK(sizes.code == 65);
  CHECK_THAT(sizes.err, Contains("`a.pfm` is 2x1") && Contains("`ball.png` is 32x16"));
  folder.write("broken.png", "no picture");
  CHECK(folder.run("diff a.pfm broken.png").code == 65);
  CHECK(folder.run("diff a.pfm missing.png").code == 74);
  CHECK(folder.run("diff a.pfm").code == 2);
  CHECK(folder.run("diff a.pfm b.pfm --metric flip").code == 2);
  CHECK(folder.run("diff a.pfm b.pfm --tol -1").code == 2);
  CHECK(folder.run("diff a.pfm b.pfm --tol 1 --metric mean").code == 2);
  CHECK(folder.run("diff a.pfm b.pfm -o a.pfm/map.png").code == 74);
}

}  // namespace fathom::cli_diff_test
