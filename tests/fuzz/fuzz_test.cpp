// Every fuzz target over its seeds and over what once broke it (tests/fuzz/found/NAME): what `scripts/fuzz` goes on
// from.
#include <catch2/catch.hpp>
#include <string>

#include "tests/fuzz/target.h"

namespace fathom::fuzz {
namespace {

void run_all(std::string_view name, const std::vector<Input>& inputs) {
  const Target& target = *find_target(name);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    INFO(name << ", input " << i << ": " << to_text(inputs[i]).substr(0, 400));
    CHECK_NOTHROW(target.run(inputs[i]));
  }
}

}  // namespace

TEST_CASE("fuzz targets keep their promises on their seeds", "[fuzz]") {
  const char* name = GENERATE("scene", "formula", "import", "assembly", "program", "picture", "film", "differential");
  const std::vector<Input> seeds = find_target(name)->seeds();
  CHECK(seeds.size() >= 8);
  run_all(name, seeds);
}

TEST_CASE("fuzz targets keep their promises on what once broke them", "[fuzz]") {
  for (const Target& target : targets()) {
    run_all(target.name, files_below("tests/fuzz/found/" + std::string(target.name), "", 1 << 20));
  }
}

TEST_CASE("fuzz targets say of a broken promise what broke", "[fuzz]") {
  CHECK_THROWS_WITH(promise(false, "two is not three"), "two is not three");
  CHECK_NOTHROW(promise(true, "nothing"));
  CHECK(find_target("nothing") == nullptr);
}

}  // namespace fathom::fuzz
