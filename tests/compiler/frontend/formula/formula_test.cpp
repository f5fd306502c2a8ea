// Formulas: their values and the nodes that they become.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "compiler/frontend/formula/formula_evaluate.h"
#include "compiler/frontend/formula/formula_functions.h"
#include "compiler/frontend/formula/formula_nodes.h"
#include "compiler/frontend/formula/formula_parser.h"
#include "compiler/frontend/formula/read_formula.h"
#include "compiler/frontend/text/read_text.h"
#include "tests/compiler/frontend/formula/formula_texts.h"
#include "tests/support/catch.h"
#include "tests/support/judge/judge_noise.h"

namespace fathom::formula_test {

namespace {

using namespace fathom::compiler;
using namespace fathom::test;
using syntax::Value;

Formula read(const Value& value) {
  Diagnostics diagnostics;
  const auto formula = read_formula(value, some_scope(), constant_functions(), diagnostics);
  INFO(diagnostics.print(Source(), ErrorFormat::Short));
  REQUIRE(formula.has_value());
  REQUIRE(diagnostics.all().empty());
  return *formula;
}

// Checks the same expression in the text notation.
void check_in_text(const std::string& expression, const Formula& expected) {
  Source source("a.fathom", fmt::format("fathom 1\nparam r = 0.5\nparam n = 3\nlet unused = r*n\n"
                                        "object expression({})\n",
                                        expression));
  Diagnostics diagnostics;
  const auto scene = read_text_scene(source, {}, {}, diagnostics);
  INFO(diagnostics.print(source, ErrorFormat::Text));
  REQUIRE(scene);
  const auto& root = std::get<syntax::Record>(scene->first.root.data);
  const auto& object = std::get<syntax::List>(root.find("objects")->value->data)[0];
  const Value& made = *std::get<syntax::Record>(object.data).find("formula")->value;
  const auto formula = read_formula(made, some_scope(), machine_functions(), diagnostics);
  REQUIRE(formula->nodes.size() == expected.nodes.size());
  for (std::size_t i = 0; i < expected.nodes.size(); ++i) {
    CHECK(formula->nodes[i].function == expected.nodes[i].function);
    CHECK(std::bit_cast<std::uint64_t>(formula->nodes[i].value) ==
          std::bit_cast<std::uint64_t>(expected.nodes[i].value));
    CHECK(formula->nodes[i].arguments == expected.nodes[i].arguments);
  }
}

Formula read(const std::string& text) {
  Diagnostics diagnostics;
  const auto formula = read_formula(in_quotes(text), some_scope(), machine_functions(), diagnostics);
  if (formula) check_in_text(text, *formula);
  return read(in_quotes(text));
}

Formula read_lines(const std::vector<std::string>& lines) {
  syntax::List list;
  for (const std::string& line : lines) list.push_back(in_quotes(line));
  return read(Value{{}, std::move(list)});
}

double value_of(const std::string& text) {
  CAPTURE(text);
  Diagnostics diagnostics;
  const auto number = read_number(in_quotes(text), some_scope(), diagnostics);
  INFO(diagnostics.print(Source(), ErrorFormat::Short));
  REQUIRE(number.has_value());
  const auto formula = read_formula(in_quotes(text), some_scope(), machine_functions(), diagnostics);
  if (formula) check_in_text(text, *formula);
  return *number;
}

std::string print(const Formula& formula, std::uint32_t at) {
  const Formula::Node& node = formula.nodes[at];
  if (node.function == "const") return fmt::format("{}", node.value);
  std::string out(node.function);
  for (std::size_t i = 0; i < node.arguments.size(); ++i) {
    out += (i == 0 ? "(" : ", ") + print(formula, node.arguments[i]);
  }
  return node.arguments.empty() ? out : out + ")";
}
std::string print(const Formula& formula) {
  return print(formula, static_cast<std::uint32_t>(formula.nodes.size() - 1));
}
std::string made_of(const std::string& text) { return print(read(text)); }

TEST_CASE("formula: numbers", "[frontend][formula]") {
  CHECK(value_of("0") == 0);
  CHECK(value_of(" 12.25 ") == 12.25);
  CHECK(value_of(".5") == 0.5);
  CHECK(value_of("2.") == 2);
  CHECK(value_of("1e3") == 1000);
  CHECK(value_of("1.5E-3") == 1.5e-3);
  CHECK(value_of("1e-400") == 0);
  CHECK(value_of("pi") == std::numbers::pi);
  CHECK(value_of("tau") == 2 * std::numbers::pi);
  CHECK(value_of("e") == std::numbers::e);
  CHECK(value_of("r") == 0.5);
}

TEST_CASE("formula: noise is the machine's, fbm a sum of it", "[frontend][formula]") {
  CHECK(made_of("noise(x, 2*y, z + 1)") == "noise(x, multiply(2, y), add(z, 1))");
  CHECK(made_of("fbm(x, y, z, 1)") == "noise(x, y, z)");
  CHECK(made_of("fbm(x, 0, y, n - 1)") ==
        "add(noise(x, 0, y), multiply(noise(add(multiply(x, 2), 6.9375), 10.3125, add(multiply(y, 2), 17.0625)), "
        "0.5))");
  const Formula finest = read("fbm(sqrt(x), y, z, 12)");  // the octaves share one sqrt node
  CHECK(std::ranges::count(finest.nodes, "sqrt", &Formula::Node::function) == 1);
  for (const glm::dvec3 p : {glm::dvec3(0.25, 0.5, -1.75), glm::dvec3(-3.125, 40, 0.0625)}) {
    const std::string at = fmt::format("{}, {}, {}", p.x, p.y, p.z);
    CHECK(std::abs(value_of("noise(" + at + ")") - judge_noise(p)) <= 1e-15);
    for (int octaves = 1; octaves <= 12; ++octaves) {
      double sum = 0;
      for (int k = 0; k < octaves; ++k) {
        const double apart = k == 0 ? 0 : 2 * k + 1, scale = std::ldexp(1, k);
        sum += judge_noise(p * scale + apart * glm::dvec3(2.3125, 3.4375, 5.6875)) / scale;
      }
      CHECK(std::abs(value_of(fmt::format("fbm({}, {})", at, octaves)) - sum) <= 1e-14);
    }
  }
}

TEST_CASE("formula: no two octaves of fbm are 0 at one place", "[frontend][formula]") {
  // Along each axis, if octave j is at an integer coordinate, octave k > j is not.
  for (const double apart : {37.0 / 16, 55.0 / 16, 91.0 / 16}) {
    const auto offset = [&](int k) { return k == 0 ? 0 : (2 * k + 1) * apart; };
    for (int k = 1; k < 12; ++k) {
      for (int j = 0; j < k; ++j) {
        const double off = offset(k) - std::ldexp(offset(j), k - j);
        CHECK(std::abs(off - std::round(off)) >= 1.0 / 16);
      }
    }
  }
}

TEST_CASE("formula: precedence and associativity", "[frontend][formula]") {
  CHECK(made_of("x + y*z") == "add(x, multiply(y, z))");
  CHECK(made_of("(x + y)*z") == "multiply(add(x, y), z)");
  CHECK(made_of("x - y - z") == "minus(minus(x, y), z)");
  CHECK(made_of("x - y + z") == "add(minus(x, y), z)");
  CHECK(made_of("x/y/z") == "divide(divide(x, y), z)");
  CHECK(made_of("x/y*z") == "multiply(divide(x, y), z)");
  CHECK(made_of("-x^2") == "negate(square(x))");
  CHECK(made_of("(-x)^2") == "square(negate(x))");
  CHECK(made_of("-x*y") == "multiply(negate(x), y)");
  CHECK(made_of("x*-y") == "multiply(x, negate(y))");
  CHECK(made_of("x - -y") == "minus(x, negate(y))");
  CHECK(made_of("x^y^z") == "power(x, power(y, z))");
  CHECK(made_of("x^-y") == "power(x, negate(y))");
  CHECK(made_of("x^y*z") == "multiply(power(x, y), z)");
  CHECK(value_of("2^3^2") == 512);
  CHECK(value_of("-2^2") == -4);
  CHECK(value_of("7 - 2 - 1") == 4);
  CHECK(value_of("12/3/2") == 2);
  CHECK(value_of("--3") == 3);
}

TEST_CASE("formula: powers", "[frontend][formula]") {
  CHECK(made_of("x^0") == "1");
  CHECK(made_of("x^1") == "x");
  CHECK(made_of("x^2") == "square(x)");
  CHECK(made_of("x^3") == "multiply(square(x), x)");
  CHECK(made_of("x^4") == "square(square(x))");
  CHECK(made_of("x^7") == "multiply(square(multiply(square(x), x)), x)");
  CHECK(made_of("x^n") == made_of("x^3"));
  CHECK(made_of("x^(n - 1)") == "square(x)");
  CHECK(made_of("pow(x, 2)") == "square(x)");
  CHECK(made_of("x^-2") == "divide(1, square(x))");
  CHECK(made_of("x^0.5") == "sqrt(x)");
  CHECK(made_of("x^-0.5") == "divide(1, sqrt(x))");
  CHECK(made_of("x^1.5") == "power(x, 1.5)");
  CHECK(made_of("x^64") == "square(square(square(square(square(square(x))))))");
  CHECK(made_of("x^65") == "power(x, 65)");
  CHECK(made_of("x^(1/0)") == "power(x, inf)");
  for (int n = -64; n <= 64; ++n) {
    CHECK(value_of(fmt::format("1.1^{}", n)) == Approx(std::pow(1.1, n)).epsilon(1e-14));
  }
}

TEST_CASE("formula: every function of one and two numbers", "[frontend][formula]") {
  CHECK(value_of("abs(-2)") == 2);
  CHECK(value_of("square(3)") == 9);
  CHECK(value_of("sqrt(2)") == std::sqrt(2.0));
  CHECK(value_of("sin(1)") == Approx(std::sin(1.0)));
  CHECK(value_of("cos(1)") == Approx(std::cos(1.0)));
  CHECK(value_of("tan(1)") == Approx(std::tan(1.0)));
  CHECK(value_of("asin(0.3)") == Approx(std::asin(0.3)));
  CHECK(value_of("acos(0.3)") == Approx(std::acos(0.3)));
  CHECK(value_of("atan(0.3)") == Approx(std::atan(0.3)));
  CHECK(value_of("atan2(1, -2)") == Approx(std::atan2(1.0, -2.0)));
  CHECK(value_of("exp(1.5)") == Approx(std::exp(1.5)));
  CHECK(value_of("log(1.5)") == Approx(std::log(1.5)));
  CHECK(value_of("2^0.3") == Approx(std::pow(2.0, 0.3)));
  CHECK(value_of("floor(-1.5)") == -2);
  CHECK(value_of("ceil(-1.5)") == -1);
  CHECK(value_of("round(2.5)") == 2);
  CHECK(value_of("round(3.5)") == 4);
  CHECK((value_of("sign(-3)") == -1 && value_of("sign(0)") == 0 && value_of("sign(3)") == 1));
  CHECK((value_of("min(1, 2)") == 1 && value_of("max(1, 2)") == 2));
  CHECK((value_of("mod(5, 3)") == 2 && value_of("mod(-1, 3)") == 2 && value_of("mod(1, -3)") == -2));
  CHECK((value_of("step(1, 0.5)") == 0 && value_of("step(1, 1)") == 1 && value_of("step(1, 2)") == 1));
  for (const char* lost : {"min(0/0, 1)", "min(1, 0/0)", "max(0/0, 1)", "max(1, 0/0)", "sign(0/0)", "step(0/0, 1)"}) {
    CHECK(std::isnan(value_of(lost)));
  }
}

TEST_CASE("formula: functions made of others", "[frontend][formula]") {
  CHECK(made_of("clamp(x, y, z)") == "min(max(x, y), z)");
  CHECK(made_of("mix(x, y, z)") == "add(x, multiply(minus(y, x), z))");
  CHECK(made_of("length(x, y)") == "sqrt(add(square(x), square(y)))");
  CHECK(made_of("length(x, y, z)") == "sqrt(add(add(square(x), square(y)), square(z)))");
  CHECK(made_of("hypot(x, y)") == made_of("length(x, y)"));
  CHECK(made_of("round(x)") == "nearest(x)");
  CHECK(made_of("mod(x, y)") == "modulo(x, y)");
  CHECK((value_of("clamp(5, 0, 1)") == 1 && value_of("clamp(-5, 0, 1)") == 0 && value_of("clamp(0.5, 0, 1)") == 0.5));
  CHECK((value_of("mix(2, 4, 0)") == 2 && value_of("mix(2, 4, 0.5)") == 3 && value_of("mix(2, 4, 1)") == 4));
  CHECK((value_of("smoothstep(1, 3, 0)") == 0 && value_of("smoothstep(1, 3, 2)") == 0.5 &&
         value_of("smoothstep(1, 3, 1.5)") == 0.15625 && value_of("smoothstep(1, 3, 9)") == 1));
  CHECK(value_of("length(3, 4)") == 5);
}

TEST_CASE("formula: the machine's function comes before one made of others", "[frontend][formula]") {
  const FunctionSpec machine[] = {{"sin", 1}, {"cos", 1}, {"clamp", 3}};
  const auto with = [&](const std::string& text) {
    Diagnostics diagnostics;
    const auto formula = read_formula(in_quotes(text), some_scope(), machine, diagnostics);
    REQUIRE(formula.has_value());
    return print(*formula);
  };
  CHECK(with("clamp(x, 0, 1)") == "clamp(x, 0, 1)");
  CHECK(with("clamp(3, 0, 1)") == "clamp(3, 0, 1)");  // not evaluated in double: left to the machine
  CHECK(with("tan(x)") == "divide(sin(x), cos(x))");
}

TEST_CASE("formula: what is used twice is one node", "[frontend][formula]") {
  const Formula mixed = read("mix(sin(x), y, z)");  // x, sin, y, z, minus, multiply, add
  CHECK(mixed.nodes.size() == 7);
  const Formula power = read("sin(x)^3");  // x, sin, square, multiply
  CHECK(power.nodes.size() == 4);
  const Formula lines = read_lines({"d = length(x, z)", "w = sin(d)", "w*d + w"});
  CHECK(print(lines) ==
        "add(multiply(sin(sqrt(add(square(x), square(z)))), sqrt(add(square(x), square(z)))), "
        "sin(sqrt(add(square(x), square(z)))))");
  CHECK(lines.nodes.size() == 9);  // x, x^2, z, z^2, +, sqrt, sin, *, +
}

TEST_CASE("formula: arguments stand before what they are arguments of, and nothing is left over",
          "[frontend][formula]") {
  const Formula formula = read_lines({"unused = sin(x)", "d = 2*r + 1", "smoothstep(0, d, length(x, y, z))*x"});
  std::vector<int> uses(formula.nodes.size(), 0);
  for (std::uint32_t i = 0; i < formula.nodes.size(); ++i) {
    for (const std::uint32_t argument : formula.nodes[i].arguments) {
      REQUIRE(argument < i);
      ++uses[argument];
    }
  }
  for (std::size_t i = 0; i + 1 < uses.size(); ++i) CHECK(uses[i] > 0);
}

TEST_CASE("formula: constants are folded", "[frontend][formula]") {
  CHECK(made_of("2*r + 1") == "2");
  CHECK(made_of("x*(2*r + 1)") == "multiply(x, 2)");
  CHECK(made_of("x*sqrt(4)") == "multiply(x, 2)");
  CHECK(read("2*r + 1").nodes.size() == 1);
  Formula by_hand;
  by_hand.nodes = {{"const", 3, {}, {}}, {"square", 0, {0}, {}}, {"minus", 0, {1, 0}, {}}};
  CHECK(evaluate(by_hand) == 6);
}

TEST_CASE("formula: spans are those of the text", "[frontend][formula]") {
  const std::string text = "x + sin(y)*2";
  const Formula formula = read(text);
  std::vector<std::string> parts;
  for (const Formula::Node& node : formula.nodes) {
    parts.push_back(("\"" + text + "\"").substr(node.span.begin, node.span.end - node.span.begin));
  }
  CHECK(parts == std::vector<std::string>{"x", "y", "sin(y)", "2", "sin(y)*2", "x + sin(y)*2"});
}

TEST_CASE("formula: nesting ends at a limit, length does not", "[frontend][formula]") {
  const auto times = [](std::size_t count, const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) out += text;
    return out;
  };
  CHECK(made_of(times(1000, "(") + "x" + times(1000, ")")) == "x");
  CHECK(value_of(times(1000, "-") + "1") == 1);
  CHECK(value_of("1" + times(1000, "^1")) == 1);
  CHECK(value_of(times(1000, "abs(") + "1" + times(1000, ")")) == 1);
  const std::string deep[] = {times(1001, "(") + "x" + times(1001, ")"), times(1001, "-") + "x",
                              "x" + times(1001, "^x"), times(1001, "abs(") + "x" + times(1001, ")"),
                              times(100000, "(")};
  for (const std::string& text : deep) {
    Diagnostics diagnostics;
    CHECK(!read_formula(in_quotes(text), some_scope(), constant_functions(), diagnostics));
    REQUIRE(diagnostics.all().size() == 1);
    CHECK(diagnostics.all()[0].code == "E0406");
  }
  CHECK(value_of("1" + times(100000, " + 1")) == 100001);
  CHECK(read("x" + times(100000, " + x*2")).nodes.size() == 400001);
  CHECK(value_of("1" + times(100000, "*1")) == 1);
}

TEST_CASE("formula: names of parameters", "[frontend][formula]") {
  for (const char* good : {"r", "wall_thickness", "_a", "R2", "X"}) {
    CHECK(misfit_name(good, formula_functions(constant_functions())) == "");
  }
  for (const char* bad : {"", "2r", "a-b", "a b", "\u00E9", "x", "y", "z", "e", "pi", "tau", "sin", "mod", "mix"}) {
    CHECK(misfit_name(bad, formula_functions(constant_functions())) != "");
  }
}

}  // namespace

}  // namespace fathom::formula_test
