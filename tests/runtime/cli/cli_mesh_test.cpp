// End-to-end tests of `fathom mesh`.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_mesh_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

constexpr const char* kGround = R"({"version": 1, "objects": [{"type": "plane", "normal": [0, 1, 0]},
  {"name": "ball", "type": "sphere", "radius": 0.5, "translate": [0, 0.4, 0]}]})";

}  // namespace

TEST_CASE("cli: mesh writes every format and states its bound", "[cli]") {
  const Folder folder;
  for (const std::string ending : {"stl", "ply", "obj", "3mf", "glb"}) {
    const Result result = folder.run("mesh two.json --resolution 32 --unit mm -o part." + ending);
    CHECK(result.code == 0);
    CHECK(result.out.empty());
    CHECK_THAT(result.err,
               Contains("wrote part." + ending) && Contains("2 bodies, 0 hollows, 6") && Contains(" mm\n"));
    CHECK_THAT(result.err, Contains("every point of the mesh is within 0.0") && Contains("of the surface (proved)"));
    CHECK(folder.has("part." + ending));
  }
  CHECK_THAT(folder.read("part.obj"),
             Contains("mtllib part.mtl\n") && Contains("usemtl red") && Contains("usemtl blue"));
  CHECK_THAT(folder.read("part.mtl"), Contains("newmtl red\nKd 1 0 0"));
}

TEST_CASE("cli: mesh turns y to z on request, and takes a tolerance", "[cli]") {
  const Folder folder;
  const Result result = folder.run("mesh two.json --tolerance 0.2 --up z -o part.obj");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("within 0.1999"));
  const Result named = folder.run("mesh ball.json -q --resolution 16");
  CHECK(named.code == 0);
  CHECK(folder.has("ball.stl"));
}

// A tolerance of 0.3 was printed as a bound of 0.3002.
TEST_CASE("cli: mesh prints a bound that is not above the tolerance, and its direction", "[cli]") {
  const Folder folder;
  for (const char* tolerance : {"0.3", "0.123456", "0.05"}) {
    const Result result = folder.run("mesh two.json -o part.stl --tolerance " + std::string(tolerance));
    const std::string before = "every point of the mesh is within ";
    const std::size_t at = result.err.find(before);
    REQUIRE(at != std::string::npos);
    CHECK(std::stod(result.err.substr(at + before.size())) <= std::stod(tolerance));
    CHECK_THAT(result.err, Contains("may be further from the mesh"));
  }
}

// A mesh of two files was left with one of them if the other could not be written.
TEST_CASE("cli: an OBJ file and its materials appear both or not at all", "[cli]") {
  const Folder folder;
  std::filesystem::create_directory(folder.path() / "a.mtl");
  CHECK(folder.run("mesh two.json --resolution 16 -o a.obj").code == 74);
  CHECK_FALSE(folder.has("a.obj"));
  folder.write("b.json", folder.read("two.json"));
  std::filesystem::create_directory(folder.path() / "b_c.obj");
  CHECK(folder.run("mesh b.json --resolution 16 -o b_c.obj").code == 74);
  CHECK_FALSE(folder.has("b_c.mtl"));
  const Result spaces = folder.run("mesh two.json --resolution 16 -o \"d e.obj\"");
  CHECK(spaces.code == 0);
  CHECK_THAT(folder.read("d e.obj"), Contains("mtllib d_e.mtl\n"));
  CHECK(folder.has("d_e.mtl"));
}

TEST_CASE("cli: mesh of a scene without end names the box", "[cli]") {
  const Folder folder;
  folder.write("ground.json", kGround);
  const Result whole = folder.run("mesh ground.json -o a.stl");
  CHECK(whole.code == 65);
  CHECK_THAT(whole.err, Contains("the scene has no end") && Contains("--box -0.5,-0.1,-0.5,0.5,0.9,0.5"));
  CHECK_FALSE(folder.has("a.stl"));
  CHECK(folder.run("mesh ground.json --resolution 32 --box -1,-0.2,-1,1,1,1 -o a.stl").code == 0);
  const Result beyond = folder.run("mesh ball.json --box 2,2,2,3,3,3 -o b.stl");
  CHECK(beyond.code == 65);
  CHECK_THAT(beyond.err, Contains("nothing of the scene is in the box"));
}

TEST_CASE("cli: mesh names lost parts and their remedy", "[cli]") {
  const Folder folder;
  folder.write("leaf.json", R"({"version": 1, "objects": [{"type": "sphere", "radius": 0.5},
    {"name": "leaf", "type": "box", "half_size": [1, 0.001, 1], "translate": [0, 0.77, 0]}]})");
  const Result result = folder.run("mesh leaf.json --resolution 32 -o a.stl");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("warning: a part of `leaf`") && Contains("--tolerance 0.00"));
  // Far from zero four digits did not tell the place.
  folder.write("far.fathom",
               "fathom 1\nobject sphere(.5).translate([12340, 0, 0])\n"
               "object \"leaf\" box([1, .01, 1]).translate([12345.5, 0, 0])\n");
  const Result far = folder.run("mesh far.fathom --resolution 32 -o a.stl");
  const std::string place = far.err.substr(far.err.find(" at (") + 5);
  CHECK(std::stod(place) == Approx(12345.5).margin(1.01));
  CHECK(place.find('.') < place.find(','));
}

TEST_CASE("cli: mesh reports wrong options, too much memory and files that cannot be written", "[cli]") {
  const Folder folder;
  const auto code = [&](const std::string& options) { return folder.run("mesh ball.json " + options).code; };
  CHECK(code("-o a.png") == 2);
  CHECK(code("-o a.stl --tolerance 0.1 --resolution 10") == 2);
  CHECK(code("-o a.stl --tolerance 0") == 2);
  CHECK(code("-o a.stl --unit foot") == 2);
  CHECK(code("-o ball.json/a.stl") == 74);
  const Result memory = folder.run("mesh ball.json -o a.stl --resolution 4000 --limit memory=10000000");
  CHECK(memory.code == 2);
  CHECK_THAT(memory.err, Contains("memory") && Contains("larger --tolerance"));
  CHECK_THAT(folder.run("mesh ball.json -o a.stl --tolerance 1e-9").err, Contains("too small for single precision"));
  CHECK_FALSE(folder.has("a.stl"));
}

}  // namespace fathom::cli_mesh_test
