// Prints the digests of all evaluators' results, to be compared between processors and compilers.
#include <cstdio>

#include "tests/support/evaluator_bits.h"

int main() { std::fputs(fathom::test::evaluator_bits().c_str(), stdout); }
