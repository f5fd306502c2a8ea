// File and message handling of every verb: a full disk, names with control characters, out of memory, and signals at
// bad moments.
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/not_run.h"
#include "tests/support/program.h"

namespace fathom::cli_files_test {

namespace {

using namespace fathom::test;
using Catch::Contains;

const std::string kOld = "what was there before";

// Returns a script that prints the program's messages and exit status while files cannot grow.
std::string on_full_disk(const std::string& arguments) {
  return "( ulimit -f 0; \"$fathom\" " + arguments + "; echo \"status $?\" ) 2>&1 | cat\n";
}

// Regression: `emit` and `import` truncated the old file before writing.
TEST_CASE("cli files: on a full disk every verb leaves what was there", "[cli]") {
  const Folder folder;
  folder.write("model.vm", "a var-x\nb square a\nc const 1\nd sub b c\n");
  REQUIRE(folder.run("dump ball.json --stage file").code == 0);
  folder.write("ball.fasm", folder.run("dump ball.json --stage file").out);
  REQUIRE(folder.run("render ball.json -q -o a.exr -o c.exr -o a.film").code == 0);
  const std::pair<std::string, std::string> writers[] = {
      {"out.h", "emit cpp ball.json -o out.h"},
      {"out.glsl", "emit glsl ball.json -o out.glsl"},
      {"out.json", "import model.vm -o out.json"},
      {"out.fbc", "compile ball.json -o out.fbc"},
      {"out.fbc", "compile ball.json --no-text -o out.fbc"},
      {"out.fbc", "asm ball.fasm -o out.fbc"},
      {"out.png", "render ball.json -o out.png"},
      {"out.film", "render ball.json -o out.film"},
      {"out.jpg", "render ball.json -o out.jpg"},
      {"out.bmp", "render ball.json -o out.bmp"},
      {"out.hdr", "render ball.json -o out.hdr"},
      {"out.pfm", "render ball.json -o out.pfm"},
      {"out.exr", "render ball.json -o out.exr"},
      {"out.stats", "render ball.json -o b.pfm --stats-json out.stats"},
      {"out-evaluations.png", "render ball.json -o b.pfm --cost-map out.png"},
      {"out/index.html", "chart ball.json -o out --rays 100 --rounds 1 --no-images"},
      {"out.png", "slice ball.json -o out.png"},
      {"out.png", "tonemap a.exr -o out.png"},
      {"out.exr", "merge a.film -o out.exr"},
      {"out.png", "diff a.exr c.exr -o out.png"},
  };
  std::filesystem::create_directory(folder.path() / "out");
  for (const auto& [file, arguments] : writers) {
    folder.write(file, kOld);
    const Result result = folder.run_script(on_full_disk(arguments));
    INFO(arguments << "\n" << result.out);
    CHECK_THAT(result.out, Contains("status 74"));
    CHECK(folder.read(file) == kOld);
    REQUIRE(folder.run(arguments).code == 0);
    CHECK(folder.read(file) != kOld);
    std::filesystem::remove(folder.path() / file);
  }
  CHECK(folder.run("emit cpp ball.json -o /dev/full").code == 74);
  CHECK(folder.run("import model.vm -o /dev/full").code == 74);
}

// U+009B starts a terminal command, as ESC [ does.
TEST_CASE("cli files: names of scenes are escaped on standard output", "[cli]") {
  const Folder folder;
  folder.write("names.json",
               "{\"version\": 1, \"params\": {\"r\": {\"default\": 1, \"doc\": \"a\u009b31m\"}},\n"
               "\"objects\": [{\"type\": \"sphere\", \"radius\": \"r\", \"name\": \"ball\u009b31m\"}]}");
  for (const char* arguments :
       {"check names.json", "check --error-format json names.json", "check --probe 10 names.json",
        "eval names.json --at 0,0,0", "eval names.json --at 0,0,0 --number f32", "dump names.json",
        "dump names.json --stage file", "dump names.json --stage syntax", "dump names.json --stage graph",
        "dump names.json --stage graph --format json", "dump names.json --stage graph --format dot",
        "dump names.json --stage graph --format mermaid", "dump names.json --diff"}) {
    const Result result = folder.run(arguments);
    INFO(arguments << "\n" << result.err);
    CHECK(result.code == 0);
    CHECK(result.out.find("\xc2\x9b") == std::string::npos);
    CHECK(result.err.find("\xc2\x9b") == std::string::npos);
  }
  CHECK_THAT(folder.run("check names.json").out, Contains("ball\\u009b31m"));
  CHECK_THAT(folder.run("eval names.json --at 0,0,0").out, Contains("ball\\u009b31m"));
  const std::string json = folder.run("check --error-format json names.json").out;
  CHECK(nlohmann::json::parse(json.substr(0, json.find('\n')))["object"] == "ball\u009b31m");
}

TEST_CASE("cli files: diff counts the memory of comparing before it takes it", "[cli]") {
  const Folder folder;
  folder.write("a.pfm", "PF\n2 1\n-1.0\n" + std::string(24, '\0'));
  CHECK(folder.run("diff a.pfm a.pfm --limit memory=160").code == 0);
  const Result refused = folder.run("diff a.pfm a.pfm --limit memory=159");
  CHECK(refused.code == 65);
  CHECK_THAT(refused.err, Contains("159 are allowed") && Contains("--limit memory="));
}

TEST_CASE("cli files: refusals have the form that was asked for", "[cli]") {
  const Folder folder;
  folder.write("sky.json", R"({"version": 1, "background": {"type": "image", "file": "sky.hdr"},
    "objects": [{"type": "sphere", "radius": 1}]})");
  folder.write("sky.hdr", "no picture");
  for (const char* arguments : {"check ball.json --limit file-size=10", "render sky.json -o a.png",
                                "check nothing.json", "render ball.json -o a.png --limit memory=1000"}) {
    const Result result = folder.run(std::string(arguments) + " --error-format json");
    INFO(arguments << "\n" << result.err);
    CHECK(result.code != 0);
    std::istringstream lines(result.err);
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count)
      CHECK(nlohmann::json::parse(line)["severity"] == "error");
    CHECK(count == 1);
  }
}

TEST_CASE("cli files: what is wrong in a compiled scene is said of its file", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("compile two.json -o two.fbc").code == 0);
  CHECK_THAT(folder.run("check two.fbc --limit nodes=1").err, Contains("two.fbc (two.json):"));
  CHECK_THAT(folder.run("compile two.fbc -o new.fbc --limit nodes=1").err, Contains("two.fbc (two.json):"));
  REQUIRE(folder.run("compile two.json -o bare.fbc --no-text").code == 0);
  CHECK(folder.run("check bare.fbc").code == 2);
  CHECK(folder.run("import bare.fbc").code == 2);
  CHECK(folder.run("compile bare.fbc -o new.fbc").code == 2);
}

TEST_CASE("cli files: a compiled scene gets no name of something else", "[cli]") {
  const Folder folder;
  for (const char* name : {"g.png", "g.EXR", "g.film", "g.json", "g.stl", "g.glb"}) {
    const Result result = folder.run(std::string("compile ball.json -o ") + name);
    INFO(name << result.err);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains(".fbc"));
    CHECK_FALSE(folder.has(name));
  }
  for (const char* name : {"g", "g.fbc", "g.bin"})
    CHECK(folder.run(std::string("compile ball.json -o ") + name).code == 0);
  CHECK(folder.run("asm - -o g.png", "sphere 1\n").code == 2);
}

TEST_CASE("cli files: every verb knows -q", "[cli]") {
  const Folder folder;
  folder.write("model.vm", "a var-x\nb square a\nc const 1\nd sub b c\n");
  for (const char* name : {"a.pfm", "c.pfm"}) folder.write(name, "PF\n1 1\n-1.0\n" + std::string(12, '\0'));
  for (const char* arguments :
       {"check ball.json", "dump ball.json", "compile ball.json -o a.fbc", "eval ball.json --at 0,0,0",
        "slice ball.json -o b.png --size 8x8", "tonemap a.pfm -o b.png", "diff a.pfm c.pfm -o b.png",
        "emit cpp ball.json -o b.h", "import model.vm -o b.json", "schema", "render ball.json -o b.png -o b.film",
        "merge b.film -o c.png", "chart ball.json -o charts --rays 100 --rounds 1 --no-images", "man",
        "completion bash"}) {
    const Result result = folder.run(std::string(arguments) + " -q");
    INFO(arguments << result.err);
    CHECK(result.code == 0);
    CHECK(result.err.empty());
  }
  CHECK(folder.run("asm - -o b.fbc --quiet", "sphere 1\n").err.empty());
  CHECK(folder.run("check -q ball.json").out.empty());
  for (const char* verb : {"check ball.json", "emit cpp ball.json", "eval ball.json --at 0,0,0"}) {
    CHECK_THAT(folder.run(std::string(verb) + " -v").err, Contains("compiled in"));
    CHECK_THAT(folder.run(std::string(verb) + " -vv").err, Contains("after graph"));
  }
  CHECK(folder.run("help help").out == folder.run("--help").out);
}

// The scene comes through a FIFO. Once the FIFO has a reader, the program has started and still waits for the scene.
std::string interrupted_while_reading(const std::string& options) {
  return "mkfifo pipe\n\"$fathom\" render pipe -q -o a.png " + options +
         " &\npid=$!\nexec 3>pipe\nkill -TERM $pid\ncat ball.json >&3\nexec 3>&-\nwait $pid; echo $?\nrm pipe\n";
}

TEST_CASE("cli files: a signal while the scene is read leaves the checkpoint that was asked for", "[cli]") {
  const Folder folder;
  const Result kept = folder.run_script("trap '' PIPE\n" + interrupted_while_reading("--checkpoint a.film"));
  INFO(kept.err);
  CHECK(kept.out == "75\n");
  CHECK(folder.has("a.film"));
  REQUIRE(folder.run("render ball.json -q -o a.png --checkpoint a.film --resume").code == 0);
  REQUIRE(folder.run("render ball.json -q -o b.png").code == 0);
  CHECK((folder.read("a.png") == folder.read("b.png")));
  // Without a checkpoint nothing is kept, and the signal ends the program at once.
  const Result killed = folder.run_script("trap '' PIPE\n" + interrupted_while_reading(""));
  CHECK_THAT(killed.out, Contains("143\n"));
}

// Regression: "terminate called after throwing an instance of 'std::bad_alloc'", and a signal.
TEST_CASE("cli files: memory that ends in a thread is an error with a message", "[cli]") {
  if (is_sanitized()) return test::not_run("AddressSanitizer reserves more address space than the limit");
  const Folder folder;
  int ended = 0;
  for (int megabytes = 40; megabytes <= 240; megabytes += 50) {
    const Result result =
        folder.run_script("ulimit -v " + std::to_string(megabytes * 1024) +
                          "\n\"$fathom\" render ball.json -s 1 --size 640x480 --threads 24 -q -o a.png\n");
    INFO(megabytes << " MiB: " << result.code << "\n" << result.err);
    CHECK(result.err.find("terminate") == std::string::npos);
    if (result.code == 0 || result.code == 127) continue;  // enough memory, or too little even for the loader
    CHECK((result.code == 70 || result.code == 74));
    CHECK_THAT(result.err, Contains("error: "));
    ++ended;
  }
  CHECK(ended > 0);
}

}  // namespace

}  // namespace fathom::cli_files_test
