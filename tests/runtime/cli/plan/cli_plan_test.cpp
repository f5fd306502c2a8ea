// `fathom plan`: the units of a plan, rendered in any order by any machine, equal the whole render bit for bit.
// Missing or broken units are found, and units that do not belong together are refused.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_plan_test {

namespace {

using namespace fathom::test;
using Catch::Contains;
namespace fs = std::filesystem;

const char* const kHop = R"(fathom 1
import "lib/hop.fathom" as hop
param time = 0
param wide = 1
film (width = 32, height = 20, frames = 3)
render (spp = 6)
background (bottom = [0.8, 0.85, 0.9], top = [0.4, 0.6, 1])
object hop.ball(time).scale(wide).material(diffuse(color = [0.7, 0.2, 0.1]))
object "floor" plane([0, 1, 0], offset = -0.5)
)";

class PlanFolder : public Folder {
 public:
  PlanFolder() {
    write("hop.fathom", kHop);
    fs::create_directories(path() / "lib");
    write("lib/hop.fathom", "fathom 1\ndef ball(t) = sphere(0.5).translate([4*t, abs(sin(20*t)), 0])\n");
  }
};

void check_same(const Folder& folder, const std::string& a, const std::string& b) {
  INFO(a << " and " << b);
  CHECK(!folder.read(a).empty());
  CHECK((folder.read(a) == folder.read(b)));
}

}  // namespace

TEST_CASE("cli plan: the units of frames, in any order, are the frames of one run", "[cli]") {
  const PlanFolder folder;
  const Result planned =
      folder.run("plan hop.fathom --frames all -D wide=1.5 --denoise --tiles 2x2 --sample-block 4 -o p.json");
  INFO(planned.err);
  REQUIRE(planned.code == 0);
  CHECK_THAT(planned.err,
             Contains("wrote p.json: 3 frames of 32x20 pixels and 6 samples, in 2x2 tiles and 2 blocks of 4: "
                      "24 units") &&
                 Contains("a unit takes"));
  CHECK(nlohmann::json::parse(folder.run("plan --status p.json --json").out)["frames"] == "0:3:1");
  REQUIRE(folder.run("render hop.fathom --frames all -D wide=1.5 --denoise -q -o w.##.png -o w.##.exr").code == 0);
  // The plan file alone is enough.
  fs::create_directories(folder.path() / "far");
  fs::rename(folder.path() / "p.json", folder.path() / "far/p.json");
  fs::remove_all(folder.path() / "lib");
  fs::remove(folder.path() / "hop.fathom");
  const Result one = folder.run("render --plan far/p.json --unit 7");
  INFO(one.err);
  CHECK(one.code == 0);
  CHECK_THAT(one.err, Contains("1 unit of far/p.json: 1 rendered"));
  CHECK(folder.run("render --plan far/p.json --units 20:24,0,3-5 --threads 1 -q").code == 0);
  const Result status = folder.run("plan --status far/p.json");
  CHECK(status.code == 1);
  CHECK_THAT(status.out,
             Contains("9 done, 15 missing, 0 begun, 0 broken") && Contains("units to be rendered: 1-2,6,8-19"));
  CHECK_THAT(folder.run("plan --status far/p.json --per-task 5").out, Contains("tasks to be rendered: 0-3"));
  const Result early = folder.run("merge --plan far/p.json -o m.##.png");
  CHECK(early.code == 74);
  CHECK_THAT(early.err, Contains("frame 0 lacks 3 of 8 units") && Contains("--units 1-2,6"));
  CHECK(!folder.has("m.00.png"));
  const Result rest = folder.run("render --plan far/p.json --units 0:24");
  CHECK_THAT(rest.err, Contains("24 units of far/p.json: 15 rendered") && Contains("9 there already"));
  CHECK(folder.run("plan --status far/p.json").code == 0);
  const Result merged = folder.run("merge --plan far/p.json -o m.##.png -o m.##.exr");
  INFO(merged.err);
  CHECK(merged.code == 0);
  for (const std::string& frame : std::vector<std::string>{"00", "01", "02"}) {
    for (const std::string& name : std::vector<std::string>{frame + ".png", frame + "-noisy.png", frame + ".exr"})
      check_same(folder, "m." + name, "w." + name);
  }
  CHECK(folder.run("merge --plan far/p.json --frames 1 -o again.##.png -q").code == 0);
  check_same(folder, "again.01.png", "w.01.png");
  CHECK(!folder.has("again.00.png"));
}

TEST_CASE("cli plan: a still of a compiled file, with the background's picture in the plan", "[cli]") {
  const Folder folder;
  folder.write("sky.json",
               R"({"version": 1, "params": {"r": 0.5}, "film": {"width": 20, "height": 10}, "render": {"spp": 3},
    "background": {"type": "image", "file": "sky.hdr"}, "objects": [{"type": "sphere", "radius": "r"}]})");
  REQUIRE(folder.run("render ball.json --size 8x4 -q -o sky.hdr").code == 0);
  REQUIRE(folder.run("compile sky.json -D r=0.7 -o sky.fbc").code == 0);
  REQUIRE(folder.run("render sky.json -D r=0.7 -q -o w.exr").code == 0);
  const Result planned = folder.run("plan sky.fbc --tiles 3x1 --sample-block 2 --no-pilot -o p.json");
  INFO(planned.err);
  REQUIRE(planned.code == 0);
  fs::remove(folder.path() / "sky.hdr");
  const Result run = folder.run("render --plan p.json --units 0:6");
  INFO(run.err);
  CHECK(run.code == 0);
  CHECK(folder.run("merge --plan p.json -q -o m.exr").code == 0);
  check_same(folder, "m.exr", "w.exr");
}

TEST_CASE("cli plan: without --tiles and --sample-block units are cut by the time that they take", "[cli]") {
  const Folder folder;
  const std::string plan = "plan ball.json --size 200x130 -s 8 -o p.json ";
  CHECK_THAT(folder.run(plan + "--unit-time 10h --workers 4").err,
             Contains("in 1x1 tiles and 1 block of 8: 1 unit\n") && Contains("4 machines like it: "));
  // Tiles are split first, down to 64 pixels per side.
  CHECK_THAT(folder.run(plan + "--unit-time 1e-9").err, Contains("in 3x2 tiles and 8 blocks of 1: 48 units\n"));
  CHECK_THAT(folder.run(plan + "--unit-time 1e-9 --tiles 1x2").err, Contains("in 1x2 tiles and 8 blocks of 1"));
}

TEST_CASE("cli plan: a worker needs memory for its unit, not for the frame", "[cli]") {
  const Folder folder;
  const std::string picture = " ball.json --size 640x640 -s 1 --region-memory 8";
  REQUIRE(folder.run("plan" + picture + " --tiles 16x16 --no-pilot -q -o p.json").code == 0);
  CHECK(folder.run("render" + picture + " --limit memory=20000000 -q -o w.png").code == 2);
  CHECK(folder.run("render --plan p.json --unit 100 --limit memory=20000000 -q").code == 0);
}

TEST_CASE("cli plan: what was cut short or is of another unit is found and rendered again", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("plan ball.json --tiles 2x1 --sample-block 1 --no-pilot -q -o p.json").code == 0);
  REQUIRE(folder.run("render --plan p.json --units 0:4 -q").code == 0);
  const fs::path films = folder.path() / "p.units/000";
  fs::resize_file(films / "000001.film", fs::file_size(films / "000001.film") - 1);
  fs::copy_file(films / "000000.film", films / "000003.film", fs::copy_options::overwrite_existing);
  const auto json = nlohmann::json::parse(folder.run("plan --status p.json --json").out);
  CHECK(json["done"] == 2);
  CHECK(json["broken"] == 2);
  CHECK(json["left"] == "1,3");
  CHECK(json["faults"][0]["reason"].get<std::string>().find("not as long as") != std::string::npos);
  CHECK(json["faults"][1]["reason"] == "it is of another unit");
  // A changed byte of the sums is found by their checksum.
  {
    std::fstream film(films / "000002.film", std::ios::in | std::ios::out | std::ios::binary);
    film.seekp(-40, std::ios::end);
    film.put(77);
  }
  CHECK_THAT(folder.run("plan --status p.json --sums").out,
             Contains("1 done, 0 missing, 0 begun, 3 broken") && Contains("checksum"));
  fs::remove(films / "000002.film");
  const Result again = folder.run("render --plan p.json --units 0:4 -q");
  CHECK(again.code == 0);
  CHECK_THAT(again.err, Contains("rendered again"));
  CHECK(folder.run("render ball.json -q -o w.png").code == 0);
  CHECK(folder.run("merge --plan p.json -q -o m.png").code == 0);
  check_same(folder, "m.png", "w.png");
}

// Units that are whole frames have one size and one range of samples: a film of another frame counted as done.
TEST_CASE("cli plan: a film of another frame is of another unit", "[cli]") {
  const Folder folder;
  folder.write("move.fathom",
               "fathom 1\nparam time = 0\nbackground [1, 1, 1]\nobject sphere(0.5).translate([sin(time), 0, 0])\n");
  const std::string tiles = GENERATE("1x1", "2x1");
  const std::string plan = "plan move.fathom --frames 0:4 --size 16x12 -s 2 --no-pilot -q -o p.json --tiles ";
  REQUIRE(folder.run(plan + tiles).code == 0);
  REQUIRE(folder.run("render --plan p.json -q --units " + std::string(tiles == "1x1" ? "0:4" : "0:8")).code == 0);
  const fs::path films = folder.path() / "p.units/000";
  fs::copy_file(films / "000002.film", films / "000000.film", fs::copy_options::overwrite_existing);
  const Result status = folder.run("plan --status p.json");
  CHECK(status.code == 1);
  CHECK_THAT(status.out, Contains("unit 0: it is of another unit"));
  CHECK(folder.run("merge --plan p.json -q -o m.png").code == 65);
  CHECK_THAT(folder.run("render --plan p.json --unit 0 -q").err, Contains("rendered again"));
  CHECK(folder.run("merge --plan p.json -q -o m.png").code == 0);
}

// It asked for every unit's file: 400 million calls.
TEST_CASE("cli plan: the status of a plan takes the time of the units that exist", "[cli]") {
  const Folder folder;
  folder.write("move.fathom", "fathom 1\nparam time = 0\nfilm(frames = 100000000)\nobject sphere(1 + time)\n");
  const Result planned = folder.run(
      "plan move.fathom --tiles 2x2 --frames 0:100000000 --size 64x48 -s 8 --no-pilot -q -o p.json");
  INFO(planned.err);
  REQUIRE(planned.code == 0);
  CHECK_THAT(folder.run("plan --status p.json").out, Contains("units to be rendered: 0-399999999"));
  CHECK(folder.run("merge --plan p.json -q -o m.png").code == 74);
  REQUIRE(folder.run("render --plan p.json --units 5,399999999 -q").code == 0);
  CHECK_THAT(folder.run("plan --status p.json").out,
             Contains("2 done, 399999998 missing") && Contains("units to be rendered: 0-4,6-399999998\n"));
  CHECK_THAT(folder.run("plan --status p.json --per-task 4").out, Contains("tasks to be rendered: 0-99999999\n"));
}

TEST_CASE("cli plan: a checkpoint beside a finished film is named and removed", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("plan ball.json --tiles 2x1 --no-pilot -q -o p.json").code == 0);
  REQUIRE(folder.run("render --plan p.json --unit 0 -q").code == 0);
  const fs::path films = folder.path() / "p.units/000";
  fs::copy_file(films / "000000.film", films / "000000.film.checkpoint");
  fs::copy_file(films / "000000.film", films / "000001.film.checkpoint");
  const Result status = folder.run("plan --status p.json");
  CHECK_THAT(status.out, Contains("1 done, 0 missing, 1 begun"));
  CHECK_THAT(status.err, Contains("000000.film.checkpoint` lay beside its finished film and was removed"));
  CHECK_FALSE(folder.has("p.units/000/000000.film.checkpoint"));
  CHECK(folder.has("p.units/000/000001.film.checkpoint"));
}

TEST_CASE("cli plan: a queue's variable says which unit, or which task of several", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("plan ball.json --tiles 4x2 --sample-block 2 --no-pilot -q -o p.json").code == 0);
  const std::string none =
      "env -u SLURM_ARRAY_TASK_ID -u JOB_COMPLETION_INDEX -u AWS_BATCH_JOB_ARRAY_INDEX -u SGE_TASK_ID -u "
      "PBS_ARRAY_INDEX ";
  const std::string unit = " \"$fathom\" render --plan p.json -q --unit env";
  CHECK(folder.run_script(none + "SLURM_ARRAY_TASK_ID=5" + unit).code == 0);
  CHECK(folder.run_script(none + "SGE_TASK_ID=1" + unit).code == 0);  // SGE numbers its tasks from 1
  CHECK(
      folder.run_script(none + "SGE_TASK_ID=undefined AWS_BATCH_JOB_ARRAY_INDEX=2 " + unit + " --per-task 3").code ==
      0);
  CHECK_THAT(folder.run("plan --status p.json").out, Contains("units to be rendered: 1-4"));
  const Result unset = folder.run_script(none + unit);
  CHECK(unset.code == 2);
  CHECK_THAT(unset.err, Contains("no queue has set the number of a task") && Contains("JOB_COMPLETION_INDEX"));
  const Result beyond = folder.run_script(none + "PBS_ARRAY_INDEX=8" + unit);
  CHECK(beyond.code == 2);
  CHECK_THAT(beyond.err, Contains("the plan has no unit 8") && Contains("0 to 7"));
}

TEST_CASE("cli plan: what does not go together is refused by what differs", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("plan ball.json --tiles 2x2 --no-pilot -q -o p.json").code == 0);
  REQUIRE(folder.run("render --plan p.json --unit 0 -q").code == 0);
  struct Case {
    const char* arguments;
    int code;
    const char* message;
  };
  for (const Case& bad :
       {Case{"render --unit 3", 2, "--plan FILE"},
        {"render --plan p.json", 2, "which units?"},
        {"render --plan p.json --unit 1 -s 8", 2, "--spp does not go with --plan"},
        {"render --plan p.json --unit 1 -o a.png", 2, "--output does not go with --plan"},
        {"render --plan p.json --units 3:3", 2, "are no units"},
        {"render --plan p.json --unit 4", 2, "has no unit 4"},
        {"render --plan ball.json --unit 0", 65, "no plan"},
        {"render --plan none.json --unit 0", 74, "cannot read"},
        {"render", 2, "the scene is missing"},
        {"merge -o a.png", 2, "the films are missing"},
        {"merge a.film --plan p.json -o a.png", 2, "goes with no other"},
        {"plan ball.json", 2, "no file to write"},
        {"plan ball.json --tiles 64x1 --no-pilot -o q.json", 2, "more than the 32x16 pixels"},
        {"plan ball.json --size 2000x2000 --tiles 2000x2000 -s 999 --sample-block 1 --no-pilot -o q.json", 2,
         "1000000000 units at most"},
        {"plan ball.json --noise-threshold 0 -s 16 -o q.json", 2, "a noise threshold"},
        {"plan ball.json -o ball.json", 2, "ball.json"},
        {"plan ball.json --json -o q.json", 2, "go with --status"}}) {
    INFO(bad.arguments);
    const Result result = folder.run(bad.arguments);
    INFO(result.err);
    CHECK(result.code == bad.code);
    CHECK_THAT(result.err, Contains(bad.message));
  }
  std::string text = folder.read("p.json");
  text.replace(text.find("\"samples\": 2"), 12, "\"samples\": 4");
  folder.write("changed.json", text);
  CHECK_THAT(folder.run("render --plan changed.json --unit 1").err, Contains("it was changed since it was made"));
  REQUIRE(folder.run("plan ball.json --tiles 2x2 --seed 1 --no-pilot -q -o p.json").code == 0);
  const Result other = folder.run("render --plan p.json --unit 1");
  CHECK(other.code == 65);
  CHECK_THAT(other.err, Contains("has units of another plan") && Contains("remove `p.units`"));
  CHECK(folder.run("plan --status p.json").code == 65);
}

TEST_CASE("cli plan: a signal leaves a checkpoint of the unit, which goes on from there", "[cli]") {
  const Folder folder;
  const std::string spp = is_sanitized() ? "2000" : "20000";
  REQUIRE(folder.run("plan ball.json -s " + spp + " --tiles 1x1 --no-pilot -q -o p.json").code == 0);
  REQUIRE(folder.run("render ball.json -s " + spp + " -q -o w.exr").code == 0);
  const std::string film = "p.units/000/000000.film";
  const Result stopped = folder.run_script(
      "\"$fathom\" render --plan p.json --unit 0 -q --checkpoint-interval 0.01s &\npid=$!\n"
      "while ! [ -e " +
      film +
      ".checkpoint ] && kill -0 $pid 2>/dev/null; do sleep 0.01; done\n"
      "kill -TERM $pid\nwait $pid; echo $?");
  INFO(stopped.err);
  REQUIRE(stopped.out == "75\n");
  CHECK(!folder.has(film));
  CHECK_THAT(folder.run("plan --status p.json").out, Contains("1 begun"));
  const Result resumed = folder.run("render --plan p.json --unit 0");
  CHECK(resumed.code == 0);
  CHECK_THAT(resumed.err, Contains("resumed"));
  CHECK(!folder.has(film + ".checkpoint"));
  CHECK(folder.run("merge --plan p.json -q -o m.exr").code == 0);
  check_same(folder, "m.exr", "w.exr");
}

}  // namespace fathom::cli_plan_test
