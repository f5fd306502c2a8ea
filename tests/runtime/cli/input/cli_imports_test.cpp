// End-to-end tests of imports: which files may be read, compiled scenes that contain their imports, and messages.
#include <filesystem>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_imports_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::Result;

const char* const kLibrary = "fathom 1\nparam r(max = 2) = 1\ndef ball(n) = sphere(n*r)\nobject ball(1)\n";
const char* const kScene = "fathom 1\nimport \"lib/balls.fathom\"(r = 0.5) as balls\nobject \"a\" balls.ball(2)\n";

void write_scene(const Folder& folder) {
  std::filesystem::create_directories(folder.path() / "s/lib");
  folder.write("s/lib/balls.fathom", kLibrary);
  folder.write("s/a.fathom", kScene);
}

}  // namespace

TEST_CASE("cli: imports are relative to the file that has them, wherever one is", "[cli]") {
  const Folder folder;
  write_scene(folder);
  CHECK(folder.run("eval s/a.fathom --at 2,0,0").out == "1 1 0 0 a\n");
  CHECK(folder.run("eval " + (folder.path() / "s/a.fathom").string() + " --at 2,0,0").out == "1 1 0 0 a\n");
  CHECK_THAT(folder.run("check s/a.fathom").out, Contains("s/a.fathom: no errors"));
  CHECK_THAT(folder.run("dump s/a.fathom").out, Contains("@3:15 sphere \"a\" in lib/balls.fathom"));
  CHECK_THAT(folder.run("convert s/a.fathom").out, Contains("\"radius\": \"2*0.5\""));
  // For standard input, imports are relative to the current folder.
  CHECK_THAT(folder.run("check -", kScene).err, Contains("`lib/balls.fathom` cannot be imported: No such file"));
  CHECK(folder.run("check -", "fathom 1\nimport \"s/lib/balls.fathom\" as b\nobject b.scene\n").code == 0);
}

TEST_CASE("cli: imports out of the folder are refused, by links too, and --root allows a larger one", "[cli]") {
  const Folder folder;
  write_scene(folder);
  std::filesystem::create_directories(folder.path() / "s/deep");
  folder.write("s/deep/b.fathom", "fathom 1\nimport \"../lib/balls.fathom\" as balls\nobject balls.ball(1)\n");
  const Result refused = folder.run("check s/deep/b.fathom");
  CHECK(refused.code == 1);
  CHECK_THAT(refused.err, Contains("s/deep/b.fathom:2:8") && Contains("it is not in the scene's folder") &&
                              Contains("--root DIR"));
  CHECK(folder.run("check s/deep/b.fathom --root s").code == 0);
  CHECK_THAT(folder.run("check s/deep/b.fathom --root s/lib/..").out, Contains("no errors"));
  CHECK_THAT(folder.run("check s/deep/b.fathom --root s/deep").err, Contains("that --root names"));
  CHECK_THAT(folder.run("check s/deep/b.fathom --root nowhere").err, Contains("E0810"));
  folder.write("secret.fathom", kLibrary);
  std::filesystem::create_symlink("../secret.fathom", folder.path() / "s/link.fathom");
  folder.write("s/c.fathom", "fathom 1\nimport \"link.fathom\" as l\nobject l.scene\n");
  CHECK_THAT(folder.run("check s/c.fathom").err, Contains("it is not in the scene's folder"));
  folder.write("s/d.fathom", "fathom 1\nimport \"lib\" as l\nobject l.scene\n");
  CHECK_THAT(folder.run("check s/d.fathom").err, Contains("it is no file"));
}

TEST_CASE("cli: compiled scenes carry what they import", "[cli]") {
  const Folder folder;
  write_scene(folder);
  REQUIRE(folder.run("compile s/a.fathom -o a.fbc").code == 0);
  REQUIRE(folder.run("render s/a.fathom -o scene.png -s 2 --size 24x16").code == 0);
  std::filesystem::remove_all(folder.path() / "s");
  CHECK(folder.run("eval a.fbc --at 2,0,0").out == "1 1 0 0 a\n");
  CHECK(folder.run("eval a.fbc --at 2,0,0").err.empty());
  REQUIRE(folder.run("render a.fbc -o file.png -s 2 --size 24x16").code == 0);
  CHECK(folder.read("file.png") == folder.read("scene.png"));
  REQUIRE(folder.run("dump a.fbc --listing -o a.txt").code != 70);
}

TEST_CASE("cli: messages name the file, and the calls that led there", "[cli]") {
  const Folder folder;
  write_scene(folder);
  folder.write("s/e.fathom", "fathom 1\nimport \"lib/balls.fathom\" as balls\nobject balls.ball(-1)\n");
  const Result wrong = folder.run("check s/e.fathom");
  CHECK(wrong.code == 1);
  CHECK(folder.run("render s/e.fathom -o e.png").code == 65);
  CHECK_THAT(wrong.err, Contains("--> s/lib/balls.fathom:3:22") && Contains("in `ball`, called at s/e.fathom:3:8"));
  CHECK_THAT(folder.run("check s/e.fathom --error-format short").err, Contains("s/lib/balls.fathom:3:22: error:"));
  CHECK_THAT(folder.run("check s/e.fathom --error-format json").err,
             Contains("\"file\":\"s/lib/balls.fathom\",\"line\":3"));
}

}  // namespace fathom::cli_imports_test
