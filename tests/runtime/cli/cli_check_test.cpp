// fathom check: the exactness report and the probe.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_check_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

const char* const kRope = R"({
  "version": 1, "background": [1, 1, 1],
  "objects": [
    {"name": "floor", "type": "plane", "normal": [0, 1, 0], "offset": -3},
    {"name": "rope", "type": "twist", "turn": 90, "of":
      {"type": "box", "half_size": [1, 3, 1]}}
  ]
})";

const char* const kBulb = R"({
  "version": 1,
  "objects": [
    {"type": "mandelbulb"}
  ]
})";

std::vector<nlohmann::json> json_lines(const std::string& text) {
  std::vector<nlohmann::json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

}  // namespace

TEST_CASE("cli: check says how exact each object is and what costs the most", "[cli]") {
  const Folder folder;
  folder.write("rope.json", kRope);
  folder.write("bulb.json", kBulb);
  const Result rope = folder.run("check rope.json");
  CHECK(rope.code == 0);
  CHECK(rope.err == "");
  CHECK_THAT(rope.out, Contains("\n  floor   exact     1          1      [-inf,inf]x[-inf,-3]x[-inf,inf]\n"));
  CHECK_THAT(rope.out, Contains("\n  rope    bound     2.607      0.384  [-1.416,1.416]x[-3,3]x[-1.416,1.416]  "));
  CHECK_THAT(rope.out, Contains("twist \"rope\" at rope.json:5:5 makes steps 2.61x shorter\n"));
  CHECK_THAT(rope.out, Contains("\ncertified: every step length is proved\n"));
  CHECK_THAT(folder.run("check bulb.json").out,
             Contains("\nnot certified: nothing is proved of the mandelbulb at bulb.json:4:5\n"));
}

TEST_CASE("cli: check sums up more than 40 objects", "[cli]") {
  const Folder folder;
  folder.write("many.fathom",
               "fathom 1\nbackground [1, 1, 1]\nobject ...[for i in 0..40: sphere(0.3).translate([i, 0, 0])]\n"
               "object box([1, 1, 1]).twist(90)\n");
  const Result sums = folder.run("check many.fathom");
  CHECK(sums.code == 0);
  CHECK_THAT(sums.out, Contains("  41 objects: 1 bound, 40 exact; the 10 with the shortest steps (-v lists all):\n"));
  CHECK(std::count(sums.out.begin(), sums.out.end(), '\n') < 30);
  const std::string all = folder.run("check -v many.fathom").out;
  CHECK(std::count(all.begin(), all.end(), '\n') > 45);
}

// Regression: the location was that of the whole formula, the first line of an expression list.
TEST_CASE("cli: check names the operation that has no bound, and its line", "[cli]") {
  const Folder folder;
  folder.write("jump.vm", "# steps\n_0 var-x\n_1 var-y\n_2 floor _0\n_3 sub _1 _2\n_4 const 0.1\n_5 add _3 _4\n");
  const Result list = folder.run("check jump.vm");
  CHECK_THAT(list.out, Contains("\n  no bound on the slope of `_2 floor _0` at jump.vm:4:1\n"));
  CHECK_THAT(list.out, Contains("certified: every step length is proved, cell by cell within the expression"));
  folder.write("dense.vm", "_0 var-x\n_1 var-y\n_2 const 4000\n_3 mul _0 _2\n_4 floor _3\n_5 sub _1 _4\n");
  const Result dense = folder.run("check dense.vm");
  CHECK_THAT(dense.out, Contains("not certified: nothing is proved of the expression"));
  CHECK_THAT(dense.err, Contains("--> dense.vm:5:1"));
  folder.write("jump.json", R"_({"version": 1, "objects": [
    {"type": "displacement", "of": {"type": "sphere", "radius": 2}, "formula": "0.1*sin(x) + 0.1*sqrt(y)"}]})_");
  CHECK_THAT(
      folder.run("check jump.json").out,
      Contains("certified: every step length is proved, cell by cell within the displacement at jump.json:2:5\n"
               "  no bound on the slope of `sqrt(y)` at jump.json:2:98\n"));
  const auto scene = json_lines(folder.run("check jump.json --error-format json").out).back();
  CHECK(scene["estimates"][0]["operation"] == nlohmann::json({{"text", "sqrt(y)"}, {"line", 2}, {"column", 98}}));
}

TEST_CASE("cli: check prints the report as JSON lines", "[cli]") {
  const Folder folder;
  folder.write("rope.json", kRope);
  const std::vector<nlohmann::json> lines = json_lines(folder.run("check rope.json --error-format json").out);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0]["object"] == "floor");
  CHECK(lines[0]["class"] == "exact");
  CHECK(lines[0]["box"]["lo"][0].is_null());
  CHECK(lines[0]["box"]["hi"][1] == -3);
  CHECK(lines[0]["costliest"].is_null());
  CHECK(lines[1]["costliest"]["type"] == "twist");
  CHECK(lines[1]["costliest"]["line"] == 5);
  CHECK(lines[2]["certified"] == true);
  CHECK(lines[2]["estimates"].empty());
}

TEST_CASE("cli: check --probe prints what it saw of every constant", "[cli]") {
  const Folder folder;
  folder.write("rope.json", kRope);
  folder.write("bulb.json", kBulb);
  const Result rope = folder.run("check rope.json --probe 5000");
  CHECK(rope.code == 0);
  CHECK_THAT(rope.out, Contains("seen/declared") && Contains("object") && Contains("node") && Contains("holds"));
  CHECK_THAT(rope.out, Contains("twist \"rope\" at rope.json:5:5\n") && Contains("\nno constant broken\n"));
  CHECK(folder.run("check rope.json --probe 5000 --threads 3").out == rope.out);
  const Result bulb = folder.run("check bulb.json --probe 1000");
  CHECK(bulb.code == 0);  // the scene claims nothing, so nothing breaks
  CHECK_THAT(bulb.out, Contains("estimate") && Contains("no constant broken"));
  const auto lines = json_lines(folder.run("check rope.json --probe 1000 --error-format json").out);
  REQUIRE(lines.size() > 3);
  CHECK(lines[3]["probed"] == "scene");
  CHECK(lines[3]["points"] == 1000);
  CHECK(lines.back()["broken"] == false);
  CHECK(folder.run("check rope.json --probe 100000001").code == 2);
  CHECK(folder.run("check rope.json --probe 0").code == 2);
}

TEST_CASE("cli: check takes several scenes, names each and counts warnings", "[cli]") {
  const Folder folder;
  folder.write("unused.json", R"({"version": 1, "background": [1, 1, 1], "materials": {"m": {"type": "diffuse"}},
    "objects": [{"type": "sphere", "radius": 1}]})");
  folder.write("wrong.json", R"({"version": 1, "objects": [{"type": "sphere"}]})");
  Result result = folder.run("check unused.json ball.json");
  CHECK(result.code == 0);
  CHECK_THAT(result.out, Contains("unused.json:\n") && Contains("\nball.json:\n"));
  CHECK_THAT(result.err, Contains("unused.json: 1 warning\n") && !Contains("ball.json: "));
  result = folder.run("check wrong.json ball.json");
  CHECK(result.code == 1);
  CHECK_THAT(result.out, Contains("ball.json:\n"));
  CHECK(folder.run("check wrong.json missing.json").code == 74);
  CHECK(folder.run("check ball.json").out.find("ball.json:\n") == std::string::npos);
}

}  // namespace fathom::cli_check_test
