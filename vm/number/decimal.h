// Decimal logarithms and powers of ten of one double: the same on every machine, unlike libm's. A number that people
// read is rounded by them.
// Tested by: tests/vm/number/decimal_test.cpp
#pragma once

namespace fathom::vm::real {

// Returns log(x) / ln 10, which may lie beside the whole number if x is a power of ten.
double log10(double x);
// Returns the exponent of the shortest decimal form of x: 3 for 1000 and for 9999.5. 0 for 0, infinity and NaN.
int decimal_exponent(double x);
// Returns the double nearest to 10^exponent, -323 <= exponent <= 308.
double power_of_ten(int exponent);

}  // namespace fathom::vm::real
