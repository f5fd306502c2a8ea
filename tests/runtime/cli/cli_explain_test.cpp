// End-to-end tests of `fathom explain`.
#include <fmt/format.h>

#include <string>

#include "compiler/source/error_codes.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::test::cli_explain_test {

using Catch::Contains;

TEST_CASE("explain says what every code means, with an example", "[cli]") {
  const Folder folder;
  const std::string list = folder.run("explain").out;
  for (const compiler::ErrorCode& row : compiler::kErrorCodes) {
    CAPTURE(std::string(row.code));
    const Result result = folder.run(fmt::format("explain {}", row.code));
    CHECK(result.code == 0);
    CHECK(result.out.starts_with(fmt::format("{}: {}\n", row.code, row.meaning)));
    CHECK_THAT(list, Contains(fmt::format("{}  {}\n", row.code, row.meaning)));
    if (row.code != "W0516" && row.code != "E0007") {
      CHECK_THAT(result.out, Contains("gets this message:\n\n    ") &&
                                 Contains(fmt::format("\n    {}[{}]: ", row.code[0] == 'E' ? "error" : "warning",
                                                      row.code)));
    }
  }
  CHECK_THAT(folder.run("explain e0803").out, Contains("\n    fathom 1\n"));  // a text before a JSON scene
}

TEST_CASE("explain names a near code", "[cli]") {
  const Folder folder;
  const Result result = folder.run("explain E0312x");
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Contains("did you mean E0312?"));
  CHECK_THAT(folder.run("explain nonsense").err, Contains("lists all codes"));
}

}  // namespace fathom::test::cli_explain_test
