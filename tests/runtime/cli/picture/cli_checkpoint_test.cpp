// End-to-end tests of interrupted renders: signals, kill -9, full disks, checkpoints of other renders.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/scaled_cases.h"

namespace fathom::cli_checkpoint_test {

namespace {

using namespace fathom::test;
using Catch::Contains;

// Long enough to be interrupted: a second on a fast machine.
const std::string kSpp = fathom::test::few_cases() ? "400" : "1600";
const std::string kSlow = R"({
  "version": 1,
  "params": {"r": 0.5},
  "camera": {"position": [0, 1, 4], "target": [0, 0.3, 0]},
  "film": {"width": 48, "height": 32},
  "render": {"spp": )" + kSpp +
                          R"(},
  "materials": {"lamp": {"type": "emissive", "emission": [8, 8, 8]}, "glass": {"type": "transparent"}},
  "objects": [{"type": "plane", "normal": [0, 1, 0]},
              {"type": "sphere", "radius": "r", "translate": [0, 0.5, 0], "material": "glass"},
              {"type": "sphere", "radius": 0.4, "translate": [1, 2, 1], "material": "lamp"}]
})";

// Waits until the file exists or $pid has ended.
std::string until(const std::string& file) {
  return "while ! [ -e " + file + " ] && kill -0 $pid 2>/dev/null; do sleep 0.02; done\n";
}

// Starts a render, sends `signal` once the checkpoint exists, and prints the exit status.
std::string interrupted(const std::string& arguments, const std::string& signal, const std::string& checkpoint) {
  return "\"$fathom\" render " + arguments + " -q --checkpoint-interval 0.01s &\npid=$!\n" + until(checkpoint) +
         "kill -" + signal + " $pid\nwait $pid; echo $?\n";
}

// Waits until the file is not empty, for at most a minute.
std::string until_said(const std::string& file) {
  return "n=0; while ! [ -s " + file + " ] && [ $n -lt 3000 ]; do sleep 0.02; n=$((n+1)); done\n";
}

class SlowFolder : public Folder {
 public:
  SlowFolder() { write("slow.json", kSlow); }
};

TEST_CASE("cli checkpoint: signals end it with 75, the picture so far and a checkpoint to go on from", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -o whole.exr -q").code == 0);
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    const Result stopped = folder.run_script(interrupted("slow.json -o a.exr", signal, "a.exr.checkpoint"));
    INFO(signal << stopped.err);
    REQUIRE(stopped.out == "75\n");
    CHECK_THAT(stopped.err, Contains("--resume goes on"));
    CHECK(folder.has("a.exr"));
    REQUIRE(folder.has("a.exr.checkpoint"));
    CHECK((folder.read("a.exr") != folder.read("whole.exr")));
    REQUIRE(folder.run("render slow.json -o a.exr -q --resume --threads 1 -t 9").code == 0);
    CHECK((folder.read("a.exr") == folder.read("whole.exr")));
    CHECK_FALSE(folder.has("a.exr.checkpoint"));
  }
}

TEST_CASE("cli checkpoint: SIGUSR1 writes the picture so far, and the render goes on", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -o whole.png -q").code == 0);
  const Result result = folder.run_script(
      "\"$fathom\" render slow.json -o a.png -q --checkpoint-interval 0.01s &\npid=$!\n"
      "while ! [ -e a.png.checkpoint ]; do sleep 0.02; done\nkill -USR1 $pid\n"
      "while ! [ -e a.png ]; do sleep 0.02; done\nwait $pid; echo $?");
  CHECK(result.out == "0\n");
  CHECK_THAT(result.err, Contains("so far"));
  CHECK(folder.read("a.png") == folder.read("whole.png"));
}

TEST_CASE("cli checkpoint: kill -9 and resume give the bits of a render that was not disturbed", "[cli]") {
  const SlowFolder folder;
  for (const std::string way : {"", " --noise-threshold 0 --denoise"}) {
    const std::string render = "slow.json --checkpoint now.film -o a.exr" + way;
    std::filesystem::remove(folder.path() / "now.film");
    REQUIRE(folder.run("render slow.json -o whole.exr -q" + way).code == 0);
    const Result killed = folder.run_script(interrupted(render, "KILL", "now.film"));
    REQUIRE(killed.out == "137\n");
    // Kills the render once more, before or after its first checkpoint.
    folder.run_script("timeout -s KILL 0.2 \"$fathom\" render " + render +
                      " --resume -q --checkpoint-interval 0.01s");
    const Result resumed = folder.run("render " + render + " --resume");
    CHECK(resumed.code == 0);
    CHECK_THAT(resumed.err, Contains("samples resumed"));
    CHECK((folder.read("a.exr") == folder.read("whole.exr")));
  }
}

TEST_CASE("cli checkpoint: a finished one is kept where it was asked for, and resumed is success", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -s 4 -o a.exr --checkpoint done.film -q").code == 0);
  REQUIRE(folder.has("done.film"));
  const std::string film = folder.read("done.film"), picture = folder.read("a.exr");
  std::filesystem::remove(folder.path() / "a.exr");
  const Result again =
      folder.run("render slow.json -s 4 -o a.exr --checkpoint done.film --resume --stats-json stats.json");
  CHECK(again.code == 0);
  CHECK(folder.read("a.exr") == picture);
  CHECK(folder.read("done.film") == film);
  CHECK_THAT(folder.read("stats.json"), Contains("\"primary_rays\": 0,"));
  CHECK_THAT(folder.read("stats.json"), Contains("\"resumed_samples\": 6144,"));
}

TEST_CASE("cli checkpoint: that of another render is refused, and what differs is named", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -s 4 -o a.exr --checkpoint done.film -q").code == 0);
  std::string brighter = kSlow;
  brighter.replace(brighter.find("[8, 8, 8]"), 9, "[8, 8, 9]");
  folder.write("other.json", brighter);
  struct Other {
    const char *arguments, *message;
  };
  for (const Other& other : {Other{"slow.json -s 8 -o a.exr", "spp is 4 there and 8 here"},
                             {"slow.json -s 4 -o a.exr --seed 2", "seed is 0 there"},
                             {"slow.json -s 4 -o a.png", "layers is "},
                             {"slow.json -s 4 -o a.exr -D r=0.6", "scene is "},
                             {"other.json -s 4 -o a.exr", "scene is "},
                             {"slow.json -s 4 -o a.exr --crop 0,0,9,9", "crop is 0,0,48,32 there and 0,0,9,9 here"},
                             {"slow.json -s 4 -o a.exr --sample-range 1:3", "sample range is 0:4 there and 1:3"},
                             {"slow.json -s 4 -o a.exr --fov 30deg", "field of view is"},
                             {"slow.json -s 4 -o a.exr --filter tent", "filter is box there and tent here"},
                             {"slow.json -s 4 -o a.exr --clamp 2", "clamp is none there and 2 here"},
                             {"slow.json -s 4 -o a.exr -b 3", "rr depth is"},
                             {"slow.json -s 4 -o a.exr --size 20x10", "size is 48x32 there and 20x10 here"}}) {
    const Result result = folder.run(std::string("render ") + other.arguments + " --checkpoint done.film --resume");
    INFO(other.arguments << "\n" << result.err);
    CHECK(result.code == 65);
    CHECK_THAT(result.err, Contains("another render") && Contains(other.message));
  }
  // Options that change no sample do not make another render.
  CHECK(folder.run("render slow.json -s 4 -o b.exr --checkpoint done.film --resume -t 5 --threads 3 --exposure 1")
            .code == 0);
  folder.write("spaced.json", kSlow + "\n\n");
  CHECK(folder.run("render spaced.json -s 4 -o a.exr --checkpoint done.film --resume").code == 0);
}

TEST_CASE("cli checkpoint: without --resume a state of this very render is not overwritten", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -s 4 -o a.exr --checkpoint done.film -q").code == 0);
  REQUIRE(folder.run_script(interrupted("slow.json -o b.exr", "INT", "b.exr.checkpoint")).out == "75\n");
  for (const auto& [arguments, file] : {std::pair{"slow.json -s 4 -o a.exr --checkpoint done.film", "done.film"},
                                        {"slow.json -o b.exr", "b.exr.checkpoint"},
                                        {"slow.json -o b.exr --time-limit 0.1s", "b.exr.checkpoint"}}) {
    const std::string before = folder.read(file);
    const Result again = folder.run(std::string("render ") + arguments);
    INFO(arguments << again.err);
    CHECK(again.code == 2);
    CHECK_THAT(again.err, Contains(file) && Contains("samples per pixel of this very render") &&
                              Contains("add --resume") && Contains("remove `"));
    CHECK(folder.read(file) == before);
  }
}

TEST_CASE("cli checkpoint: of another render it gives way under the name that nobody chose", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -s 4 -o a.exr --checkpoint done.film -q").code == 0);
  const std::string film = folder.read("done.film");
  const Result named = folder.run("render slow.json -s 5 -o a.exr --checkpoint done.film");
  CHECK(named.code == 65);
  CHECK_THAT(named.err, Contains("spp is 4 there and 5 here") && Contains("remove `done.film`"));
  CHECK(folder.read("done.film") == film);
  folder.write("a.exr.checkpoint", film);
  const Result other = folder.run("render slow.json -s 5 -o a.exr");
  CHECK(other.code == 0);
  CHECK_THAT(other.err, Contains("`a.exr.checkpoint` is there from another render and will be replaced"));
  CHECK(folder.read("a.exr.checkpoint") == film);  // the render ended before its first checkpoint was due
  CHECK(folder.run("render slow.json -s 5 -o a.exr --time-limit 1e-9").code == 0);
  CHECK(folder.read("a.exr.checkpoint") != film);
  const Result none = folder.run("render slow.json -s 4 -o c.exr --resume");
  CHECK(none.code == 0);
  CHECK_THAT(none.err, Contains("there is no checkpoint"));
}

TEST_CASE("cli checkpoint: a broken one is no reason not to render, and what is no film stays", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -s 4 -o a.exr --checkpoint done.film -q").code == 0);
  std::string damaged = folder.read("done.film"), newer = damaged;
  damaged[damaged.size() - 9] ^= 1;  // a byte of the film's sums
  newer[8] = 9;
  for (const std::string& broken : {damaged, newer}) {
    folder.write("done.film", broken);
    folder.write("a.exr.checkpoint", broken);
    CHECK(folder.run("render slow.json -s 4 -o a.exr --checkpoint done.film").code == 65);
    for (const char* file : {"a.exr.checkpoint", "done.film"}) {
      const Result resumed = folder.run("render slow.json -s 4 -o a.exr --resume --checkpoint " + std::string(file));
      CHECK(resumed.code == 65);
      CHECK_THAT(resumed.err, Contains("remove `" + std::string(file)));
      CHECK(folder.read(file) == broken);
    }
    const Result afresh = folder.run("render slow.json -s 4 -o a.exr");
    CHECK(afresh.code == 0);
    CHECK_THAT(afresh.err, Contains("will be replaced"));
  }
  for (const char* mine : {"mine", "mine, and as long as the head of a film", ""}) {
    folder.write("notes.txt", mine);
    folder.write("a.exr.checkpoint", mine);
    for (const char* way : {"", " --resume"}) {
      const Result refused = folder.run("render slow.json -s 4 -o a.exr --checkpoint notes.txt" + std::string(way));
      CHECK(refused.code == 65);
      CHECK_THAT(refused.err, !Contains("remove") && Contains("--checkpoint FILE chooses another name"));
    }
    CHECK(folder.run("render slow.json -s 4 -o a.exr").code == 65);
    CHECK(folder.read("notes.txt") == mine);
    CHECK(folder.read("a.exr.checkpoint") == mine);
  }
  CHECK(folder.run("render slow.json -s 4 -o a.exr --checkpoint slow.json").code == 2);
}

TEST_CASE("cli checkpoint: what another run has written meanwhile is its own", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -s 4 -o b.exr --checkpoint other.film -q").code == 0);
  const std::string other = folder.read("other.film");
  for (const bool stopped : {false, true}) {
    const Result result = folder.run_script(
        "rm -f a.exr.checkpoint\n\"$fathom\" render slow.json -o a.exr -q --checkpoint-interval 0.01s &\npid=$!\n" +
        until("a.exr.checkpoint") + "cp other.film copy; mv copy a.exr.checkpoint\n" +
        std::string(stopped ? "kill -INT $pid\n" : "") + "wait $pid; echo $?");
    INFO(result.err);
    CHECK(result.out == (stopped ? "74\n" : "0\n"));
    CHECK_THAT(result.err, Contains("another run has written `a.exr.checkpoint`"));
    CHECK(folder.read("a.exr.checkpoint") == other);
  }
}

TEST_CASE("cli checkpoint: the picture so far is written before every pixel has a sample", "[cli]") {
  const SlowFolder folder;
  const Result stopped =
      folder.run_script(interrupted("slow.json -o a.png --size 900x900 --threads 1", "INT", "a.png.checkpoint"));
  INFO(stopped.err);
  CHECK(stopped.out == "75\n");
  CHECK_THAT(stopped.err, Contains("a pixel has 0 samples at least"));
  CHECK(folder.has("a.png"));
  CHECK(folder.has("a.png.checkpoint"));
  const Result limited = folder.run("render slow.json -o b.png --time-limit 1e-9 --threads 3 -t 5");
  CHECK(limited.code == 0);
  CHECK_THAT(limited.err, Contains("a pixel has 1 sample at least, 1.00 on average"));
  const Result part = folder.run("render slow.json -o c.film -s 1024 --sample-range 512:1024 --time-limit 1e-9");
  CHECK_THAT(part.err, Contains("a pixel has 1 sample at least, 1.00 on average"));
}

TEST_CASE("cli checkpoint: no help names one in a folder that is gone", "[cli]") {
  const SlowFolder folder;
  const std::string options = "slow.json -o a.exr -s 65536 --checkpoint kept/now.film";  // too many samples to finish
  REQUIRE(folder.run_script("mkdir kept\n" + interrupted(options, "INT", "kept/now.film")).out == "75\n");
  const Result gone = folder.run_script(
      "touch mark\n\"$fathom\" render " + options + " -q --resume --checkpoint-interval 0.01s &\npid=$!\n" +
      "while ! [ kept/now.film -nt mark ] && kill -0 $pid 2>/dev/null; do sleep 0.02; done\n" +
      "rm -r kept\ntouch kept\nkill -INT $pid 2>/dev/null\nwait $pid; echo $?\n");
  INFO(gone.err);
  CHECK(gone.out == "74\n");
  CHECK_THAT(gone.err, Contains("is not kept") && !Contains("an earlier state of it is in"));
}

TEST_CASE("cli checkpoint: nobody who listens need stay", "[cli]") {
  const SlowFolder folder;
  // Messages go to a pipe whose reader has gone.
  const std::string render = "\"$fathom\" render slow.json -o a.exr --checkpoint-interval 0.01s -v &\npid=$!\n";
  folder.run_script("( sleep 0.1\n" + render + "wait $pid; echo $? >done ) 2>&1 | true\n" + until_said("done"));
  CHECK(folder.read("done") == "0\n");
  CHECK(folder.has("a.exr"));
  folder.run_script("( sleep 0.1\n" + render + until("a.exr.checkpoint") +
                    "kill -INT $pid\nwait $pid; echo $? >stopped ) 2>&1 | true\n" + until_said("stopped"));
  CHECK(folder.read("stopped") == "75\n");
  // Under nohup, SIGHUP does not stop the render.
  const Result nohup =
      folder.run_script("trap '' HUP\n" + interrupted("slow.json -o c.exr", "HUP", "c.exr.checkpoint"));
  CHECK(nohup.out == "0\n");
}

TEST_CASE("cli checkpoint: SIGUSR1 is no end before the first ray either", "[cli]") {
  const SlowFolder folder;
  const Result result = folder.run_script(
      "( sleep 1.5; cat slow.json ) | \"$fathom\" render - -q -s 1 -o a.png &\n"
      "sleep 0.8; kill -USR1 $!; wait $!; echo $?");
  CHECK(result.out == "0\n");
  const Result watching =
      folder.run_script("\"$fathom\" render slow.json -q -s 1 -o b.png --watch &\npid=$!\n" + until("b.png") +
                        "kill -USR1 $pid; sleep 0.1; kill -TERM $pid; wait $pid; echo $?");
  CHECK(watching.out == "143\n");
}

TEST_CASE("cli checkpoint: what cannot be written is 74, and what was there stays", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -o whole.exr -q").code == 0);
  REQUIRE(folder.run_script(interrupted("slow.json -o a.exr", "INT", "a.exr.checkpoint")).out == "75\n");
  const std::string before = folder.read("a.exr.checkpoint");
  std::filesystem::remove(folder.path() / "a.exr");
  // No file can grow beyond 20 blocks of 512 bytes, as on a full disk.
  const Result full = folder.run_script(
      "ulimit -f 20\n\"$fathom\" render slow.json -o a.exr --resume --checkpoint-interval 0.01s; echo $?");
  INFO(full.err);
  CHECK(full.out == "74\n");
  CHECK_THAT(full.err, Contains("warning: no checkpoint") && Contains("cannot write"));
  CHECK_THAT(full.err, Contains("an earlier state of it is in a.exr.checkpoint"));
  CHECK(folder.read("a.exr.checkpoint") == before);
  CHECK_FALSE(folder.has("a.exr"));
  CHECK(folder.files() == 5);  // the scenes, whole.exr and the checkpoint
  REQUIRE(folder.run("render slow.json -o a.exr --resume -q").code == 0);
  CHECK((folder.read("a.exr") == folder.read("whole.exr")));
  const Result nowhere = folder.run("render slow.json -o a.exr --checkpoint slow.json/a.film");
  CHECK(nowhere.code == 74);
  CHECK_THAT(nowhere.err, Contains("slow.json"));
}

// One batch of rays took 110 s of processor time, and the limit was looked at between batches.
TEST_CASE("cli checkpoint: a time limit and a signal end a render within a batch of rays", "[cli]") {
  const Folder folder;
  folder.write("slow.fathom", R"scene(fathom 1
param time = 0.2
background [1,1,1]
camera (position = [-0.7843, 0.8493, 4], target = [0,0,0], fov = 45, shutter = 0.8)
object ((expression("noise(3*x,3*y,3*z)*0.2 + length(x,y,z) - 0.7")).polar_repetition(5)).translate([-0.9626, 0, 0.8379 + 3*time])
object ((((expression("length(x,y,z) - 0.792 + 0.05*sin(9*x)*sin(7*y+z)")) -{stairs = 0.2, steps = 3} ((expression("x^2+y^2*1.5+z^4 - 0.4593")).onion(0.05)).translate([-0.1476,0.2843,0.2733]))).twist(turn = 13.38)).translate([-0.3549, 0, 0.7537 + 3*time])
object (((sphere(0.4022)).displacement(0.05*sin(8*x)*cos(7*y))).bend(turn = 7.203)).translate([-0.8008, 0, -0.1506 + 3*time])
object plane([0,1,0], offset = -1)
object ...[for i in 0..150: sphere(0.12).translate([2*random(i)-1, 2*random(i,1)-1, 2*random(i,2)-1])]
)scene");
  // The whole picture takes a hundred times as long.
  const Result limited =
      folder.run_script("timeout 30 \"$fathom\" render slow.fathom -o a.png --time-limit 0.5; echo $?");
  CHECK(limited.out == "0\n");
  CHECK_THAT(limited.err, Contains("no pixel has a sample yet") || Contains("the time limit ended the render"));
  const Result stopped = folder.run_script(
      "\"$fathom\" render slow.fathom -o b.png --checkpoint b.film &\npid=$!\nsleep 2\nkill -TERM $pid\nwait $pid; echo $?");
  CHECK(stopped.out == "75\n");
  CHECK_THAT(stopped.err, Contains("interrupted") || Contains("while the picture was prepared"));
}

// Renders with ever shorter time limits until one ends the render. No limit is right for all machines: 0.2 s was
// enough for the whole picture on a fast one.
Result limited(const Folder& folder, const std::string& arguments, const std::string& checkpoint) {
  Result stopped;
  for (double limit = 0.2; limit > 1e-3; limit /= 2) {
    std::filesystem::remove(folder.path() / checkpoint);
    stopped =
        folder.run("render slow.json --threads 1 " + arguments + " --time-limit " + std::to_string(limit) + "s");
    if (stopped.err.find("the time limit ended the render") != std::string::npos) {
      break;
    }
  }
  return stopped;
}

TEST_CASE("cli checkpoint: a time limit writes what there is and says so", "[cli]") {
  const SlowFolder folder;
  REQUIRE(folder.run("render slow.json -o whole.exr -q").code == 0);
  const Result stopped = limited(folder, "-o a.exr --checkpoint a.film --stats-json s.json", "a.film");
  CHECK(stopped.code == 0);
  CHECK_THAT(stopped.err, Contains("the time limit ended the render: a pixel has "));
  CHECK_THAT(folder.read("s.json"), Contains("\"ended_by\": \"time limit\""));
  CHECK((folder.read("a.exr") != folder.read("whole.exr")));
  REQUIRE(folder.run("render slow.json -o a.exr --checkpoint a.film --resume -q").code == 0);
  CHECK((folder.read("a.exr") == folder.read("whole.exr")));
  // The default checkpoint name is used as well, whatever the interval.
  const Result unnamed = limited(folder, "-o b.exr", "b.exr.checkpoint");
  CHECK(unnamed.code == 0);
  CHECK_THAT(unnamed.err, Contains("what is done is in b.exr.checkpoint; --resume goes on"));
  REQUIRE(folder.run("render slow.json -o b.exr --resume -q").code == 0);
  CHECK((folder.read("b.exr") == folder.read("whole.exr")));
  CHECK_FALSE(folder.has("b.exr.checkpoint"));
  CHECK(folder.run("render slow.json -s 2 -o a.exr --time-limit 1h -q").code == 0);
  for (const char* wrong : {"0", "-3s", "10x", "h", "nan"}) {
    CHECK(folder.run(std::string("render slow.json -o a.exr --time-limit ") + wrong).code == 2);
  }
}

TEST_CASE("cli checkpoint: a name that cannot be is refused before the first sample", "[cli]") {
  const SlowFolder folder;
  CHECK(folder.run("render slow.json -o a.exr --checkpoint ''").code == 2);
  const std::string longest(255 - 4, 'n');
  CHECK(folder.run("render slow.json -s 1 -q --checkpoint a.film -o " + longest + ".exr").code == 0);
  // The name of its checkpoint is too long.
  const Result both = folder.run("render slow.json -s 1 -q -o " + longest + ".exr");
  CHECK(both.code == 74);
  CHECK_THAT(both.err, Contains("too long"));
}

TEST_CASE("cli checkpoint: --watch has none", "[cli]") {
  for (const char* asked : {"--resume", "--checkpoint a.film", "--checkpoint-interval 5s"}) {
    CHECK(SlowFolder().run("render slow.json -o a.exr --watch " + std::string(asked)).code == 2);
  }
}

TEST_CASE("cli checkpoint: tests/suites/kills in short", "[cli][heavy]") {
  const Folder folder;
  const Result result = folder.run_script("'" FATHOM_SOURCE_DIR "/tests/suites/kills' 8 \"$fathom\"");
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK_THAT(result.out, Contains("8 kills: 8 equal hashes"));
}

}  // namespace

}  // namespace fathom::cli_checkpoint_test
