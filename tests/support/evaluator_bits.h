// Digests of all results of every evaluator, over random programs and shipped scenes. The digests are the same on
// every processor, with every compiler.
#pragma once

#include <string>

namespace fathom::test {

// Returns the number of programs, and one line per evaluator: its name and the digest of its results. An instruction
// set whose results differ adds a line that ends with its name.
std::string evaluator_bits();

}  // namespace fathom::test
