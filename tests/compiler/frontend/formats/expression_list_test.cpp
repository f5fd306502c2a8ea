#include "compiler/frontend/formats/expression_list.h"

#include <random>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/golden.h"
#include "tests/support/plain_list.h"
#include "vm/interpret/evaluate.h"

namespace fathom::expression_list_test {

namespace {

using namespace fathom;
using namespace fathom::compiler;
using fathom::test::compiled;
using fathom::test::plain_list;

std::string model(const std::string& name) {
  return test::read_file(std::filesystem::path(FATHOM_SOURCE_DIR) / "tests/data" / name);
}

std::vector<glm::dvec3> random_points(std::size_t count, double depth) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> side(-1, 1);
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = side(random), y = side(random);
    points.push_back({x, y, depth * side(random)});
  }
  return points;
}

// Max difference between the compiled scene and the list. The list is evaluated a thousand points at a time, so that
// the values of its lines fit into memory.
double farthest(const CompiledScene& scene, const std::string& text, const std::vector<glm::dvec3>& points) {
  constexpr std::size_t kBlock = 1000;
  vm::Workspace workspace;
  double worst = 0;
  for (std::size_t first = 0; first < points.size(); first += kBlock) {
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
    const std::size_t count = std::min(kBlock, points.size() - first);
    const std::vector<glm::dvec3> block(begin, begin + static_cast<std::ptrdiff_t>(count));
    const std::vector<double> truth = plain_list(text, block);
    for (std::size_t i = 0; i < count; ++i) {
      const double error = std::abs(vm::evaluate_distance(scene.distance, block[i], workspace) - truth[i]);
      worst = std::max(worst, error);
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("every operation of an expression list means what the format says", "[frontend][import]") {
  const char* const unary[] = {"neg", "abs",  "square", "floor", "ceil", "round", "sin",  "cos",
                               "tan", "asin", "acos",   "atan",  "exp",  "not",   "sqrt", "ln"};
  const char* const binary[] = {"add", "sub", "mul", "div", "min", "max", "atan2", "compare", "mod", "and", "or"};
  // Adds 1000 to the result, because the box of a drawing would cut off values below its depth.
  const std::string above = "high const 1000\nresult add r high\n";
  std::vector<glm::dvec3> points = random_points(200, 1);
  for (const double x : {-0.5, 0.0, 0.25, 0.5, 1.0}) points.push_back({x, 0.5, 0});
  const auto check = [&](const std::string& text) {
    CAPTURE(text);
    CHECK(farthest(compiled(text), text, points) < 1e-9);
  };
  for (const std::string op : unary) {
    const bool positive = op == "sqrt" || op == "ln";
    check("x var-x\none const " + std::string(positive ? "1.5" : "0") + "\na add x one\nr " + op + " a\n" + above);
    if (op == "round") check("x var-x\nk const 3\na mul x k\nr round a\n" + above);
  }
  for (const std::string op : binary) {
    const char* shift = op == "div" || op == "mod" ? "1.25" : "0";
    check("a var-x\ny var-y\ns const " + std::string(shift) + "\nb add y s\nr " + op + " a b\n" + above);
  }
  // and, or, not of an exact zero. Euclid's remainder is never negative, whatever the divisor's sign.
  check("z const 0\nx var-x\na and z x\nb or z x\nc not z\nd add a b\nr add d c\n" + above);
  check("x var-x\nm const -0.3\nr mod x m\n" + above);
}

TEST_CASE("names that formulas cannot have, blanks, comments and line ends", "[frontend][import]") {
  const std::string text =
      "# names of formulas\r\n\n x \tvar-y  \r\nline2 const 2\ne var-x\n10 mul e line2\na-b add x 10\n#\npi square "
      "a-b";
  const CompiledScene scene = compiled(text);
  CHECK(farthest(scene, text, random_points(100, 0)) < 1e-12);
}

TEST_CASE("what is an expression list", "[frontend][import]") {
  for (const char* text : {"_0 var-x", "# only a comment", "\n\n# c\n_0 const 1\n", "a frobnicate b", "10 add a b"}) {
    CAPTURE(text);
    CHECK(is_expression_list(text));
  }
  for (const char* text : {"", "\n", "{}", "// scene\n{\"version\": 1}", "# c\n{\"version\": 1}", "[1, 2]", "true",
                           "_0", "_0 1", "version: 1", "/* a b */ {}"}) {
    CAPTURE(text);
    CHECK(!is_expression_list(text));
  }
}

TEST_CASE("a byte order mark and the extremes of float are read", "[frontend][import]") {
  CHECK(compiler::is_expression_list("\xEF\xBB\xBF_0 var-x\n"));
  for (const char* number : {"340282350000000000000000000000000000000", "3.4028235e38", "1e-400", "-1e-45"}) {
    compiler::Diagnostics diagnostics;
    const std::string text = std::string("\xEF\xBB\xBF_0 const ") + number + "\n_1 var-x\n_2 mul _0 _1\n";
    INFO(number);
    CHECK(compiler::compile(compiler::Source("a.vm", text), diagnostics));
    CHECK(diagnostics.errors() == 0);
  }
  compiler::Diagnostics diagnostics;
  CHECK(!compiler::compile(compiler::Source("a.vm", "_0 const 3.41e38\n"), diagnostics));
}

TEST_CASE("prospero: small, proved, and the same as line by line", "[frontend][import][heavy]") {
  const std::string text = model("prospero.vm");
  const CompiledScene scene = compiled(text);
  CHECK(scene.node_count <= 7591);
  CHECK(scene.certified);
  CHECK(scene.lipschitz < 20);
  CHECK(farthest(scene, text, random_points(2'000, 0)) < 1e-13);
}

TEST_CASE("prospero at thirty thousand points", "[frontend][import][heavy]") {
  const std::string text = model("prospero.vm");
  CHECK(farthest(compiled(text), text, random_points(30'000, 0)) < 1e-13);
}

TEST_CASE("the box of a drawing never shows at z = 0", "[frontend][import]") {
  for (const char* name : {"prospero.vm", "hi.vm"}) {
    const std::string text = model(name);
    std::vector<glm::dvec3> points;
    for (int i = 0; i <= 40; ++i) {
      for (const double edge : {-1.0, 1.0})
        points.insert(points.end(), {{edge, i / 20.0 - 1, 0}, {i / 20.0 - 1, edge, 0}});
    }
    CHECK(farthest(compiled(text), text, points) < 1e-13);
  }
  // The deepest value that a formula of slope 1 can have at distance 1 from its zero.
  const std::string slope = "x var-x\none const 1\nr sub x one\n";
  CHECK(farthest(compiled(slope), slope, {{0, 0, 0}, {0.5, 0.5, 0}, {1, 1, 0}}) < 1e-9);
}

TEST_CASE("an expression list written as a scene is the same scene", "[frontend][import]") {
  for (const char* name : {"prospero.vm", "hi.vm"}) {
    std::string written, again;
    const CompiledScene direct = compiled(model(name), written);
    const CompiledScene imported = compiled(written, again);
    CHECK(written == again);
    CHECK(imported.summary == direct.summary);
    vm::Workspace workspace;
    for (const glm::dvec3& p : random_points(1000, 2)) {
      REQUIRE(vm::evaluate_distance(imported.distance, p, workspace) ==
              vm::evaluate_distance(direct.distance, p, workspace));
    }
  }
}

}  // namespace fathom::expression_list_test
