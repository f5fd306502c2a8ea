#include "vm/number/decimal.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <numbers>
#include <string>

#include "vm/number/real.h"

namespace fathom::vm::real {

double log10(double x) { return log(x) / std::numbers::ln10; }

int decimal_exponent(double x) {
  std::array<char, 32> text{};  // for example "-9.9995e+03"
  char* const end = std::to_chars(text.data(), text.data() + text.size() - 1, x, std::chars_format::scientific).ptr;
  char* const e = std::find(text.data(), end, 'e');
  return e == end ? 0 : static_cast<int>(std::strtol(e + 1, nullptr, 10));
}

double power_of_ten(int exponent) {
  const std::string text = "1e" + std::to_string(exponent);
  double power = 0;
  std::from_chars(text.data(), text.data() + text.size(), power);
  return power;
}

}  // namespace fathom::vm::real
