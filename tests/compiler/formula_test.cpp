// Formulas: what they mean, what they are made into, and where their errors are.
#include "compiler/frontend/formula.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "compiler/frontend/formula_evaluate.h"

namespace {

using namespace fathom::compiler;
using syntax::Value;

// As if the text stood at the begin of a file, in quotes.
Value in_quotes(const std::string& text) { return {{0, static_cast<std::uint32_t>(text.size() + 2)}, text}; }

Scope scope_of(std::initializer_list<std::pair<const char*, double>> parameters) {
  Scope scope;
  for (const auto& [name, value] : parameters) {
    scope.declare(name, {});
    Scope::Entry& entry = scope.at(scope.entries().size() - 1);
    entry.parameter.value = value;
    entry.state = Scope::State::Known;
  }
  return scope;
}

const Scope& some_scope() {
  static const Scope scope = scope_of({{"r", 0.5}, {"n", 3}});
  return scope;
}

Formula read(const Value& value) {
  Diagnostics diagnostics;
  const auto formula = read_formula(value, some_scope(), constant_functions(), diagnostics);
  INFO(diagnostics.print(Source(), ErrorFormat::Short));
  REQUIRE(formula.has_value());
  REQUIRE(diagnostics.all().empty());
  return *formula;
}
Formula read(const std::string& text) { return read(in_quotes(text)); }

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

TEST_CASE("formula: numbers", "[formula]") {
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

TEST_CASE("formula: precedence and associativity", "[formula]") {
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

TEST_CASE("formula: powers", "[formula]") {
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

TEST_CASE("formula: every function of one and two numbers", "[formula]") {
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

TEST_CASE("formula: functions made of others", "[formula]") {
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

TEST_CASE("formula: the machine's function comes before one made of others", "[formula]") {
  const FunctionSpec machine[] = {{"sin", 1}, {"cos", 1}, {"clamp", 3}};
  const auto with = [&](const std::string& text) {
    Diagnostics diagnostics;
    const auto formula = read_formula(in_quotes(text), some_scope(), machine, diagnostics);
    REQUIRE(formula.has_value());
    return print(*formula);
  };
  CHECK(with("clamp(x, 0, 1)") == "clamp(x, 0, 1)");
  CHECK(with("clamp(3, 0, 1)") == "clamp(3, 0, 1)");  // not known in double: left to the machine
  CHECK(with("tan(x)") == "divide(sin(x), cos(x))");
}

TEST_CASE("formula: what is used twice is one node", "[formula]") {
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

TEST_CASE("formula: arguments stand before what they are arguments of, and nothing is left over", "[formula]") {
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

TEST_CASE("formula: constants are folded", "[formula]") {
  CHECK(made_of("2*r + 1") == "2");
  CHECK(made_of("x*(2*r + 1)") == "multiply(x, 2)");
  CHECK(made_of("x*sqrt(4)") == "multiply(x, 2)");
  CHECK(read("2*r + 1").nodes.size() == 1);
  Formula by_hand;
  by_hand.nodes = {{"const", 3, {}, {}}, {"square", 0, {0}, {}}, {"minus", 0, {1, 0}, {}}};
  CHECK(evaluate(by_hand) == 6);
}

TEST_CASE("formula: spans are those of the text", "[formula]") {
  const std::string text = "x + sin(y)*2";
  const Formula formula = read(text);
  std::vector<std::string> parts;
  for (const Formula::Node& node : formula.nodes) {
    parts.push_back(("\"" + text + "\"").substr(node.span.begin, node.span.end - node.span.begin));
  }
  CHECK(parts == std::vector<std::string>{"x", "y", "sin(y)", "2", "sin(y)*2", "x + sin(y)*2"});
}

TEST_CASE("formula: nesting ends at a limit, length does not", "[formula]") {
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

struct Wrong {
  const char* text;
  const char* code;
  const char* where;    // the characters under the carets
  const char* message;  // or a part of it
  const char* help = "";
};

void check_wrong(const Wrong& wrong, const Diagnostics& diagnostics) {
  CAPTURE(wrong.text, diagnostics.print(Source("", "\"" + std::string(wrong.text) + "\""), ErrorFormat::Text));
  REQUIRE(diagnostics.all().size() == 1);
  const Diagnostic& first = diagnostics.all()[0];
  CHECK(first.code == wrong.code);
  CHECK(("\"" + std::string(wrong.text) + "\"").substr(first.span.begin, first.span.end - first.span.begin) ==
        wrong.where);
  CHECK(first.message.find(wrong.message) != std::string::npos);
  const std::string help = first.help.empty() ? "" : first.help[0];
  CHECK(help.find(wrong.help) != std::string::npos);
}

TEST_CASE("formula: errors are where they are", "[formula]") {
  const Wrong cases[] = {
      {"", "E0401", "\"", "an empty formula"},
      {"   ", "E0401", "\"", "the formula ends too early"},
      {"x +", "E0401", "\"", "the formula ends too early"},
      {"x + * y", "E0401", "*", "`*` where a value was expected"},
      {"+x", "E0401", "+", "`+` where a value was expected"},
      {"()", "E0401", ")", "`)` where a value was expected"},
      {"max(1, )", "E0401", ")", "`)` where a value was expected"},
      {"max(, 1)", "E0401", ",", "`,` where a value was expected"},
      {"2*(x + 1", "E0401", "(", "`(` is never closed"},
      {"sin(x", "E0401", "(", "`(` is never closed"},
      {"x + 1)", "E0401", ")", "`)` without a `(` before it"},
      {"2 x", "E0401", "x", "an operator is missing before `x`", "a*b"},
      {"2x", "E0401", "x", "an operator is missing before `x`", "a*b"},
      {"(x)(y)", "E0401", "(", "an operator is missing before `(`", "a*b"},
      {"(x y)", "E0401", "y", "an operator is missing before `y`", "a*b"},
      {"1.2.3", "E0401", ".3", "an operator is missing before `.3`"},
      {"0,5", "E0401", ",", "`,` outside a function's arguments", "0.5"},
      {"(0,5)", "E0401", ",", "`,` outside a function's arguments", "0.5"},
      {"a = 3", "E0401", "=", "`=` within a formula", "before the last line"},
      {"x = 3", "E0401", "=", "`=` within a formula"},
      {"x == 1", "E0401", "==", "formulas have no `==`", "step"},
      {"x <= 1", "E0401", "<=", "formulas have no `<=`", "step"},
      {"x && y", "E0401", "&&", "formulas have no `&&`", "min"},
      {"x ? 1 : 2", "E0401", "?", "formulas have no `?`", "mix"},
      {"x % 2", "E0401", "%", "formulas have no `%`", "mod(a, b)"},
      {"x ** 2", "E0401", "**", "formulas have no `**`", "a^b"},
      {"|x|", "E0401", "|", "formulas have no `|`", "abs"},
      {"x \u00D7 2", "E0401", "\u00D7", "formulas have no `\u00D7`", "a*b"},
      {"x + \u00E9", "E0401", "\u00E9", "formulas have no `\u00E9`"},
      {"x @ 2", "E0401", "@", "formulas have no `@`"},
      {"x.y", "E0401", ".", "formulas have no `.`"},
      {"1e999", "E0009", "1e999", "too large"},
      {"x + rr", "E0402", "rr", "unknown name `rr`", "did you mean `r`?"},
      {"PI", "E0402", "PI", "unknown name `PI`", "did you mean `pi`?"},
      {"sin x", "E0402", "sin", "the function `sin` without arguments", "write sin(...)"},
      {"1 + sqr(x)", "E0403", "sqr", "unknown function `sqr`", "did you mean `sqrt`?"},
      {"r(x)", "E0403", "r", "unknown function `r`", "for a product write r*(...)"},
      {"x(2)", "E0403", "x", "unknown function `x`", "for a product write x*(...)"},
      {"nearest(x)", "E0403", "nearest", "unknown function `nearest`"},
      {"add(x, y)", "E0403", "add", "unknown function `add`"},
      {"1 + max(x)", "E0404", "max(x)", "`max` takes 2 arguments, not 1", "write max(a, b)"},
      {"sin()", "E0404", "sin()", "`sin` takes 1 argument, not 0", "write sin(a)"},
      {"length(1,2,3,4)", "E0404", "length(1,2,3,4)", "`length` takes 2 or 3 arguments, not 4"},
  };
  for (const Wrong& wrong : cases) {
    Diagnostics diagnostics;
    CHECK(!read_formula(in_quotes(wrong.text), some_scope(), constant_functions(), diagnostics));
    check_wrong(wrong, diagnostics);
  }
}

TEST_CASE("formula: several unknown words are several errors", "[formula]") {
  Diagnostics diagnostics;
  CHECK(!read_formula(in_quotes("aa + bb*cc(dd)"), some_scope(), constant_functions(), diagnostics));
  CHECK(diagnostics.errors() == 4);
}

TEST_CASE("formula: with escapes the whole string is marked", "[formula]") {
  const Value value{{10, 20}, std::string("x + q")};  // longer in the file than its characters
  Diagnostics diagnostics;
  CHECK(!read_formula(value, some_scope(), constant_functions(), diagnostics));
  REQUIRE(diagnostics.all().size() == 1);
  CHECK((diagnostics.all()[0].span.begin == 10 && diagnostics.all()[0].span.end == 20));
}

TEST_CASE("formula: without a point there are no coordinates", "[formula]") {
  for (const char* axis : {"x", "y", "z"}) {
    Diagnostics diagnostics;
    CHECK(!read_number(in_quotes(fmt::format("1 + {}", axis)), some_scope(), diagnostics));
    check_wrong({fmt::format("1 + {}", axis).c_str(), "E0405", axis, "has no value here", "the formula of a node"},
                diagnostics);
  }
}

TEST_CASE("formula: parameters that are not known", "[formula]") {
  Scope scope = scope_of({{"r", 1}});
  scope.declare("later", {});
  scope.declare("broken", {});
  scope.at(2).state = Scope::State::Unusable;
  Diagnostics diagnostics;
  CHECK(!read_number(in_quotes("r + broken"), scope, diagnostics));
  CHECK(diagnostics.all().empty());  // said where it is declared
  CHECK(!read_number(in_quotes("r + later"), scope, diagnostics));
  check_wrong({"r + later", "E0402", "later", "`later` has no value yet"}, diagnostics);
}

TEST_CASE("formula: wrong lines", "[formula]") {
  struct Case {
    std::vector<std::string> lines;
    const char* code;
    const char* message;
  };
  const Case cases[] = {
      {{"sin(x)", "y"}, "E0401", "must be `name = ...`"},
      {{"", "y"}, "E0401", "must be `name = ...`"},
      {{"a + 1 = x", "y"}, "E0401", "must be `name = ...`"},
      {{"a =", "a"}, "E0401", "ends too early"},
      {{"a = x b", "a"}, "E0401", "an operator is missing before `b`"},
      {{"a = x", "a = 2*a"}, "E0401", "`=` within a formula"},
      {{"x = 2", "y"}, "E0407", "the name `x` is a coordinate"},
      {{"sin = 2", "y"}, "E0407", "the name `sin` is a function"},
      {{"pi = 3", "y"}, "E0407", "the name `pi` is a constant"},
      {{"r = 3", "y"}, "E0407", "the name `r` is a parameter"},
      {{"a = 3", "a = 4", "a"}, "E0407", "the name `a` is defined already"},
      {{"a = b", "b = 1", "a"}, "E0402", "unknown name `b`"},
      {{"a = 1", "aa + 1"}, "E0402", "unknown name `aa`"},
      {{"a = 1", "a(2)"}, "E0403", "unknown function `a`"},
  };
  for (const Case& wrong : cases) {
    syntax::List list;
    for (const std::string& line : wrong.lines) list.push_back(in_quotes(line));
    Diagnostics diagnostics;
    CHECK(!read_formula({{}, std::move(list)}, some_scope(), constant_functions(), diagnostics));
    CAPTURE(wrong.lines, diagnostics.print(Source(), ErrorFormat::Text));
    REQUIRE(diagnostics.all().size() == 1);
    CHECK(diagnostics.all()[0].code == wrong.code);
    CHECK(diagnostics.all()[0].message.find(wrong.message) != std::string::npos);
  }
}

TEST_CASE("formula: what is no string and no list of strings", "[formula]") {
  const auto refused = [](Value value) {
    Diagnostics diagnostics;
    CHECK(!read_formula(value, some_scope(), constant_functions(), diagnostics));
    return diagnostics.all().size() == 1 && diagnostics.all()[0].code == "E0101";
  };
  CHECK(refused({{}, 5.0}));
  CHECK(refused({{}, syntax::List{}}));
  syntax::List mixed;
  mixed.push_back({{}, 5.0});
  mixed.push_back(in_quotes("x"));
  CHECK(refused({{}, std::move(mixed)}));
}

TEST_CASE("formula: names of parameters", "[formula]") {
  for (const char* good : {"r", "wall_thickness", "_a", "R2", "X"}) {
    CHECK(misfit_name(good, constant_functions()) == "");
  }
  for (const char* bad : {"", "2r", "a-b", "a b", "\u00E9", "x", "y", "z", "e", "pi", "tau", "sin", "mod", "mix"}) {
    CHECK(misfit_name(bad, constant_functions()) != "");
  }
}

}  // namespace
