// `fathom render` with --profile and --cost-map: output, files and refusals.
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_profile_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;
using fathom::test::png_size;
using fathom::test::Result;

// Returns the values of a grey portable float map.
std::vector<float> values_of(const std::string& map, const std::string& header) {
  REQUIRE(map.substr(0, header.size()) == header);
  std::vector<float> values((map.size() - header.size()) / 4);
  std::memcpy(values.data(), map.data() + header.size(), 4 * values.size());
  return values;
}

}  // namespace

TEST_CASE("cli: --profile adds the stages to the table and the JSON, and leaves the picture alone", "[cli]") {
  const Folder folder;
  const Result plain = folder.run("render ball.json -o a.png --stats-json a.json");
  const Result profiled = folder.run("render ball.json -o b.png --stats-json b.json --profile");
  REQUIRE(plain.code == 0);
  REQUIRE(profiled.code == 0);
  CHECK(folder.read("a.png") == folder.read("b.png"));
  CHECK_THAT(plain.err, !Contains("seconds of") && !Contains("lanes that held a ray") && Contains("peak memory"));
  CHECK_THAT(profiled.err, Contains("seconds of march") && Contains("seconds of waiting") &&
                               Contains("instructions an evaluation"));
  const auto a = nlohmann::json::parse(folder.read("a.json")), b = nlohmann::json::parse(folder.read("b.json"));
  CHECK(a.count("stage_seconds") == 0);
  double sum = 0;
  for (const char* stage : {"march", "certify", "normals", "shading", "film"}) {
    sum += b["stage_seconds"][stage].get<double>();
  }
  CHECK(sum > 0);
  CHECK(sum <= b["threads"].get<double>() * b["seconds"].get<double>() * (1 + 1e-4));  // the JSON has six digits
  CHECK(b["peak_memory"].get<double>() > 1e6);
  CHECK(a["evaluations"] == b["evaluations"]);
}

TEST_CASE("cli: --cost-map writes what was counted, as numbers and as colours", "[cli]") {
  const Folder folder;
  const Result result = folder.run("render ball.json -o a.png --cost-map cost.pfm --stats-json s.json");
  REQUIRE(result.code == 0);
  CHECK(folder.files() == 2 + 4);
  const auto stats = nlohmann::json::parse(folder.read("s.json"));
  for (const std::string name : {"evaluations", "instructions"}) {
    CHECK_THAT(result.err, Contains("wrote cost-" + name + ".pfm (32x16): " + name + " a sample, least 0, mean "));
    double sum = 0;
    for (const float value : values_of(folder.read("cost-" + name + ".pfm"), "Pf\n32 16\n-1.0\n")) {
      sum += 2 * static_cast<double>(value);  // samples per pixel
    }
    CHECK(sum == stats[name].get<double>());
  }
  const Result drawn = folder.run("render ball.json -o b.png --cost-map map.v1.PNG");
  REQUIRE(drawn.code == 0);
  CHECK_THAT(drawn.err, Contains("wrote map.v1-evaluations.PNG (32x50): ") && Contains("logarithmic"));
  CHECK(png_size(folder.read("map.v1-evaluations.PNG")) == std::pair(32, 50));
  CHECK(png_size(folder.read("map.v1-instructions.PNG")) == std::pair(32, 50));
  CHECK(folder.read("a.png") == folder.read("b.png"));
}

TEST_CASE("cli: a cost map is the same for any number of threads and tile size", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json --cost-map a.pfm --threads 1").code == 0);
  REQUIRE(folder.run("render ball.json --cost-map b.pfm --threads 3 -t 5").code == 0);
  CHECK(folder.read("a-evaluations.pfm") == folder.read("b-evaluations.pfm"));
  CHECK(folder.read("a-instructions.pfm") == folder.read("b-instructions.pfm"));
}

TEST_CASE("cli: a cost map that cannot be written is refused before the first ray", "[cli]") {
  const Folder folder;
  const auto expect = [&](const std::string& arguments, int code, const std::string& message) {
    INFO(arguments);
    const Result result = folder.run("render ball.json " + arguments);
    CHECK(result.code == code);
    CHECK_THAT(result.err, Contains(message) && !Contains("drew"));
  };
  expect("--cost-map cost", 2, "`cost` does not end in the name of a format for maps");
  expect("--cost-map cost.exr", 2, ".pfm for numbers");
  expect("--cost-map ball.json/cost.png", 74, "`ball.json`");
  expect("-o a-evaluations.png --cost-map a.png", 2, "`a-evaluations.png` would be overwritten");
  expect("--quiet --profile", 2, "--quiet leaves out the numbers that --profile adds to");
  CHECK(folder.files() == 2);
  CHECK(folder.run("render ball.json --quiet --profile --stats-json s.json").err == "");
}

}  // namespace fathom::cli_profile_test
