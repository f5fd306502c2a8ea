// Reference evaluator of expression lists: line by line, in double, without regard to speed or rounding errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace fathom::test {

inline double plain_operation(const std::string& op, double a, double b) {
  if (op == "neg") return -a;
  if (op == "abs") return std::abs(a);
  if (op == "sqrt") return std::sqrt(a);
  if (op == "square") return a * a;
  if (op == "floor") return std::floor(a);
  if (op == "ceil") return std::ceil(a);
  if (op == "round") return std::round(a);
  if (op == "sin") return std::sin(a);
  if (op == "cos") return std::cos(a);
  if (op == "tan") return std::tan(a);
  if (op == "asin") return std::asin(a);
  if (op == "acos") return std::acos(a);
  if (op == "atan") return std::atan(a);
  if (op == "ln") return std::log(a);
  if (op == "exp") return std::exp(a);
  if (op == "not") return a == 0;
  if (op == "add") return a + b;
  if (op == "sub") return a - b;
  if (op == "mul") return a * b;
  if (op == "div") return a / b;
  if (op == "min") return std::min(a, b);
  if (op == "max") return std::max(a, b);
  if (op == "atan2") return std::atan2(a, b);
  if (op == "compare") return (a > b) - (a < b);
  if (op == "mod") return a - std::abs(b) * std::floor(a / std::abs(b));
  if (op == "and") return a == 0 ? a : b;
  if (op == "or") return a != 0 ? a : b;
  FAIL("no operation " << op);
  return 0;
}

// Returns the value of the last line at each point. Each line is evaluated at all points before the next line.
inline std::vector<double> plain_list(const std::string& text, const std::vector<glm::dvec3>& points) {
  std::map<std::string, std::vector<double>> values;
  std::string last;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, op, a, b;
    words >> name >> op >> a >> b;
    if (name.empty() || name[0] == '#') continue;
    std::vector<double> out(points.size());
    if (op == "const") {
      std::fill(out.begin(), out.end(), std::stod(a));
    } else if (op.starts_with("var-")) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = points[i][op.back() - 'x'];
    } else {
      const std::vector<double>& left = values.at(a);
      const std::vector<double>& right = b.empty() ? left : values.at(b);
      // fast path: most lines of long lists
      if (op == "min" || op == "max" || op == "add" || op == "sub" || op == "mul") {
        for (std::size_t i = 0; i < out.size(); ++i) {
          const double x = left[i], y = right[i];
          out[i] = op[1] == 'i' ? std::min(x, y) : op == "max" ? std::max(x, y) : op[0] == 'a' ? x + y
                   : op[0] == 's' ? x - y : x * y;
        }
      } else {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = plain_operation(op, left[i], right[i]);
      }
    }
    last = name;
    values[name] = std::move(out);
  }
  return values.at(last);
}

}  // namespace fathom::test
