// Every evaluator gives the same bits on every processor, with every instruction set and compiler.
#include "tests/support/evaluator_bits.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/catch.h"
#include "tests/support/golden.h"

namespace fathom::test::evaluator_bits_test {

// The compiler's changes of shipped scenes' programs change the digests, and a change without one of the first digest
// is a change of the evaluators.
TEST_CASE("evaluators: the same bits on every processor", "[interpret][isa]") {
  const std::filesystem::path path = std::filesystem::path(FATHOM_SOURCE_DIR) / "tests/golden/evaluators/bits.txt";
  const std::string bits = evaluator_bits();
  if (std::getenv("FATHOM_UPDATE_GOLDEN") != nullptr) std::ofstream(path, std::ios::binary) << bits;
  INFO("run with FATHOM_UPDATE_GOLDEN=1 once opcodes or shipped scenes have changed");
  CHECK(read_file(path) == bits);
}

}  // namespace fathom::test::evaluator_bits_test
