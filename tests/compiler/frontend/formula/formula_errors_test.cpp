// Formulas with errors: the messages and their positions.
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "compiler/frontend/formula/formula_evaluate.h"
#include "compiler/frontend/formula/read_formula.h"
#include "tests/compiler/frontend/formula/formula_texts.h"
#include "tests/support/catch.h"

namespace fathom::formula_errors_test {

namespace {

using namespace fathom::compiler;
using namespace fathom::test;
using syntax::Value;

struct Wrong {
  const char* text;
  const char* code;
  const char* where;    // characters under the carets
  const char* message;  // message or a part of it
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

TEST_CASE("formula: errors are where they are", "[frontend][formula]") {
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
      {"noise(x, y)", "E0404", "noise(x, y)", "`noise` takes 3 arguments, not 2", "write noise(a, b, c)"},
      {"fbm(x, y, z)", "E0404", "fbm(x, y, z)", "`fbm` takes 4 arguments, not 3", "write fbm(a, b, c, d)"},
      {"fbm(x, y, z, 2.5)", "E0410", "2.5", "the last argument of `fbm` is a whole number from 1 to 12, not 2.5"},
      {"1 + fbm(x, y, z, 1 - 1)", "E0410", "1 - 1", "from 1 to 12, not 0"},
      {"fbm(x, y, z, 13)", "E0410", "13", "from 1 to 12, not 13"},
      {"fbm(x, y, z, 0/0)", "E0410", "0/0", "from 1 to 12, not "},
      {"fbm(1, 2, 3, floor(x))", "E0410", "floor(x)", "from 1 to 12, not one that varies"},
      {"length(1,2,3,4)", "E0404", "length(1,2,3,4)", "`length` takes 2 or 3 arguments, not 4"},
  };
  for (const Wrong& wrong : cases) {
    Diagnostics diagnostics;
    CHECK(!read_formula(in_quotes(wrong.text), some_scope(), constant_functions(), diagnostics));
    check_wrong(wrong, diagnostics);
  }
}

TEST_CASE("formula: several unknown words are several errors", "[frontend][formula]") {
  Diagnostics diagnostics;
  CHECK(!read_formula(in_quotes("aa + bb*cc(dd)"), some_scope(), constant_functions(), diagnostics));
  CHECK(diagnostics.errors() == 4);
}

TEST_CASE("formula: with escapes the whole string is marked", "[frontend][formula]") {
  const Value value{{10, 20}, std::string("x + q")};  // longer in the file than its characters
  Diagnostics diagnostics;
  CHECK(!read_formula(value, some_scope(), constant_functions(), diagnostics));
  REQUIRE(diagnostics.all().size() == 1);
  CHECK((diagnostics.all()[0].span.begin == 10 && diagnostics.all()[0].span.end == 20));
}

TEST_CASE("formula: without a point there are no coordinates", "[frontend][formula]") {
  for (const char* axis : {"x", "y", "z"}) {
    Diagnostics diagnostics;
    CHECK(!read_number(in_quotes(fmt::format("1 + {}", axis)), some_scope(), diagnostics));
    check_wrong({fmt::format("1 + {}", axis).c_str(), "E0405", axis, "has no value here", "the formula of a node"},
                diagnostics);
  }
}

TEST_CASE("formula: parameters that are not known", "[frontend][formula]") {
  Scope scope = scope_of({{"r", 1}});
  scope.declare("later", {});
  scope.declare("broken", {});
  scope.at(2).state = Scope::State::Unusable;
  Diagnostics diagnostics;
  CHECK(!read_number(in_quotes("r + broken"), scope, diagnostics));
  CHECK(diagnostics.all().empty());  // the declaration reports the error
  CHECK(!read_number(in_quotes("r + later"), scope, diagnostics));
  check_wrong({"r + later", "E0402", "later", "`later` has no value yet"}, diagnostics);
}

TEST_CASE("formula: wrong lines", "[frontend][formula]") {
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

TEST_CASE("formula: what is no string and no list of strings", "[frontend][formula]") {
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

}  // namespace

}  // namespace fathom::formula_errors_test
