// -D: the scene's parameters set on the command line.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_define_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

const char* const kDial = R"({
  "version": 1,
  "params": {"radius": {"default": 0.5, "min": 0, "max": 2, "doc": "of the ball"}, "twice": "2*radius"},
  "film": {"width": 8, "height": 4},
  "render": {"spp": 1},
  "objects": [{"name": "ball", "type": "sphere", "radius": "twice/2"}]
})";

}  // namespace

TEST_CASE("cli: -D gives the scene's parameters values, for every verb", "[cli]") {
  const Folder folder;
  folder.write("dial.json", kDial);
  const auto first_line = [&](const std::string& arguments) {
    const Result result = folder.run(arguments);
    CAPTURE(arguments, result.err);
    CHECK(result.code == 0);
    return result.out.substr(0, result.out.find('\n'));
  };
  CHECK(first_line("eval dial.json --at 0,3,0") == "2.5 0 1 0 ball");
  CHECK(first_line("eval dial.json --at 0,3,0 -D radius=1") == "2 0 1 0 ball");
  CHECK(first_line("eval dial.json --at 0,3,0 -Dradius=3/2") == "1.5 0 1 0 ball");
  CHECK(first_line("eval dial.json --at 0,3,0 '--define=radius=2*sin(pi/2)'") == "1 0 1 0 ball");
  CHECK(first_line("eval dial.json --at 0,3,0 -D radius=1 -D radius=1.25") == "1.75 0 1 0 ball");
  CHECK(first_line("eval dial.json --at 0,3,0 -D twice=4") == "1 0 1 0 ball");
  CHECK(first_line("dump dial.json --stage graph -D radius=1").find("sphere radius=1 ") != std::string::npos);
  CHECK_THAT(folder.run("check dial.json").out, Contains("\n  -D radius=0.5  [0, 2]  of the ball\n  -D twice=1\n"));
  CHECK_THAT(folder.run("check dial.json -D radius=1").out, Contains("  -D radius=1  [0, 2]  of the ball\n"));
  CHECK(folder.run("render dial.json -q -o a.png").code == 0);
  CHECK(folder.run("render dial.json -q -o b.png -D radius=0.5").code == 0);
  CHECK(folder.read("a.png") == folder.read("b.png"));
}

TEST_CASE("cli: a value that is good for the parameter and bad for the scene is the scene's error", "[cli]") {
  const Folder folder;
  folder.write("dial.json", kDial);
  CHECK(folder.run("check dial.json -D radius=0").code == 1);
  CHECK(folder.run("render dial.json -D radius=0").code == 65);
  CHECK_THAT(folder.run("check dial.json -D radius=0").err, Contains("`radius` must be positive; `twice/2` is 0"));
}

TEST_CASE("cli: values that the scene's parameters cannot have are exit code 2", "[cli]") {
  const Folder folder;
  folder.write("dial.json", kDial);
  const std::pair<const char*, const char*> cases[] = {
      {"check dial.json -D raduis=1", "did you mean `radius`?"},
      {"dump dial.json -D raduis=1", "did you mean `radius`?"},
      {"eval dial.json --at 0,0,0 -D raduis=1", "did you mean `radius`?"},
      {"render dial.json -o out.png -D raduis=1", "did you mean `radius`?"},
      {"render ball.json -o out.png -D radius=1", "the scene has no parameter `radius`"},
      {"render dial.json -o out.png -D radius=2.5", "`radius` must be between 0 and 2; it is 2.5"},
      {"check dial.json -D radius=1/0", "`radius` must be finite; it is inf"},
      {"check dial.json -D twice=0/0", "`twice` must be finite; it is not a number"},
  };
  for (const auto& [arguments, message] : cases) {
    const Result result = folder.run(arguments);
    CAPTURE(arguments);
    CHECK(result.code == 2);
    CHECK(result.out == "");
    CHECK_THAT(result.err, Contains(message));
  }
  CHECK(!folder.has("out.png"));
}

}  // namespace fathom::cli_define_test
