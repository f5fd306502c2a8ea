// Messages of `check` and `render` about a field that is NaN somewhere. Regression: rays that met a NaN were black
// without a warning.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_invalid_test {

namespace {

using Catch::Contains;
using fathom::test::Folder;

constexpr const char* kRoot = R"J({"version": 1, "background": [1, 1, 1], "objects": [
  {"type": "expression", "half_size": [2, 2, 2], "formula": "length(x, y, z) - 1 + 0*sqrt(0.5 - x)"}]})J";
constexpr const char* kGuarded = R"J({"version": 1, "background": [1, 1, 1], "objects": [
  {"type": "expression", "half_size": [2, 2, 2], "formula": "length(x, y, z) - 1 + 0*sqrt(max(0.5 - x, 0))"}]})J";

}  // namespace

TEST_CASE("cli: a render counts the rays that met no number, and names what and where", "[cli]") {
  const Folder folder;
  folder.write("root.json", kRoot);
  const std::string render = "render root.json -o root.png -r 16 -s 1 -q --threads ";
  const auto one = folder.run(render + "1"), three = folder.run(render + "3");
  CHECK(one.code == 0);
  CHECK_THAT(one.err, Contains(" rays (") && Contains(" are black") &&
                          Contains("the sqrt at root.json:2:86 has no value") && Contains("sqrt(max(x, 0))"));
  CHECK(one.err == three.err);
  folder.write("root.json", kGuarded);
  CHECK_THAT(folder.run(render + "1").err, !Contains("black"));
}

TEST_CASE("cli: check finds a point where the field is no number", "[cli]") {
  const Folder folder;
  folder.write("root.json", kRoot);
  CHECK_THAT(folder.run("check root.json").err, Contains("W0514"));
  CHECK(folder.run("check root.json").code == 0);
  folder.write("root.json", kGuarded);
  CHECK_THAT(folder.run("check root.json").err, !Contains("W0514"));
}

}  // namespace fathom::cli_invalid_test
