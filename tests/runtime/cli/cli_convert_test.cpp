// End-to-end tests of scenes in Fathom's own notation: every verb, conversion and layout.

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_convert_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

const char* const kPosts =
    "fathom 1\n// Posts in a row.\nparam n(min = 1, max = 9) = 3\nbackground [1, 1, 1]\n"
    "object \"posts\" [for i in 0..n: cylinder(0.1, 0.5).translate([i, 0, 0])]\nobject \"ball\" sphere(n/6)\n";

}  // namespace

TEST_CASE("cli: every verb reads texts, from files of any name and from standard input", "[cli]") {
  const Folder folder;
  folder.write("posts.fathom", kPosts);
  CHECK_THAT(folder.run("check posts.fathom").out, Contains("posts.fathom: no errors"));
  CHECK(folder.run("dump posts.fathom").code == 0);
  CHECK(folder.run("dump --stage syntax posts.fathom").out.starts_with("version: 1\n"));
  CHECK(folder.run("render posts.fathom -o a.png -s 1 --size 16x16").code == 0);
  CHECK(folder.run("slice posts.fathom -o a.png --size 8x8").code == 0);
  CHECK(folder.run("emit cpp posts.fathom -o a.h").code == 0);
  CHECK(folder.run("check -", kPosts).code == 0);
  CHECK(folder.run("eval posts.fathom --at 0,0.75,0 -D n=1").out == "0.25 0 1 0 posts\n");
  CHECK_THAT(folder.run("eval posts.fathom --at 0,0,0 -D n=10").err, Contains("`n` must be between 1 and 9"));
  CHECK(folder.run("compile posts.fathom -o a.fbc").code == 0);
  CHECK(folder.run("eval a.fbc --at 0,0.75,0 -D n=1").out == "0.25 0 1 0 posts\n");
}

TEST_CASE("cli: convert goes from JSON to text and back", "[cli]") {
  const Folder folder;
  folder.write(
      "a.json",
      "// A ball.\n{\"version\": 1, \"params\": {\"r\": 0.5}, \"background\": [1, 1, 1], // white\n \"objects\": "
      "[{\"type\": \"sphere\", \"radius\": \"2*r\", \"name\": \"a ball\"}]}\n");
  const Result text = folder.run("convert a.json -o a.fathom");
  CHECK(text.code == 0);
  CHECK(text.err.ends_with("wrote a.fathom\n"));
  CHECK(folder.read("a.fathom") ==
        "fathom 1\n\n// A ball.\nparam r = 0.5\n\nbackground [1, 1, 1]  // white\n\nobject \"a ball\" sphere(2*r)\n");
  CHECK(folder.run("convert a.fathom").out ==
        "{\n  \"version\": 1,\n  \"params\": {\n    // A ball.\n    \"r\": 0.5\n  },\n  // white\n"
        "  \"background\": [1, 1, 1],\n"
        "  \"objects\": [{\"type\": \"sphere\", \"radius\": \"2*r\", \"name\": \"a ball\"}]\n}\n");
  folder.write("posts.fathom", kPosts);
  const Result posts = folder.run("convert posts.fathom");
  CHECK_THAT(posts.out, Contains("\"radius\": \"n/6\""));
  CHECK_THAT(posts.err, Contains("parameters have their default at posts.fathom:5:29"));
  CHECK(folder.run("convert posts.fathom -D n=4").code == 2);
  CHECK(folder.run("convert a.json -o a.json").code == 2);
  folder.write("bad.fathom", "fathom 1\nobject sphere(\n");
  CHECK(folder.run("convert bad.fathom").code == 65);
}

// The digits of 2^53 + 1 and of 2^64 - 1 were lost, or the seeds refused.
TEST_CASE("cli: convert and fmt keep all digits of seeds", "[cli]") {
  const Folder folder;
  const auto seed_in = [](const std::string& text) {
    const std::size_t at = text.find_first_of("0123456789", text.find("seed"));
    return text.substr(at, text.find_first_not_of("0123456789", at) - at);
  };
  for (const std::string seed : {"9007199254740993", "18446744073709551615"}) {
    folder.write("a.json", R"({"version": 1, "render": {"seed": )" + seed +
                               R"(}, "objects": [{"type": "sphere", "radius": 1}]})");
    REQUIRE(folder.run("convert a.json -o a.fathom").code == 0);
    CHECK(seed_in(folder.read("a.fathom")) == seed);
    CHECK(seed_in(folder.run("convert a.fathom").out) == seed);
    CHECK(seed_in(folder.run("fmt a.fathom").out) == seed);
    CHECK(seed_in(folder.run("dump --stage syntax a.fathom").out) == seed);
    folder.write("named.fathom", "fathom 1\nlet n = " + seed + "\nrender (seed = (n))\nobject sphere(1)\n");
    CHECK(seed_in(folder.run("convert named.fathom").out) == seed);
  }
}

// Materials that differ in nothing else were one material.
TEST_CASE("cli: materials of two seeds stay two", "[cli]") {
  const Folder folder;
  folder.write("a.fathom",
               "fathom 1\ndef cloud(n) = diffuse(color = noise(a = 0, b = 1, seed = n))\n"
               "object sphere(1).material(cloud(9007199254740992))\n"
               "object sphere(1).translate([2, 0, 0]).material(cloud(9007199254740993))\n");
  const std::string json = folder.run("convert a.fathom").out;
  CHECK_THAT(json, Contains("9007199254740992") && Contains("9007199254740993"));
}

// The first comment of a text, which speaks of the scene, was put among its parameters.
TEST_CASE("cli: convert keeps comments on the whole file before everything", "[cli]") {
  const Folder folder;
  folder.write(
      "a.fathom",
      "// By Ada.\nfathom 1\n// A ball on\n// its own.\n\n// Of the ball.\nparam r = 0.5\nobject sphere(r)\n");
  CHECK(folder.run("convert a.fathom").out ==
        "{\n  // By Ada.\n  // A ball on\n  // its own.\n  \"version\": 1,\n  \"params\": {\n    // Of the ball.\n"
        "    \"r\": 0.5\n  },\n  \"objects\": [{\"type\": \"sphere\", \"radius\": \"r\"}]\n}\n");
}

TEST_CASE("cli: fmt prints, writes and checks the layout", "[cli]") {
  const Folder folder;
  folder.write("a.fathom", "fathom 1\nobject sphere( 1 )\n");
  CHECK(folder.run("fmt a.fathom").out == "fathom 1\nobject sphere(1)\n");
  CHECK(folder.run("fmt --check a.fathom").code == 1);
  CHECK(folder.read("a.fathom") == "fathom 1\nobject sphere( 1 )\n");
  CHECK(folder.run("fmt -w a.fathom").code == 0);
  CHECK(folder.read("a.fathom") == "fathom 1\nobject sphere(1)\n");
  CHECK(folder.run("fmt --check a.fathom").code == 0);
  CHECK(folder.run("fmt -", "fathom 1\nobject sphere( 1 )\n").out == "fathom 1\nobject sphere(1)\n");
  folder.write("b.fathom", "fathom 1\nobject sphere(\n");
  CHECK(folder.run("fmt -w b.fathom a.fathom").code == 65);
  CHECK(folder.read("b.fathom") == "fathom 1\nobject sphere(\n");
  folder.write("c.json", "{\"version\": 1}");
  CHECK_THAT(folder.run("fmt c.json").err, Contains("`fathom convert` writes a JSON scene as text"));
  CHECK(folder.run("fmt -w --check a.fathom").code == 2);
  CHECK(folder.run("fmt -w -").code == 2);
  CHECK(folder.run("fmt nothing.fathom").code == 74);
}

}  // namespace fathom::cli_convert_test
