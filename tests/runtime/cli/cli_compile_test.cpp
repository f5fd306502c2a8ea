// `fathom compile` and `fathom asm`, and every verb on their output.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::test::cli_compile_test {
namespace {

using Catch::Contains;

constexpr const char* kSettable = R"({
  "version": 1,
  "params": {"r": {"default": 0.5, "min": 0.1, "max": 2}},
  "film": {"width": 24, "height": 16},
  "objects": [{"name": "ball", "type": "sphere", "radius": "r"}]
})";

}  // namespace

TEST_CASE("a compiled scene renders to the same bits as the scene", "[cli]") {
  const Folder folder;
  for (const char* name : {"ball", "two"}) {
    const std::string scene = name;
    REQUIRE(folder.run("compile " + scene + ".json -o " + scene + ".fbc").code == 0);
    REQUIRE(folder.run("render " + scene + ".json -r 32 -s 2 -o a.exr -q").code == 0);
    REQUIRE(folder.run("render " + scene + ".fbc -r 32 -s 2 -o b.exr -q").code == 0);
    CHECK(folder.read("a.exr") == folder.read("b.exr"));
    // Names and source locations do not affect the image.
    REQUIRE(folder.run("compile --strip " + scene + ".json -o " + scene + ".fbc").code == 0);
    REQUIRE(folder.run("render " + scene + ".fbc -r 32 -s 2 -o b.exr -q").code == 0);
    CHECK(folder.read("a.exr") == folder.read("b.exr"));
  }
}

TEST_CASE("dump and asm are inverse, to the byte", "[cli]") {
  const Folder folder;
  for (const char* flags : {"", "--strip", "--no-text", "--strip --no-text"}) {
    CAPTURE(flags);
    REQUIRE(folder.run(std::string("compile two.json -o a.fbc ") + flags).code == 0);
    const std::string listing = folder.run("dump --stage file a.fbc").out;
    folder.write("a.txt", listing);
    REQUIRE(folder.run("asm a.txt -o b.fbc").code == 0);
    CHECK((folder.read("b.fbc") == folder.read("a.fbc")));
    CHECK((folder.run("asm - -o -", listing).out == folder.read("a.fbc")));
  }
}

TEST_CASE("parameters can be set of a compiled scene as of the scene itself", "[cli]") {
  const Folder folder;
  folder.write("s.json", kSettable);
  REQUIRE(folder.run("compile s.json -o s.fbc").code == 0);
  CHECK(folder.run("eval s.fbc --at 3,0,0").out.starts_with("2.5 "));
  CHECK(folder.run("eval s.fbc -D r=1 --at 3,0,0").out.starts_with("2 "));
  const Result wrong = folder.run("eval s.fbc -D r=5 --at 3,0,0");
  CHECK(wrong.code == 2);
  // A parameter set at compile time can be set again.
  REQUIRE(folder.run("compile s.json -D r=2 -o two.fbc").code == 0);
  CHECK(folder.run("dump two.fbc").out.find("sphere 2") != std::string::npos);
  const Result two = folder.run("eval two.fbc --at 3,0,0");
  CHECK(two.out.starts_with("1 "));
  CHECK(folder.run("dump --stage graph two.fbc").out.find("sphere radius=2 ") != std::string::npos);
  CHECK(two.err.empty());
  CHECK(folder.run("eval two.fbc -D r=1.5 --at 3,0,0").out.starts_with("1.5 "));
  CHECK(folder.run_script("$fathom dump --stage file two.fbc | $fathom asm - -o - | cmp - two.fbc").code == 0);
  REQUIRE(folder.run("compile two.fbc -o again.fbc").code == 0);
  CHECK(folder.read("again.fbc") == folder.read("two.fbc"));
  // Without the source text no parameter can be set, and the message says so.
  REQUIRE(folder.run("compile s.json --no-text -o bare.fbc").code == 0);
  const Result bare = folder.run("eval bare.fbc -D r=1 --at 3,0,0");
  CHECK(bare.code == 2);
  CHECK_THAT(bare.err, Contains("its parameters are numbers in the programs by now"));
  CHECK(folder.run("eval bare.fbc --at 3,0,0").out.starts_with("2.5 "));
}

TEST_CASE("every verb takes a compiled scene", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile two.json -o two.fbc").code == 0);
  REQUIRE(folder.run("compile two.json --no-text -o bare.fbc").code == 0);
  CHECK(folder.run("check two.fbc").code == 0);
  std::string proved = folder.run("dump two.json").out;
  const std::size_t word = proved.find("(proved)");
  REQUIRE(word != std::string::npos);
  CHECK(folder.run("dump two.fbc").out == proved.replace(word, 8, "(claimed)"));
  CHECK(folder.run("dump --stage graph two.fbc").code == 0);
  CHECK(folder.run("eval two.fbc --at 0,0,0").out == folder.run("eval two.json --at 0,0,0").out);
  CHECK(folder.run("slice two.fbc -o slice.png").code == 0);
  CHECK(folder.run("emit cpp two.fbc -o two.h").code == 0);
  CHECK(folder.run("render - -o out.png -r 16 -s 1 -q", folder.read("two.fbc")).code == 0);
  // Programs alone suffice for verbs that need no graph.
  CHECK(folder.run("dump bare.fbc").code == 0);
  CHECK(folder.run("render bare.fbc -o out.png -r 16 -s 1 -q").code == 0);
  for (const char* verb : {"check bare.fbc", "dump --stage graph bare.fbc", "dump --after fold bare.fbc"}) {
    const Result refused = folder.run(verb);
    CAPTURE(verb);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Contains("without the scene they were compiled from"));
  }
}

TEST_CASE("import gives back the text that a compiled scene carries", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile two.json -o two.fbc").code == 0);
  CHECK(folder.run("import two.fbc").out == kTwo);
  REQUIRE(folder.run("compile two.json --no-text -o bare.fbc").code == 0);
  CHECK(folder.run("import bare.fbc").code == 2);
}

TEST_CASE("a compiled scene's picture lies beside it under the name that the scene has", "[cli]") {
  const Folder folder;
  folder.run_script("mkdir a b && cp " FATHOM_SOURCE_DIR "/tests/data/one-pixel.hdr a/sky.hdr && cp a/sky.hdr b/");
  const auto scene = [](const std::string& file) {
    return R"({"version": 1, "film": {"width": 8, "height": 8}, "background": {"type": "image", "file": ")" + file +
           R"("}, "objects": [{"type": "sphere", "radius": 1}]})";
  };
  folder.write("a/near.json", scene("sky.hdr"));
  folder.write("a/far.json", scene((folder.path() / "a/sky.hdr").string()));
  for (const char* name : {"near", "far"}) {
    CAPTURE(name);
    const std::string json = name + std::string(".json"), fbc = name + std::string(".fbc");
    const auto run = [&](const std::string& arguments, const std::string& in = "") {
      const Result result = folder.run(arguments, in);
      CAPTURE(arguments, result.err);
      CHECK(result.code == 0);
      CHECK(result.err.find("proved") == std::string::npos);
      return result.out;
    };
    run("compile a/" + json + " -o a/" + fbc);
    const std::string compiled = folder.read("a/" + fbc);
    CHECK(folder.run_script("cd a; $fathom compile " + json + " -o same.fbc").code == 0);
    CHECK((folder.read("a/same.fbc") == compiled));
    run("compile " + (folder.path() / "a" / json).string() + " -o same.fbc");
    CHECK((folder.read("same.fbc") == compiled));
    folder.write("b/" + fbc, compiled);
    run("render a/" + json + " -q -s 1 -o one.exr");
    run("render b/" + fbc + " -q -s 1 -o two.exr");
    CHECK((folder.read("one.exr") == folder.read("two.exr")));
    CHECK((run("asm - -o -", run("dump --stage file b/" + fbc)) == compiled));
  }
}

TEST_CASE("facts of a compiled scene are claims until its text proves them", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile ball.json -o ball.fbc").code == 0);
  REQUIRE(folder.run("compile ball.json --no-text -o bare.fbc").code == 0);
  for (const char* name : {"ball.fbc", "bare.fbc"}) {
    CHECK_THAT(folder.run(std::string("dump ") + name).out, Contains("Lipschitz <= 1 (claimed)"));
    CHECK_THAT(folder.run(std::string("render -v -s 1 -o out.png ") + name).err,
               Contains("Lipschitz <= 1 (claimed)"));
  }
  CHECK_THAT(folder.run("check ball.fbc").out, Contains("Lipschitz <= 1 (proved)"));
  CHECK(folder.run("check bare.fbc").code == 2);
}

// An `emissive` ball is an area light, which the renderer samples by its place in the tables.
TEST_CASE("a compiled scene has its identity, its lights and its shutter", "[cli]") {
  const Folder folder;
  folder.write("lit.json",
               R"({"version": 1, "film": {"width": 16, "height": 12}, "render": {"spp": 4, "sample_clamp": 3},
      "params": {"time": {"default": 0}}, "camera": {"position": [0, 1, 4], "shutter": 0.5},
      "materials": {"lamp": {"type": "emissive", "emission": [9, 9, 9]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
                  {"type": "sphere", "radius": 0.4, "translate": ["time", 2, 0], "material": "lamp"}]})");
  REQUIRE(folder.run("compile lit.json -o lit.fbc").code == 0);
  REQUIRE(folder.run("render lit.json -o a.film -q").code == 0);
  REQUIRE(folder.run("render lit.fbc -o b.film -q").code == 0);
  CHECK(folder.read("a.film") == folder.read("b.film"));
}

TEST_CASE("what a compiled scene asks for is limited as what a scene asks for", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile two.json --no-text -o bare.fbc").code == 0);
  CHECK(folder.run("eval bare.fbc --at 0,0,0").code == 0);
  for (const char* limit : {"instructions=1", "stack=1", "image-side=9", "pixels=99"}) {
    const Result refused = folder.run(std::string("render -q bare.fbc -s 1 -o no.png --limit ") + limit);
    INFO(limit << ": " << refused.err);
    CHECK(refused.code == 65);
    CHECK_THAT(refused.err, Contains("`bare.fbc`: ") && Contains("`--limit "));
    CHECK_FALSE(folder.has("no.png"));
  }
  const Result json = folder.run("eval bare.fbc --at 0,0,0 --error-format json --limit instructions=1");
  CHECK_THAT(json.err, Contains("\"code\":\"E0701\"") && Contains("\"file\":\"bare.fbc\""));
  CHECK_THAT(folder.run("eval bare.fbc --at 0,0,0 --error-format short --limit stack=1").err,
             Contains("bare.fbc: error: program `surface`: the program needs a stack of"));
  folder.write("two.fasm", folder.run("dump two.json --stage file").out);
  const Result refused = folder.run("asm two.fasm -o no.fbc --limit instructions=1");
  CHECK(refused.code == 65);
  CHECK_THAT(refused.err,
             Contains("`two.fasm`: program `distance`: the program has ") && Contains("`--limit instructions="));
  CHECK_FALSE(folder.has("no.fbc"));
}

TEST_CASE("a damaged file is refused with its name, and nothing is written", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile ball.json -o ball.fbc").code == 0);
  std::string bytes = folder.read("ball.fbc");
  bytes[bytes.size() / 2] ^= 1;
  folder.write("bad.fbc", bytes);
  for (const char* verb :
       {"render bad.fbc -o out.png", "check bad.fbc", "dump bad.fbc", "compile bad.fbc -o out.fbc"}) {
    const Result refused = folder.run(verb);
    CAPTURE(verb, refused.err);
    CHECK(refused.code == 65);
    CHECK_THAT(refused.err, Contains("`bad.fbc`: the section `"));
  }
  const std::string whole = folder.read("ball.fbc");
  for (const std::string& broken : {whole.substr(0, 5), whole.substr(0, 4) + "\n" + whole.substr(6)}) {
    folder.write("bad.fbc", broken);
    const Result refused = folder.run("check bad.fbc");
    CHECK(refused.code == 65);
    CHECK_THAT(refused.err, Contains("one that was changed as if it were text, or cut off"));
  }
  CHECK_FALSE(folder.has("out.png"));
}

TEST_CASE("programs that the text in their file does not make run, and check refuses them", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile ball.json -o ball.fbc").code == 0);
  std::string listing = folder.run("dump --stage file ball.fbc").out;
  const std::string radius = " sphere 0.5 ";
  for (std::size_t at = 0; (at = listing.find(radius, at)) != listing.npos;) {
    listing.replace(at, radius.size(), " sphere 0.25 ");
  }
  REQUIRE(folder.run("asm - -o other.fbc", listing).code == 0);
  CHECK(folder.run("eval other.fbc --at 3,0,0").out.starts_with("2.75 "));
  CHECK_THAT(folder.run("dump other.fbc").out, Contains("(claimed)"));
  const Result refused = folder.run("check other.fbc");
  CHECK(refused.code == 1);
  CHECK_THAT(refused.err, Contains("`other.fbc`: its programs are not those of the scene in it") &&
                              Contains("`fathom compile` makes it anew"));
  // `compile` rebuilds the programs from the text.
  REQUIRE(folder.run("compile other.fbc -o again.fbc").code == 0);
  CHECK(folder.read("again.fbc") == folder.read("ball.fbc"));
}

TEST_CASE("what is wrong with a whole file is said in the format that was asked for", "[cli]") {
  const Folder folder;
  folder.write("two.fasm", "sphere 1\nsphere 2\nmin\n");
  REQUIRE(folder.run("asm two.fasm -o two.fbc").code == 0);
  for (const auto& [arguments, name] : {std::pair{"asm two.fasm -o out.fbc", "two.fasm"},
                                        {"eval two.fbc --at 0,0,0", "two.fbc"},
                                        {"eval - --at 0,0,0", "<stdin>"}}) {
    const Result result =
        folder.run(std::string(arguments) + " --error-format json --limit instructions=2", folder.read("two.fbc"));
    INFO(arguments << result.err);
    CHECK_THAT(result.err, Contains("\"code\":\"E0701\"") && Contains("\"file\":\"" + std::string(name)) &&
                               Contains("program `distance`: ") && Contains("--limit instructions=3"));
  }
  CHECK_FALSE(folder.has("out.fbc"));
}

TEST_CASE("compile and asm say what is missing or wrong", "[cli]") {
  const Folder folder;
  CHECK_THAT(folder.run("compile ball.json").err, Contains("-o FILE is missing"));
  CHECK(folder.run("compile ball.json").code == 2);
  CHECK(folder.run("compile ball.json -o ball.json").code == 2);
  CHECK(folder.run("compile ball.json -o ball.json/ball.fbc").code == 74);
  CHECK(folder.run("compile none.json -o ball.fbc").code == 74);
  folder.write("bad.txt", "sphere 1\nspher 2\n");
  const Result refused = folder.run("asm bad.txt -o bad.fbc");
  CHECK(refused.code == 65);
  CHECK_THAT(refused.err, Contains("bad.txt:2:1") && Contains("did you mean `sphere`?"));
  CHECK_FALSE(folder.has("bad.fbc"));
  REQUIRE(folder.run("asm - -o ball.fbc", "sphere 1\n").code == 0);
  CHECK(folder.run("eval ball.fbc --at 0,0,3").out.starts_with("2 "));
}

TEST_CASE("asm: what is no listing is named", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile ball.json -o ball.fbc").code == 0);
  folder.write("ball.fathom", "fathom 1\nobject sphere(1)\n");
  const auto error = [&](const std::string& arguments, const std::string& in = "") {
    const Result result = folder.run("asm -o a.fbc " + arguments, in);
    CHECK(result.code == 65);
    return result.err;
  };
  CHECK_THAT(error("ball.fbc"), Contains("it is a compiled scene, not a listing") && Contains("dump --stage file"));
  CHECK_THAT(error("ball.json"), Contains("it is a scene, not a listing") && Contains("fathom compile ball.json"));
  CHECK_THAT(error("ball.fathom"), Contains("it is a scene, not a listing"));
  CHECK_THAT(error("-", "sphere 1 2\n"), Contains("`sphere` takes 1 number (") && Contains("not 2"));
  CHECK_THAT(error("-", "x\ntee 2\n"), Contains("`locals 3` is missing before its instructions"));
}

}  // namespace fathom::test::cli_compile_test
