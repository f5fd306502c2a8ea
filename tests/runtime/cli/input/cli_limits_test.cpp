// --limit on the command line, and the program's own limits: file size, image size, memory.
#include <fmt/format.h>

#include <string>

#include "compiler/source/limits.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_limits_test {

namespace {

using namespace fathom::test;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("cli: --limit sets a limit, by name", "[cli]") {
  const Folder folder;
  CHECK(folder.run("check two.json --limit nodes=9").code == 0);
  const Result refused = folder.run("render -q two.json -o out.png --limit nodes=3");
  CHECK(refused.code == 65);
  CHECK(contains(refused.err, "two.json:6:"));
  CHECK(contains(refused.err, "more than 3 nodes"));
  CHECK(contains(refused.err, "--limit nodes=6"));
  CHECK_FALSE(folder.has("out.png"));
  // Every verb that reads a scene has the option. The last value of a limit counts.
  for (const char* verb : {"check", "dump", "eval --at 0,0,0", "slice -o out.png", "emit cpp", "import"}) {
    INFO(verb);
    const Result result = folder.run(std::string(verb) + " two.json --limit nodes=9 --limit nodes=3");
    CHECK(contains(result.err, "more than 3 nodes"));
  }
}

TEST_CASE("cli: what --limit cannot be is explained", "[cli]") {
  const Folder folder;
  const auto check = [&](const std::string& given, const std::string& message, const std::string& help) {
    const Result result = folder.run("check ball.json --limit " + given);
    INFO(given << ": " << result.err);
    CHECK(result.code == 2);
    CHECK(contains(result.err, message));
    CHECK(contains(result.err, help));
  };
  check("node=9", "there is no limit `node`", "did you mean `nodes`?");
  check("zebra=9", "there is no limit `zebra`", "fathom help limits");
  check("nodes", "`nodes` is not a name and a value", "nodes=2000000");
  check("nodes=0", "can be from 1 to 1000000000 nodes", "");
  check("nesting=5000", "can be from 1 to 4096 levels", "the stack's size");
  const Result table = folder.run("help limits");
  CHECK(table.code == 0);
  for (const fathom::compiler::LimitRow& row : fathom::compiler::kLimits) {
    CHECK(contains(table.out, "  " + std::string(row.name) + " "));
  }
}

TEST_CASE("cli: a file is read to the limit of its size, whatever it is", "[cli]") {
  const Folder folder;
  const std::string ball = kBall;
  const std::string size = std::to_string(ball.size()), less = std::to_string(ball.size() - 1);
  CHECK(folder.run("check ball.json --limit file-size=" + size).code == 0);
  const Result refused = folder.run("render -q ball.json -o out.png --limit file-size=" + less);
  CHECK(refused.code == 65);
  CHECK(contains(refused.err, "cannot read `ball.json`: it has more than " + less + " bytes"));
  CHECK(folder.run("render -q - -o out.png --limit file-size=" + less, ball).code == 65);
  folder.write("points.txt", "0 0 0\n0 0 1\n");
  CHECK(folder.run("eval ball.json --points points.txt --limit file-size=" + size).code == 0);
  folder.write("many.txt", std::string(ball.size() / 6 + 1, '\n') + std::string(2 * ball.size(), ' '));
  CHECK(folder.run("eval ball.json --points many.txt --limit file-size=" + size).code == 65);
}

// Regions get whole MiB, half of the memory that the film leaves. The nodes of 400 balls take 2.6 MB.
TEST_CASE("cli: regions get no more memory than the limit leaves", "[cli]") {
  const Folder folder;
  std::string balls;
  for (int i = 0; i < 400; ++i) {
    balls += fmt::format(R"({}{{"type": "sphere", "radius": 0.15, "translate": [{}, {}, {}]}})", i == 0 ? "" : ", ",
                         i % 7 * 0.1, i / 7 % 7 * 0.1, i / 49 * 0.1);
  }
  folder.write("balls.json", R"({"version": 1, "background": [1, 1, 1], "objects": [)" + balls + "]}");
  const std::string render = "render -v balls.json -s 4 --size 160x160 -o out.png --limit memory=";
  const Result much = folder.run(render + "1e7"), little = folder.run(render + "2.6e6");
  INFO(much.err << little.err);
  CHECK(much.code == 0);
  CHECK(little.code == 0);
  CHECK(contains(much.err, "memory of regions"));
  CHECK_FALSE(contains(little.err, "memory of regions"));
}

TEST_CASE("cli: memory is counted before it is taken", "[cli]") {
  const Folder folder;
  // 112 bytes per pixel: 32 of radiance, 56 of the first hit and 24 of the image.
  CHECK(folder.run("render -q ball.json -s 1 -o out.png -a --size 100x10 --limit memory=112000").code == 0);
  const Result refused = folder.run("render -q ball.json -s 1 -o no.png -a --size 100x10 --limit memory=111999");
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "1000 pixels of 112 bytes"));
  CHECK_FALSE(folder.has("no.png"));
  // A noise threshold adds a stage of 32 bytes, and 48 bytes of variance to both stages. --denoise adds a copy of the
  // film and its own buffers.
  for (const auto& [arguments, each] : {std::pair{"--noise-threshold 1", 184}, {"--denoise", 392}}) {
    const std::string render = "render -q ball.json -s 16 -o out.png --size 100x10 " + std::string(arguments);
    CHECK(folder.run(render + " --limit memory=" + std::to_string(each * 1000)).code == 0);
    const Result more = folder.run(render + " --limit memory=" + std::to_string(each * 1000 - 1));
    CHECK(more.code == 2);
    CHECK(contains(more.err, "1000 pixels of " + std::to_string(each) + " bytes"));
  }
  folder.write("large.json", R"({"version": 1, "film": {"width": 1000, "height": 1000},
      "objects": [{"type": "sphere", "radius": 1}]})");
  const Result scene = folder.run("render -q large.json -o no.png --limit memory=1e6");
  CHECK(scene.code == 65);
  CHECK(contains(scene.err, "large.json"));
  CHECK(contains(scene.err, "--limit memory="));
  // Reading an image counts its file, the decoder's buffer and the decoded numbers.
  CHECK(folder.run("tonemap out.png -o out.bmp --limit memory=1e5").code == 0);
  const Result picture = folder.run("tonemap out.png -o no.png --limit memory=18000");
  CHECK(picture.code == 65);
  CHECK(contains(picture.err, "`out.png`"));
  CHECK(contains(picture.err, "18000 are allowed"));
  CHECK(folder.run("diff out.png out.png --limit memory=18000").code == 65);
}

TEST_CASE("cli: a picture's size is limited on the command line, too", "[cli]") {
  const Folder folder;
  // The scene's image has 512.
  CHECK(folder.run("render -q ball.json -s 1 -o out.png --limit pixels=511").code == 65);
  CHECK(folder.run("render -q ball.json -s 1 -o out.png --size 20x10 --limit pixels=512").code == 0);
  const Result side = folder.run("render -q ball.json -s 1 -o out.png --size 33x1 --limit image-side=32");
  CHECK(side.code == 2);
  CHECK(contains(side.err, "a picture of 33 by 1 pixels is too large"));
}

}  // namespace

}  // namespace fathom::cli_limits_test
