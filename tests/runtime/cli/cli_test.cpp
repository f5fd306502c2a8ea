// End-to-end tests: exit codes, messages, data on stdout, files written and not written.
#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/not_run.h"
#include "tests/support/program.h"

namespace fathom::cli_test {

namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using fathom::test::Folder;
using fathom::test::kBall;
using fathom::test::png_size;
using fathom::test::Result;

}  // namespace

TEST_CASE("cli: files that cannot be read or written are exit code 74", "[cli]") {
  const Folder folder;
  for (const char* verb : {"render", "check", "dump", "eval --at 0,0,0", "slice"}) {
    const Result result = folder.run(std::string(verb) + " missing.json");
    CHECK(result.code == 74);
    CHECK_THAT(result.err, Contains("cannot read `missing.json`: No such file or directory"));
  }
  CHECK_THAT(folder.run("check .").err, Contains("cannot read `.`: it is a directory"));
  CHECK(folder.run("check .").code == 74);
  CHECK(folder.run("eval ball.json --points missing.txt").code == 74);
  for (const char* output : {"-o ball.json/out.png", "-o out.png --stats-json ball.json/s.json"}) {
    const Result result = folder.run(std::string("render ball.json ") + output);
    CHECK(result.code == 74);
    CHECK_THAT(result.err, Contains("cannot write to the folder `ball.json`"));
    CHECK_THAT(result.err, !Contains("drew"));  // the error comes before rendering
  }
  CHECK(folder.run("dump ball.json").code == 0);
  CHECK(folder.files() == 2);
}

TEST_CASE("cli: no output may overwrite the scene or another output", "[cli]") {
  const Folder folder;
  for (const char* outputs : {"-o out.png --stats-json ball.json", "-o out.png --stats-json ./out.png",
                              "-o a.png -a -o a-albedo.png", "-o a.png -o ./a.png"}) {
    const Result result = folder.run(std::string("render ball.json ") + outputs);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains("would be overwritten"));
  }
  CHECK(folder.run("check ball.json").code == 0);
  folder.write("scene.png", kBall);
  CHECK_THAT(folder.run("slice scene.png -o ./scene.png").err, Contains("would be overwritten"));
  CHECK(folder.read("scene.png") == kBall);
}

TEST_CASE("cli: a bad scene prints diagnostics and leaves no picture", "[cli]") {
  const Folder folder;
  folder.write("bad.json", R"({"version": 1, "objects": [{"type": "spere", "radius": 1}, {"type": "box"}]})");
  const Result render = folder.run("render bad.json -o bad.png");
  CHECK(render.code == 65);
  CHECK_THAT(render.err, Contains("bad.json:1:") && Contains("sphere") && Contains("2 errors"));
  CHECK_FALSE(folder.has("bad.png"));
  CHECK(folder.run("dump bad.json").code == 65);
  CHECK(folder.run("eval bad.json --at 0,0,0").code == 65);
  CHECK(folder.run("slice bad.json -o bad.png").code == 65);
  CHECK_FALSE(folder.has("bad.png"));
  const Result check = folder.run("check bad.json");
  CHECK(check.code == 1);
  CHECK(check.out == "");
  CHECK(check.err == render.err);
  const Result brief = folder.run("check bad.json --error-format short");
  CHECK(std::count(brief.err.begin(), brief.err.end(), '\n') == 2);
  CHECK(folder.run("check bad.json --error-format json").err.front() == '{');
}

TEST_CASE("cli: the scenes that come with the program have no errors and no warnings but one", "[cli][heavy]") {
  int scenes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(FATHOM_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".json" && entry.path().extension() != ".fathom") continue;
    const Result result = Folder().run("check '" + entry.path().string() + "'");
    INFO(entry.path());
    CHECK(result.code == 0);
    if (entry.path().filename() ==
        // This scene's sheet is defined by the gyroid's values on purpose, see the head of the file.
        "e-gyroid.json") {
      CHECK_THAT(result.err, Contains("W0511") && Contains("e-gyroid.json: 1 warning\n"));
    } else {
      CHECK(result.err == "");
    }
    ++scenes;
  }
  CHECK(scenes > 0);
}

TEST_CASE("cli: check reports on stdout, and warnings are no failure", "[cli]") {
  const Folder folder;
  folder.write("unused.json", R"({"version": 1, "materials": {"red": {"type": "diffuse"}},
    "objects": [{"type": "sphere", "radius": 1}]})");
  const Result result = folder.run("check unused.json");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("warning") && Contains("red"));
  CHECK_THAT(result.out, Contains("Lipschitz") && Contains("1 instruction,"));
  CHECK(folder.run("check ball.json").err == "");
}

TEST_CASE("cli: eval prints distance, gradient and name", "[cli]") {
  const Folder folder;
  CHECK(folder.run("eval ball.json --at 0,2,0").out == "1.5 0 1 0 ball\n");
  CHECK(folder.run("eval ball.json --at -3,0,4 --number f32").out == "4.5 -0.6 0 0.8 ball\n");
  CHECK(folder.run("eval two.json --at -2,3,0 --at 2,0,-4").out == "2 0 1 0 left\n3 0 0 -1 right\n");
  CHECK(folder.run("eval two.json --at -2,3,0 --stage graph").out == "2 0 1 0 left\n");
  CHECK(folder.run("eval two.json --at -2,3,0 --after graph").out == "2 0 1 0 left\n");
  CHECK(folder.run("eval - --at 0,2,0", kBall).out == "1.5 0 1 0 ball\n");

  const Result range = folder.run("eval ball.json --box 1,0,0,2,0,0");
  std::istringstream numbers(range.out);
  double lo = 0, hi = 0;
  REQUIRE(numbers >> lo >> hi);
  CHECK((lo <= 0.5 && lo > 0.49 && hi >= 1.5 && hi < 1.51));
  CHECK_THAT(folder.run("eval ball.json --at 1,0,0 --number range").out, Contains(" "));
}

TEST_CASE("cli: eval reads points from a file, and names the line that is none", "[cli]") {
  const Folder folder;
  folder.write("points.txt", "# above\n0 2 0\n\n  \t\r\n3, 0, 0\n");
  CHECK(folder.run("eval ball.json --points points.txt").out == "1.5 0 1 0 ball\n2.5 1 0 0 ball\n");
  CHECK(folder.run("eval ball.json --points -", "0 2 0").out == "1.5 0 1 0 ball\n");
  folder.write("bad.txt", "0 2 0\n0 2\n");
  const Result bad = folder.run("eval ball.json --points bad.txt");
  CHECK(bad.code == 65);
  CHECK(bad.out == "");
  CHECK_THAT(bad.err, Contains("bad.txt:2: `0 2` is not a point"));
}

TEST_CASE("cli: render writes the picture, and what is asked for beside it", "[cli]") {
  const Folder folder;
  const Result result = folder.run("render ball.json -o a.png -o b.jpg -a -d -n --stats-json stats.json");
  CHECK(result.code == 0);
  CHECK(result.out == "");
  CHECK_THAT(result.err, Contains("drew ball.json: 32x16 pixels") && Contains("wrote a.png (32x16)"));
  for (const char* name : {"a.png", "a-albedo.png", "a-depth.png", "a-normal.png", "b.jpg", "b-albedo.jpg",
                           "b-depth.jpg", "b-normal.jpg", "stats.json"}) {
    CHECK(folder.has(name));
  }
  CHECK(folder.files() == 2 + 9);
  CHECK(png_size(folder.read("a.png")) == std::pair(32, 16));
  CHECK_THAT(folder.read("stats.json"), Contains("\"primary_rays\": 1024") &&  // 32 * 16 * 2
                                            Contains("\"scene\": \"ball.json\"") && Contains("\"program\": \"") &&
                                            Contains("\"size\": \"32x16\"") && Contains("\"spp\": \"2\"") &&
                                            Contains("\"seed\": \"0\"") && Contains("\"fathom\": \""));
}

TEST_CASE("cli: without -o the picture is named after the scene, in the current folder", "[cli]") {
  const Folder folder;
  const Result result = folder.run("render ./ball.json");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("the picture goes to ball.png"));
  CHECK(folder.has("ball.png"));
  CHECK(folder.run("render - --quiet", kBall).err == "");
  CHECK(folder.has("out.png"));
}

TEST_CASE("cli: flags override the scene", "[cli]") {
  const Folder folder;
  const auto size = [&](const std::string& flags) {
    REQUIRE(folder.run("render ball.json -o a.png " + flags).code == 0);
    return png_size(folder.read("a.png"));
  };
  CHECK(size("-r 20") == std::pair(20, 10));         // keeps the film's aspect ratio
  CHECK(size("--aspect 4:3") == std::pair(32, 24));  // keeps the width
  CHECK(size("--res 21 --aspect 1.5x1") == std::pair(21, 14));
  CHECK(size("--size 5x7") == std::pair(5, 7));
  CHECK(size("-r 1 --aspect 100:1") == std::pair(1, 1));
  CHECK_THAT(folder.run("render ball.json -s 3 --stats-json -").out, Contains("\"primary_rays\": 1536"));
  CHECK_THAT(folder.run("render ball.json -s 3 -s 1 --stats-json -").out, Contains("\"primary_rays\": 512"));

  const auto picture = [&](const std::string& flags) {
    REQUIRE(folder.run("render ball.json -o a.png -n " + flags).code == 0);
    return folder.read("a-normal.png");
  };
  const std::string plain = picture("");
  CHECK(picture("-f 45deg") == plain);
  CHECK(picture("-f 0.7853981633974483") == plain);
  CHECK(picture("-f 0.7853981633974483rad") == plain);
  CHECK(picture("-f 1.2") != plain);
  CHECK(picture("-t 3 --threads 1") == plain);
  CHECK(picture("--seed 7") != plain);
  CHECK(picture("--sampler blue --filter box") == plain);
  for (const char* other : {"--sampler sobol", "--sampler independent", "--filter gaussian", "--filter-width 2"}) {
    CAPTURE(std::string(other));
    CHECK(picture(other) != plain);
  }
}

TEST_CASE("cli: how samples and light are found, from the command line and the scene", "[cli]") {
  const Folder folder;
  const std::string scene = R"({"version": 1, "film": {"width": 48, "height": 32}, "render": {"spp": 8%},
      "background": [0.1, 0.1, 0.1], "camera": {"position": [0, 1, 4]},
      "materials": {"lamp": {"type": "emissive", "emission": [9, 9, 9]}, "mirror": {"type": "specular"}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
                  {"type": "sphere", "radius": 0.6, "material": "mirror"},
                  {"type": "sphere", "radius": 0.4, "translate": [1, 2, 0], "material": "lamp"}]})";
  const auto with = [&](const std::string& more) { return std::string(scene).replace(scene.find('%'), 1, more); };
  folder.write("lit.json", with(""));
  folder.write("shared.json", with(R"(, "noise_threshold": 0)"));
  const auto picture = [&](const std::string& flags) {
    REQUIRE(folder.run("render " + flags + " -o a.png").code == 0);
    return folder.read("a.png");
  };
  const auto numbers = [&](const std::string& flags) {
    const Result result = folder.run("render " + flags + " -q --stats-json - -o a.png");
    REQUIRE(result.code == 0);
    CHECK(result.err == "");
    return result.out;
  };
  const std::string plain = picture("lit.json"), shared = picture("lit.json --noise-threshold 0");
  CHECK(plain != shared);
  CHECK_THAT(numbers("lit.json --noise-threshold 0"), Contains("\"primary_rays\": 12288,"));
  CHECK(picture("shared.json") == shared);
  CHECK(picture("shared.json --uniform") == plain);
  CHECK(picture("shared.json -s 7") == picture("lit.json -s 7"));
  CHECK_THAT(folder.run("render shared.json --crop 0,0,4,4 -o a.png").err,
             Contains("--crop does not go with the scene's `noise_threshold`") && Contains("add --uniform"));
  CHECK(folder.run("render shared.json --crop 0,0,4,4 -o a.png").code == 2);
  CHECK(folder.run("render shared.json --crop 0,0,4,4 --uniform -o a.png").code == 0);
  CHECK_THAT(folder.run("render shared.json -vvv -o a.png").err, Contains(", adaptive"));

  CHECK_THAT(numbers("lit.json --light-sampling bsdf"), Contains("\"shadow_rays\": 0,"));
  CHECK_THAT(numbers("lit.json --light-sampling nee"), !Contains("\"shadow_rays\": 0,"));
  CHECK(picture("lit.json --light-sampling mis") == plain);

  CHECK(picture("lit.json --clamp 1e6") == plain);
  CHECK(picture("lit.json --clamp 0.01") != plain);
  CHECK_THAT(folder.run("render lit.json --clamp 1 -o a.png").err, Contains("light is lost"));
  CHECK(folder.run("render lit.json --clamp 1 -q -o a.png").err == "");
}

TEST_CASE("cli: --fov takes the place of a focal length, and a panorama has none", "[cli]") {
  const Folder folder;
  const std::string rest = R"("film": {"width": 8, "height": 8}, "objects": [{"type": "sphere", "radius": 1}]})";
  folder.write("lens.json", R"({"version": 1, "camera": {"focal_length": 50}, )" + rest);
  folder.write("plain.json", R"({"version": 1, "camera": {}, )" + rest);
  REQUIRE(folder.run("render lens.json -o a.png -n -f 45deg").code == 0);
  REQUIRE(folder.run("render plain.json -o b.png -n").code == 0);
  CHECK(folder.read("a-normal.png") == folder.read("b-normal.png"));
  folder.write("round.json", R"({"version": 1, "camera": {"type": "panorama"}, )" + rest);
  const Result result = folder.run("render round.json -f 45deg");
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Contains("panorama"));
  CHECK(folder.run("render round.json").code == 0);
}

TEST_CASE("cli: an orthographic camera has no field of view to override", "[cli]") {
  const Folder folder;
  folder.write("flat.json", R"({"version": 1, "camera": {"type": "orthographic"}, "film": {"width": 8, "height": 8},
    "objects": [{"type": "sphere", "radius": 1}]})");
  const Result result = folder.run("render flat.json -f 45deg");
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Contains("orthographic"));
  CHECK(folder.run("render flat.json").code == 0);
}

TEST_CASE("cli: -v says more each time, up to six", "[cli]") {
  const Folder folder;
  std::size_t shorter = 0;
  for (const char* flags : {"", "-v", "-vv", "-vvv", "-vvvv", "-vvvvv", "-vvvvvv"}) {
    const Result result = folder.run(std::string("render ball.json -o a.png ") + flags);
    CHECK(result.code == 0);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') > static_cast<std::ptrdiff_t>(shorter));
    shorter = static_cast<std::size_t>(std::count(result.err.begin(), result.err.end(), '\n'));
  }
  CHECK(folder.run("render ball.json -o a.png -vvvvvvvvv").code == 0);
  CHECK(folder.run("render ball.json -o a.png -q").err == "");
}

TEST_CASE("cli: the program does as its verbs do in the tests' process", "[cli]") {
  const Folder folder;
  folder.write("a 'b' \\.json", kBall);
  folder.write("bad.json", "{");
  for (const char* arguments : {"", "-V", "eval - --at 0,2,0", "check bad.json", "eval missing.json --at 0,0,0",
                                "check \"a 'b' \\\\.json\" a\\ \\'b\\'\\ \\\\.json 'a '\"'b'\"' \\.json' ''"}) {
    CAPTURE(arguments);
    const Result inside = folder.run(arguments, kBall);
    const Result program = folder.run_script("unset COLUMNS; $fathom " + std::string(arguments) + " <ball.json");
    CHECK(program.code == inside.code);
    CHECK(program.out == inside.out);
    CHECK(program.err == inside.err);
  }
}

TEST_CASE("cli: standard output that is full or closed is exit code 74", "[cli]") {
  for (const char* output : {">/dev/full", ">&-"}) {
    CAPTURE(output);
    const Result result = Folder().run_script(std::string("$fathom --help ") + output);
    CHECK(result.code == 74);
    CHECK_THAT(result.err, Contains("cannot write to standard output"));
  }
}

TEST_CASE("cli: messages on a terminal have colours, unless NO_COLOR or TERM forbids them", "[cli]") {
  const Folder folder;
  folder.write("bad.json", "{");
  if (folder.run_script("script -qec true /dev/null").code != 0) return fathom::test::not_run("no pseudo-terminals");
  const auto shown = [&](const std::string& variables) {
    return folder.run_script(variables + " script -qec \"'$fathom' check bad.json\" /dev/null").out;
  };
  CHECK_THAT(shown("NO_COLOR= TERM=xterm"), Contains("bad.json") && Contains("\033["));
  CHECK_THAT(shown("NO_COLOR=1 TERM=xterm"), Contains("bad.json") && !Contains("\033["));
  CHECK_THAT(shown("NO_COLOR= TERM=dumb"), Contains("bad.json") && !Contains("\033["));
}

TEST_CASE("cli: output that is not a terminal has no colours and no redrawn lines", "[cli]") {
  const Folder folder;
  folder.write("bad.json", "{");
  for (const char* arguments : {"render ball.json -o a.png", "check bad.json"}) {
    CHECK_THAT(folder.run_script("$fathom " + std::string(arguments)).err, !Contains("\033") && !Contains("\r"));
  }
}

}  // namespace fathom::cli_test
