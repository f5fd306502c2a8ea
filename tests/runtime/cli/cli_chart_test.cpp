// End-to-end tests of `fathom chart`, and of `fathom render` with other marching methods.
#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_chart_test {

namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using fathom::test::Folder;
using fathom::test::kBall;
using fathom::test::png_size;
using fathom::test::Result;

const char* const kFew = " --rays 100 --rounds 1";

// Rays that bounce off the ground can hit the ball.
const char* const kGround = R"({"version": 1, "film": {"width": 24, "height": 12}, "render": {"spp": 2},
  "camera": {"position": [0, 0.5, 4], "target": [0, -0.5, 0]}, "background": [1, 1, 1],
  "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1}, {"type": "sphere", "radius": 1}]})";

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::ptrdiff_t fields(const std::string& line) { return std::count(line.begin(), line.end(), ',') + 1; }

}  // namespace

TEST_CASE("cli: chart writes a page, tables, charts and maps", "[cli]") {
  const Folder folder;
  folder.write("ground.json", kGround);
  const Result result =
      folder.run(std::string("chart ground.json -o a/b --size 6x4 -s 4 --seeds 2 --reference-spp 8") + kFew);
  REQUIRE(result.code == 0);
  CHECK_THAT(result.out,
             Contains("the default is on the Pareto front of time: camera") && Contains("of evaluations"));
  CHECK_THAT(result.err,
             Contains("ground: 100 rays of each class by 33 methods") && Contains("wrote a/b/index.html"));
  CHECK(names_in(folder.path() / "a/b") ==
        std::set<std::string>{"chart.csv", "images.csv", "index.html", "ground-evaluations.svg", "ground-time.svg",
                              "ground-pictures.svg", "ground-map-depth-error.png", "ground-map-double.png",
                              "ground-map-evaluations.png"});
  const std::vector<std::string> rays = lines_of(folder.read("a/b/chart.csv"));
  REQUIRE(rays.size() == 1 + 3 * 33);
  CHECK(rays[0].starts_with("scene,method,precision,eps,relax,steps_max,class,rays,"));
  CHECK(rays[1].starts_with("ground,tiered,f32,0,0,0,camera,100,"));
  const std::vector<std::string> pictures = lines_of(folder.read("a/b/images.csv"));
  CHECK(pictures.size() == 1 + 4);  // a header, and four methods at 4 samples
  for (const auto* table : {&rays, &pictures}) {
    for (const std::string& line : *table) CHECK(fields(line) == fields(table->front()));
  }
  for (const std::string name : {"evaluations", "time", "pictures"}) {
    CHECK(folder.read("a/b/ground-" + name + ".svg").substr(0, 4) == "<svg");
  }
  const std::string page = folder.read("a/b/index.html");
  for (const std::string& name : names_in(folder.path() / "a/b")) {
    if (!name.ends_with(".svg") && name != "index.html") CHECK_THAT(page, Contains("\"" + name + "\""));
  }
}

TEST_CASE("cli: chart of a scene with a lamp compares ways to find light", "[cli]") {
  const Folder folder;
  folder.write("lamp.json", R"({"version": 1, "film": {"width": 24, "height": 12}, "background": [0.1, 0.1, 0.1],
    "camera": {"position": [0, 0.5, 4], "target": [0, -0.5, 0]},
    "materials": {"lamp": {"type": "emissive", "emission": [9, 9, 9]}},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
                {"type": "sphere", "radius": 0.5, "material": "lamp"}]})");
  const Result result =
      folder.run(std::string("chart lamp.json -o a --size 6x4 -s 4 --seeds 2 --reference-spp 8") + kFew);
  REQUIRE(result.code == 0);
  CHECK(folder.read("a/lamp-light.svg").substr(0, 4) == "<svg");
  CHECK_THAT(folder.read("a/index.html"), Contains("finding light: lamp"));
  const std::vector<std::string> pictures = lines_of(folder.read("a/images.csv"));
  REQUIRE(pictures.size() == 1 + 9);
  CHECK(pictures[0].starts_with("scene,method,precision,eps,sampler,lights,spp,seeds,"));
  CHECK(pictures[9].starts_with("lamp,tiered,f32,0,independent,bsdf,4,2,"));
}

TEST_CASE("cli: chart without pictures, quietly, from standard input and of a scene where nothing is seen", "[cli]") {
  const Folder folder;
  const Result quiet = folder.run(std::string("chart - -o a -q --no-images") + kFew, kBall);
  CHECK(quiet.code == 0);
  CHECK(quiet.err == "");
  CHECK(names_in(folder.path() / "a") == std::set<std::string>{"chart.csv", "index.html", "scene-evaluations.svg",
                                                               "scene-time.svg", "scene-map-depth-error.png",
                                                               "scene-map-double.png", "scene-map-evaluations.png"});
  folder.write("away.json", R"({"version": 1, "camera": {"position": [0, 0, 4], "target": [0, 0, 8]},
      "objects": [{"type": "sphere", "radius": 1}]})");
  const Result away = folder.run(std::string("chart away.json -o b --no-images") + kFew);
  CHECK(away.code == 0);
  CHECK_THAT(away.out, Contains("camera (no ray hits)") && !Contains("bounce"));
  CHECK(lines_of(folder.read("b/chart.csv")).size() == 1 + 33);
}

TEST_CASE("cli: chart's maps keep the film's shape, however tall it is", "[cli]") {
  const Folder folder;
  const int scale = 34;  // height of the strip below a map
  for (const auto& [film, size] : {std::pair(R"("width": 64, "height": 16)", std::pair(320, 80 + scale)),
                                   std::pair(R"("width": 16, "height": 64)", std::pair(80, 320 + scale)),
                                   std::pair(R"("width": 1, "height": 65535)", std::pair(1, 320 + scale))}) {
    folder.write(
        "film.json",
        std::string(R"({"version": 1, "objects": [{"type": "sphere", "radius": 1}], "film": {)") + film + "}}");
    REQUIRE(folder.run(std::string("chart film.json -o a --no-images") + kFew).code == 0);
    CHECK(png_size(folder.read("a/film-map-evaluations.png")) == size);
  }
}

TEST_CASE("cli: chart says what is wrong, and leaves nothing behind", "[cli]") {
  struct Case {
    const char* arguments;
    int code;
    const char* message;
  };
  const Case cases[] = {
      {"ball.json --ray 100", 2, "did you mean `--rays`?"},
      {"ball.json --march sphere", 2, "unknown option `--march`"},
      {"ball.json two.json", 2, "unexpected argument `two.json`"},
      {"ball.json --rays 5", 2, "--rays: `5` is not a whole number from 100 to"},
      {"ball.json --rounds 0", 2, "--rounds: `0`"},
      {"ball.json --spp 1", 2, "--spp: `1` is not a whole number from 2 to"},
      {"ball.json --seeds 0", 2, "--seeds: `0`"},
      {"ball.json --seed -1", 2, "--seed: `-1`"},
      {"ball.json --size 12", 2, "write it as 1920x1080"},
      {"ball.json -o ''", 2, "--output: the folder needs a name"},
      {"ball.json -D radius", 2, "--define: `radius` is not a name and a value"},
      {"missing.json", 74, "cannot read `missing.json`: No such file or directory"},
      {"bad.json", 65, "did you mean `sphere`?"},
      {"ball.json -o bad.json", 74, "cannot write to the folder `bad.json`: "},
      {"ball.json -o bad.json/charts", 74, "cannot write to the folder `bad.json/charts`: "},
      {"ball.json -o /proc/charts", 74, "cannot write to the folder `/proc`: "},
  };
  const Folder folder;
  folder.write("bad.json", R"({"version": 1, "objects": [{"type": "spere", "radius": 1}]})");
  for (const Case& c : cases) {
    INFO("fathom chart " << c.arguments);
    const Result result = folder.run(std::string("chart ") + c.arguments);
    CHECK(result.code == c.code);
    CHECK_THAT(result.err, Contains(c.message) && Contains("error"));
    CHECK(result.out == "");
  }
  CHECK(folder.files() == 3);  // only the scenes
}

TEST_CASE("cli: render follows rays as it is told", "[cli]") {
  const Folder folder;
  folder.write("ground.json", kGround);
  const auto picture = [&](const std::string& flags) {
    const Result result = folder.run("render ground.json -q -o a.png " + flags);
    INFO(flags << ": " << result.err);
    REQUIRE(result.code == 0);
    return folder.read("a.png");
  };
  const std::string certified = picture("--march certified");
  CHECK(picture("--march certified --threads 1") == certified);
  CHECK(picture("--march certified --threads 2") == certified);
  const std::string sphere = picture("--march sphere");
  CHECK(picture("--march sphere --epsilon 1e-4 --max-steps 512") == sphere);
  CHECK(picture("--march sphere --epsilon 0.1") != sphere);
  CHECK(picture("--march sphere --max-steps 4") != sphere);
  CHECK(picture("--march sphere --precision f64 --epsilon 1e-3 --threads 1") ==
        picture("--march sphere --precision f64 --epsilon 1e-3 --threads 2"));
  CHECK(picture("--march tiered") == picture(""));
  for (const char* flags :
       {"--march relaxed --relaxation 1.2", "--march automatic --epsilon 1e-3", "--march tiered --precision f64"}) {
    CHECK(png_size(picture(flags)) == std::pair(24, 12));
  }
}

TEST_CASE("cli: ways to follow rays that do not go together are exit code 2", "[cli]") {
  struct Case {
    const char* arguments;
    const char* message;
  };
  const Case cases[] = {
      {"--march spheres", "--march: `spheres` is not one of tiered, sphere, relaxed, automatic, certified"},
      {"--epsilon 1e-3", "--epsilon and --max-steps: the method `tiered` has neither"},
      {"--max-steps 9", "they go with --march sphere, relaxed or automatic"},
      {"--march certified --epsilon 1e-3", "the method `certified` has neither"},
      {"--march relaxed --relaxation 2", "--relaxation: `2` is not a number in [1, 2)"},
      {"--march relaxed --relaxation 0.9", "1 is plain sphere tracing"},
      {"--march relaxed --relaxation nan", "--relaxation: `nan`"},
      {"--relaxation 1.5", "--relaxation goes with --march relaxed only"},
      {"--march sphere --relaxation 1.5", "--relaxation goes with --march relaxed only"},
      {"--march sphere --epsilon 0", "--epsilon: `0` is not a positive number"},
      {"--march sphere --epsilon tiny", "--epsilon: `tiny`"},
      {"--march sphere --max-steps 0", "--max-steps: `0`"},
      {"--precision f16", "--precision: `f16` is not one of f32, f64"},
      {"--march certified --precision f32", "certified"},
  };
  const Folder folder;
  for (const Case& c : cases) {
    INFO("fathom render ball.json " << c.arguments);
    const Result result = folder.run(std::string("render ball.json -o a.png ") + c.arguments);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains(c.message) && Contains("error: "));
    CHECK(result.out == "");
  }
  CHECK(folder.files() == 2);
}

TEST_CASE("cli: the closing numbers say how rays ended", "[cli]") {
  const Folder folder;
  const auto stats = [&](const std::string& flags) {
    const Result result = folder.run("render ball.json -q -o a.png --stats-json - " + flags);
    REQUIRE(result.code == 0);
    return result.out;
  };
  for (const char* key : {"hits", "misses", "near_misses", "clipped_rays"}) {
    CHECK_THAT(stats(""), Contains("\"" + std::string(key) + "\": "));
  }
  CHECK_THAT(stats(""),
             Contains("\"near_misses\": 0") && !Contains("\"misses\": 0") && !Contains("\"clipped_rays\": 0"));
  CHECK_THAT(stats("--march sphere --max-steps 2"), !Contains("\"exhausted_rays\": 0"));
}

}  // namespace fathom::cli_chart_test
