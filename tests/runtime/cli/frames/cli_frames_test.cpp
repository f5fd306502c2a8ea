// End-to-end tests of frame sequences: file names, resuming, refusals.
#include <string>

#include "runtime/film/film_file.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/scaled_cases.h"

namespace fathom::cli_frames_test {
namespace {

using namespace fathom::test;
using Catch::Contains;

// A ball that moves to the right, under a static camera.
const char* const kHop = R"(fathom 1
param time(doc = "seconds") = 0
film (width = 24, height = 16, frames = 3, fps = 12)
render (spp = 2)
camera (position = [0, 0, 4])
background (bottom = [0.2, 0.2, 0.2], top = [1, 1, 1])
object sphere(0.5).translate([time, 0, 0])
)";
const char* const kHopJson = R"({
  "version": 1,
  "params": {"time": 0},
  "film": {"width": 24, "height": 16, "frames": 3, "fps": 12},
  "render": {"spp": 2},
  "camera": {"position": [0, 0, 4]},
  "background": {"bottom": [0.2, 0.2, 0.2], "top": [1, 1, 1]},
  "objects": [{"type": "sphere", "radius": 0.5, "translate": ["time", 0, 0]}]
})";

class Frames : public Folder {
 public:
  Frames() {
    write("hop.fathom", kHop);
    write("hop.json", kHopJson);
  }
};

TEST_CASE("cli frames: a frame is the still of its time, in either notation, and frame 0 that of the seed itself",
          "[cli]") {
  const Frames folder;
  const Result result = folder.run("render hop.fathom --frames 0:3 -o out.png");
  INFO(result.err);
  REQUIRE(result.code == 0);
  REQUIRE(folder.run("render hop.fathom -o still.png -q").code == 0);
  CHECK(folder.read("out-0000.png") == folder.read("still.png"));
  REQUIRE(folder.run("render hop.json --frames 2 --fixed-noise -o json.png -q").code == 0);
  REQUIRE(folder.run("render hop.json -D time=1/6 -o at.png -q").code == 0);
  CHECK(folder.read("json-0002.png") == folder.read("at.png"));
  // The noise changes from frame to frame, except with --fixed-noise. The film stores the frame's seed.
  CHECK(folder.read("out-0002.png") != folder.read("json-0002.png"));
  REQUIRE(folder.run("render hop.json --frames 2 -o film.film -q").code == 0);
  const auto film = runtime::read_film((folder.path() / "film-0002.film").string());
  REQUIRE(std::holds_alternative<runtime::FilmFile>(film));
  std::string seed;
  for (const auto& [name, value] : std::get<runtime::FilmFile>(film).header.identity) {
    if (name == "seed") seed = value;
  }
  REQUIRE(folder.run("render hop.json -D time=1/6 -o seeded.png -q --seed " + seed).code == 0);
  CHECK(folder.read("seeded.png") == folder.read("out-0002.png"));
}

TEST_CASE("cli frames: a line for each frame says which of how many, and one closes", "[cli]") {
  const Frames folder;
  const Result result = folder.run("render hop.fathom --frames 4:10:3 -o a.png");
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("frame 4, 1 of 2: drew hop.fathom: 24x16 pixels, 2 samples per pixel") &&
                             Contains("frame 7, 2 of 2: ") && Contains("wrote a-0007.png (24x16)\n") &&
                             Contains("\n2 frames of hop.fathom: 2 rendered in "));
  CHECK(folder.run("render hop.fathom --frames 4 -o a.png -q").err.empty());
}

TEST_CASE("cli frames: which there are", "[cli]") {
  const Frames folder;
  struct Case {
    const char *frames, *files;
  };
  for (const Case& each : {Case{"all", "0000 0001 0002 "},
                           {"7", "0007 "},
                           {"1:4:2", "0001 0003 "},
                           {"1:5:2", "0001 0003 "},
                           {"9999:10001", "9999 10000 "}}) {
    const Result result =
        folder.run("render hop.fathom -q --size 2x2 --frames " + std::string(each.frames) + " -o x.png");
    INFO(each.frames << result.err);
    CHECK(result.code == 0);
    const Result files =
        folder.run_script("for f in $(ls x-*.png | sort -V); do f=${f#x-}; printf '%s ' ${f%.png}; done; rm x*");
    CHECK(files.out == each.files);
  }
  for (const char* wrong :
       {"3:3", "4:2", "a", "1:2:3:4", "1:2:0", "-1:2", "1:", ":2", "1.5", "''", "all:2", "0:999999999"}) {
    const Result result = folder.run("render hop.fathom -o x.png --frames=" + std::string(wrong));
    INFO(wrong << result.err);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains("--frames"));
  }
}

TEST_CASE("cli frames: files are named by number, in the place of #, before the ending, or in a folder", "[cli]") {
  const Frames folder;
  std::filesystem::create_directory(folder.path() / "dir.d");
  const Result result = folder.run(
      "render hop.fathom -q --size 2x2 --frames 12 -a -d -n --denoise -o 'shot.##.exr' -o ./b.png -o c#.pfm -o "
      "dir.d/ "
      "--format jpg --cost-map cost.png --stats-json stats.json");
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(folder.run_script("ls -p && ls dir.d").out ==
        "b-0012-albedo.png\nb-0012-depth.png\nb-0012-noisy.png\nb-0012-normal.png\nb-0012.png\nball.json\n"
        "c12-albedo.pfm\nc12-depth.pfm\nc12-noisy.pfm\nc12-normal.pfm\nc12.pfm\n"
        "cost-0012-evaluations.png\ncost-0012-instructions.png\ndir.d/\nhop.fathom\nhop.json\nshot.12.exr\n"
        "shot.frames\nstats-0012.json\ntwo.json\n0012-albedo.jpg\n0012-depth.jpg\n0012-noisy.jpg\n0012-normal.jpg\n"
        "0012.jpg\n");
  // Without -o the images are named after the scene. An existing folder is recognised as the output folder.
  REQUIRE(folder.run("render hop.fathom --frames 1 --size 2x2").code == 0);
  CHECK(folder.has("hop-0001.png"));
  REQUIRE(folder.run("render hop.fathom --frames 1 --size 2x2 -o dir.d -q").code == 0);
  CHECK(folder.has("dir.d/0001.png"));
  CHECK(folder.has("dir.d/out.frames"));
}

TEST_CASE("cli frames: fps, of the scene or the command line, makes time of frames", "[cli]") {
  const Frames folder;
  REQUIRE(folder.run("render hop.json -D time=0.1 -o at.png -q").code == 0);
  for (const char* fps : {"30", "30.0", "60/2", "3e1"}) {
    REQUIRE(folder.run("render hop.json --frames 3 --fixed-noise -o a.png -q --fps " + std::string(fps)).code == 0);
    CHECK(folder.read("a-0003.png") == folder.read("at.png"));
  }
  for (const char* wrong : {"0", "-1", "x", "1/0", "1e9", "24/"}) {
    CHECK(folder.run("render hop.json --frames 3 -o a.png --fps=" + std::string(wrong)).code == 2);
  }
}

TEST_CASE("cli frames: `frame` is a whole number, and may stand beside `time`", "[cli]") {
  const Frames folder;
  folder.write("both.fathom", R"(fathom 1
param frame = 0
param time = 0
film (width = 24, height = 16, fps = 2)
render (spp = 1)
camera (position = [0, 0, 4])
background [1, 1, 1]
object [for i in 0..(frame + 1): sphere(0.3).translate([i - 1, time, 0])]
)");
  REQUIRE(folder.run("render both.fathom --frames 2 --fixed-noise -o a.png -q").code == 0);
  REQUIRE(folder.run("render both.fathom -D time=1 -D frame=2 -o b.png -q").code == 0);
  CHECK(folder.read("a-0002.png") == folder.read("b.png"));
}

TEST_CASE("cli frames: a scene that does not move is told how it could", "[cli]") {
  const Frames folder;
  const Result json = folder.run("render ball.json --frames 0:2 -o a.png");
  CHECK(json.code == 2);
  CHECK_THAT(json.err, Contains("`ball.json` has neither a parameter `time` nor `frame`") &&
                           Contains(R"("params": {"time": 0})") && Contains("`frame` a whole number"));
  folder.write("still.fathom", "fathom 1\nparam t = 0\nobject sphere(1)\n");
  CHECK_THAT(folder.run("render still.fathom --frames 0:2 -o a.png").err, Contains("param time = 0"));
  folder.write("open.fathom", "fathom 1\nparam time = 0\nobject sphere(1 + time)\n");
  const Result all = folder.run("render open.fathom --frames all -o a.png");
  CHECK(all.code == 2);
  CHECK_THAT(all.err, Contains("does not say how many there are") && Contains("`frames`"));
}

TEST_CASE("cli frames: what makes no sense with them is refused, and what they alone have", "[cli]") {
  const Frames folder;
  struct Case {
    const char *arguments, *message;
  };
  for (const Case& each : {Case{"--frames 0:2 -D time=1", "-D time does not go with --frames"},
                           {"--frames 0:2 --watch", "--watch does not go with --frames"},
                           {"--frames 0:2 -o -", "does not go with --frames"},
                           {"--frames 0:2 --stats-json -", "`--stats-json -` does not go with --frames"},
                           {"--frames 0:2 -o a.png -o ./a.png", "would be overwritten"},
                           {"--frames 0:12 -o 'a#.png' -o 'a1#.png'", "a10.png` would be overwritten"},
                           {"--frames 0:2 -o a.png --bits 16 -o b.jpg", "--bits 16"},
                           {"-o ./", "`./` is a folder"},
                           {"--fixed-noise", "--fixed-noise is for --frames"},
                           {"--fps 12", "--fps is for --frames"},
                           {"--shutter-times 4", "--shutter-times: nothing is blurred"}}) {
    const Result result = folder.run("render hop.fathom --size 2x2 " + std::string(each.arguments));
    INFO(each.arguments << "\n" << result.err);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains(each.message));
  }
  CHECK(folder.run("render hop.fathom --frames 0:2 -o ball.json/a.png").code == 74);
  folder.write("a.frames", "something of mine");
  const Result foreign = folder.run("render hop.fathom --frames 0:2 -o a.png");
  CHECK(foreign.code == 65);
  CHECK_THAT(foreign.err, Contains("`a.frames` is no journal of frames"));
  CHECK(folder.read("a.frames") == "something of mine");
}

TEST_CASE("cli frames: programs without their text have no time", "[cli]") {
  const Frames folder;
  REQUIRE(folder.run("compile hop.json -o hop.fbc -q").code == 0);
  REQUIRE(folder.run("render hop.fbc --frames 1:3 -o fbc.png -q").code == 0);
  REQUIRE(folder.run("render hop.json --frames 1:3 -o json.png -q").code == 0);
  CHECK(folder.read("fbc-0002.png") == folder.read("json-0002.png"));
  REQUIRE(folder.run("compile hop.json -o bare.fbc --no-text -q").code == 0);
  const Result bare = folder.run("render bare.fbc --frames 1:3 -o bare.png");
  CHECK(bare.code == 2);
  CHECK_THAT(bare.err, Contains("programs without the scene they were compiled from"));
  REQUIRE(folder.run("render - --frames 1:3 -o in.png -q", folder.read("hop.json")).code == 0);
  CHECK(folder.read("in-0002.png") == folder.read("json-0002.png"));
}

TEST_CASE("cli frames: one that has errors ends it with 65 and its number, and check finds it before", "[cli]") {
  const Frames folder;
  folder.write("shrink.json", R"({"version": 1, "params": {"time": 0}, "film": {"width": 4, "height": 4},
    "background": [1, 1, 1], "objects": [{"type": "sphere", "radius": "1 - time"}]})");
  const Result result = folder.run("render shrink.json --fps 4 --frames 2:8 -o a.png -s 1");
  INFO(result.err);
  CHECK(result.code == 65);
  CHECK_THAT(result.err, Contains("frame 4 (1 s) of shrink.json cannot be rendered") &&
                             Contains("2 frames before it are done") && Contains("`radius` must be positive"));
  CHECK((folder.has("a-0003.png") && !folder.has("a-0004.png")));
  const Result check = folder.run("check shrink.json --fps 4 --frames 2:6");
  INFO(check.err);
  CHECK(check.code == 1);
  CHECK_THAT(check.err, Contains("frame 4 (1 s) has errors") && Contains("frame 5 (1.25 s) has errors"));
  CHECK_THAT(check.out, Contains("4 frames checked, 2 with errors"));
  const Result good = folder.run("check shrink.json --fps 4 --frames 0:4");
  CHECK(good.code == 0);
  CHECK_THAT(good.out, Contains("4 frames checked, 0 with errors"));
  CHECK(folder.run("check shrink.json --frames 0:4 --probe 10").code == 2);
  CHECK(folder.run("check ball.json --frames 0:4").code == 2);
  // A time that the scene does not allow is a command line error.
  folder.write("short.json", R"({"version": 1, "params": {"time": {"default": 0, "max": 1}}, "background": [1, 1, 1],
    "objects": [{"type": "sphere", "radius": "1 + time"}]})");
  const Result late = folder.run("render short.json --fps 1 --frames 2 -o b.png");
  CHECK(late.code == 2);
  CHECK_THAT(late.err, Contains("`time` must be at most 1") && Contains("frame 2 (2 s)"));
}

TEST_CASE("cli frames: the same warnings are said once", "[cli]") {
  const Frames folder;
  folder.write("warned.json", R"({"version": 1, "params": {"time": 0, "idle": 1}, "film": {"width": 2, "height": 2},
    "background": [1, 1, 1], "objects": [{"type": "sphere", "radius": "1 + time"}]})");
  const std::string said = folder.run("render warned.json --frames 0:3 -o a.png -q").err;
  const std::size_t first = said.find("W0404");
  CHECK(first != std::string::npos);
  CHECK(said.find("W0404", first + 1) == std::string::npos);
}

TEST_CASE("cli frames: --resume leaves what is done and whole, and renders the rest", "[cli]") {
  const Frames folder;
  REQUIRE(folder.run("render hop.fathom --frames 0:4 -o whole.png -q").code == 0);
  REQUIRE(folder.run("render hop.fathom --frames 0:2 -o a.png -q").code == 0);
  CHECK_THAT(folder.read("a.frames"), Contains("fathom frames 1\n0 ") && Contains("\n1 "));
  const Result rest = folder.run("render hop.fathom --frames 0:4 -o a.png --resume");
  CHECK(rest.code == 0);
  CHECK_THAT(rest.err, Contains("4 frames of hop.fathom: 2 rendered in ") && Contains(", 2 there already") &&
                           !Contains("there is no checkpoint"));
  const auto resumed = [&](const std::string& arguments) {
    const Result result = folder.run("render hop.fathom -o a.png --resume --frames 0:4 " + arguments);
    INFO(arguments << result.err);
    REQUIRE(result.code == 0);
    const std::size_t at = result.err.find(" rendered in");
    REQUIRE((at != std::string::npos && at > 0));
    return result.err[at - 1] - '0';
  };
  CHECK(resumed("") == 0);
  CHECK(resumed("--threads 1 -t 3") == 0);
  // Missing or damaged files, and files made with other settings, are rendered again.
  std::filesystem::remove(folder.path() / "a-0001.png");
  folder.write("a-0002.png", "no picture");
  CHECK(resumed("") == 2);
  CHECK(resumed("--exposure 1") == 4);
  CHECK(resumed("-a") == 4);
  CHECK(resumed("--sampler independent") == 4);
  // Frame 0 has the same time at any frame rate, so one frame fewer is rendered.
  CHECK(resumed("--fps 5") == 4);
  CHECK(resumed("") == 3);
  CHECK(resumed("--fps 5") == 3);
  CHECK(resumed("") == 3);
  for (const char* number : {"0000", "0001", "0002", "0003"}) {
    CHECK(folder.read("a-" + std::string(number) + ".png") == folder.read("whole-" + std::string(number) + ".png"));
  }
  std::filesystem::remove(folder.path() / "a.frames");
  const Result none = folder.run("render hop.fathom --frames 0:2 -o a.png --resume");
  CHECK_THAT(none.err, Contains("there is no journal `a.frames`") && Contains("2 rendered"));
}

TEST_CASE("cli frames: runs of other frames may share a journal", "[cli]") {
  const Frames folder;
  const Result both = folder.run_script(
      "\"$fathom\" render hop.fathom --frames 0:4 -o a.png -q --threads 1 &\n"
      "\"$fathom\" render hop.fathom --frames 4:8 -o a.png -q --threads 1\nwait $!\necho $?");
  CHECK(both.out == "0\n");
  REQUIRE(folder.run("render hop.fathom --frames 8 -o a.png -q").code == 0);
  // A journal line can be lost when both runs write at once. Frames not in the journal are rendered again.
  REQUIRE(folder.run("render hop.fathom --frames 0:9 -o a.png --resume -q").code == 0);
  CHECK_THAT(folder.run("render hop.fathom --frames 0:9 -o a.png --resume").err, Contains(": 0 rendered"));
}

// A render whose frames take long enough to be interrupted by a signal.
std::string slow(int samples = 2000) {
  std::string text = kHop;
  const std::string spp = std::to_string(fathom::test::scaled_cases(samples));
  text.replace(text.find("spp = 2"), 7, "spp = " + spp);
  return text;
}

TEST_CASE("cli frames: a signal keeps the frame under way, and --resume goes on with it", "[cli]") {
  const Frames folder;
  // A frame of 2000 samples took 0.06 s on a fast machine: it ended before the shell saw its checkpoint.
  folder.write("slow.fathom", slow(16000));
  REQUIRE(folder.run("render slow.fathom --frames 0:3 -o whole.exr -q").code == 0);
  const Result stopped = folder.run_script(
      "\"$fathom\" render slow.fathom --frames 0:3 -o a.exr --checkpoint-interval 0.01s &\npid=$!\n"
      "while ! [ -e a-0001.exr.checkpoint ] && kill -0 $pid 2>/dev/null; do sleep 0.01; done\n"
      "kill -INT $pid\nwait $pid; echo $?");
  INFO(stopped.err);
  REQUIRE(stopped.out == "75\n");
  CHECK_THAT(stopped.err, Contains("what is done is in a-0001.exr.checkpoint; --resume goes on"));
  // Without --resume, the program refuses to overwrite the unfinished frame.
  const Result again = folder.run("render slow.fathom --frames 0:3 -o a.exr");
  CHECK(again.code == 2);
  CHECK_THAT(again.err, Contains("frame 1 was begun before") && Contains("--resume"));
  const Result rest = folder.run("render slow.fathom --frames 0:3 -o a.exr --resume");
  INFO(rest.err);
  CHECK(rest.code == 0);
  CHECK_THAT(rest.err, Contains("samples resumed") && Contains("2 rendered in") && Contains("1 there already"));
  for (const char* number : {"0000", "0001", "0002"}) {
    CHECK((folder.read("a-" + std::string(number) + ".exr") == folder.read("whole-" + std::string(number) + ".exr")));
  }
  CHECK_FALSE(folder.has("a-0001.exr.checkpoint"));
}

TEST_CASE("cli frames: kill -9 and --resume, again and again, give the files of a run that was not disturbed",
          "[cli]") {
  const Frames folder;
  folder.write("slow.fathom", slow());
  REQUIRE(folder.run("render slow.fathom --frames 0:4 -o whole.png -q").code == 0);
  const Result result = folder.run_script(
      "for s in 0.05 0.1 0.2 0.15; do\n"
      "  timeout -s KILL $s \"$fathom\" render slow.fathom --frames 0:4 -o a.png --resume -q --checkpoint-interval "
      "0.01s 2>/dev/null\n"
      "done\n\"$fathom\" render slow.fathom --frames 0:4 -o a.png --resume -q\n"
      "for i in 0 1 2 3; do cmp a-000$i.png whole-000$i.png; done; ls a*");
  CHECK(result.out == "a-0000.png\na-0001.png\na-0002.png\na-0003.png\na.frames\n");
}

TEST_CASE("cli frames: a checkpoint of another render is replaced where nobody named it", "[cli]") {
  const Frames folder;
  folder.write("slow.fathom", slow());
  folder.run_script("timeout -s INT 0.1 \"$fathom\" render slow.fathom --frames 0:3 -o a.png -q");
  const Result result = folder.run("render hop.fathom --frames 0:3 -o a.png --resume");
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("3 rendered in"));
}

TEST_CASE("cli frames: a time limit is for all of them, and what is not begun is not written", "[cli]") {
  const Frames folder;
  folder.write("slow.fathom", slow());
  const Result result = folder.run("render slow.fathom --frames 0:90 -o a.png --time-limit 0.2s");
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Contains("the time limit ended the sequence at frame") && Contains("--resume goes on"));
  CHECK_FALSE(folder.has("a-0089.png"));
}

TEST_CASE("cli frames: parts of the samples are merged frame by frame", "[cli]") {
  const Frames folder;
  REQUIRE(folder.run("render hop.fathom -s 8 --frames 1:3 -o whole.exr -q").code == 0);
  REQUIRE(folder.run("render hop.fathom -s 8 --frames 1:3 --sample-range 0:3 -o a.film -q").code == 0);
  REQUIRE(folder.run("render hop.fathom -s 8 --frames 1:3 --sample-range 3:8 -o b.film -q").code == 0);
  REQUIRE(folder.run("merge a-0002.film b-0002.film -o sum.exr -q").code == 0);
  CHECK((folder.read("sum.exr") == folder.read("whole-0002.exr")));
  CHECK(folder.run("merge a-0001.film b-0002.film -o sum.exr -q").code == 65);
}

// Balls within each other's boxes are one piece, which has regions.
TEST_CASE("cli frames: regions are built once while the programs stay the same", "[cli]") {
  const Frames folder;
  folder.write("many.fathom", R"(fathom 1
param time = 0
film (width = 96, height = 72, fps = 8)
render (spp = 16)
camera (position = [12*cos(time) + 3, 6, 12*sin(time) + 3], target = [3, 3, 3])
background [1, 1, 1]
object [for i in 0..729: sphere(1).translate([mod(i, 9), mod(floor(i/9), 9), floor(i/81)])]
)");
  const Result turntable = folder.run("render many.fathom --frames 0:4 -o a.png --stats-json stats.json");
  INFO(turntable.err);
  REQUIRE(turntable.code == 0);
  CHECK_THAT(turntable.err, Contains("regions built 1 time and kept 3 times"));
  CHECK_THAT(folder.read("stats-0000.json"), Contains("\"regions_reused\": 0,"));
  CHECK_THAT(folder.read("stats-0003.json"),
             Contains("\"regions_reused\": 1,") && Contains("\"region_seconds\": 0,"));
  REQUIRE(folder.run("render many.fathom --frames 3 -o alone.png -q").code == 0);
  CHECK(folder.read("alone-0003.png") == folder.read("a-0003.png"));
}

}  // namespace
}  // namespace fathom::cli_frames_test
