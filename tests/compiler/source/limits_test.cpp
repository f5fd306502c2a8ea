// Each limit of a scene at its edge: a scene at the limit compiles. A scene beyond the limit is refused with a
// message that names the position, the limit and how to raise it.
#include "compiler/source/limits.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>

#include "compiler/compile.h"
#include "tests/support/catch.h"

namespace fathom::limits_test {

namespace {

using namespace fathom::compiler;

struct Outcome {
  bool good = false;
  std::string text;  // printed diagnostics
  std::size_t nodes = 0, instructions = 0;
};

Outcome outcome_of(const std::string& text, const Limits& limits) {
  const Source source("scene.json", text);
  Diagnostics diagnostics;
  CompileOptions options;
  options.limits = limits;
  const auto scene = compile(source, diagnostics, options);
  Outcome outcome{scene.has_value(), diagnostics.print(source, ErrorFormat::Short)};
  for (const Diagnostic& d : diagnostics.all()) {
    for (const std::string& help : d.help) outcome.text += help + "\n";
  }
  if (scene) outcome.nodes = scene->node_count, outcome.instructions = scene->distance.instructions();
  return outcome;
}

// Checks that `edge` is the smallest value of the limit with which the scene compiles.
void check_edge(const std::string& text, double Limits::*limit, double edge, const std::string& code) {
  Limits limits;
  limits.*limit = edge;
  const Outcome allowed = outcome_of(text, limits);
  INFO(limit_row(limit).name << " " << edge << "\n" << allowed.text);
  CHECK(allowed.good);
  limits.*limit = edge - 1;
  const Outcome refused = outcome_of(text, limits);
  INFO(refused.text);
  CHECK_FALSE(refused.good);
  CHECK(refused.text.find("[" + code + "]") != std::string::npos);
}

const std::string kBall = R"({"type": "sphere", "radius": 1})";
std::string objects(const std::string& list, const std::string& more = "") {
  return R"({"version": 1, )" + more + R"("objects": [)" + list + "]}";
}

TEST_CASE("limits: each is refused beyond its edge", "[source][limits]") {
  const std::string ball = objects(kBall);
  check_edge(ball, &Limits::file_size, static_cast<double>(ball.size()), "E0008");
  check_edge(ball, &Limits::tokens, 10, "E0008");  // 3 brackets, 4 names, 3 values
  check_edge(ball, &Limits::nesting, 3, "E0008");
  check_edge("_0 var-x\n_1 square _0\n", &Limits::tokens, 5, "E0008");
  check_edge(objects(R"f({"type": "expression", "half_size": [1, 1, 1], "formula": "((x)) - 0.5"})f"),
             &Limits::formula_nesting, 2, "E0406");
  check_edge(objects(R"({"type": "expression", "half_size": [1, 1, 1], "formula": "x + y + z + x + y + z"})"),
             &Limits::nodes, 10, "E0312");
  check_edge(objects(kBall + ", " + R"({"type": "box", "half_size": [1, 1, 1]})"), &Limits::nodes, 5, "E0312");
  check_edge(objects(R"({"type": "repetition", "period": [1, 1, 1], "count": [3, 1, 1], "of": )" + kBall + "}"),
             &Limits::copies, 3, "E0312");
  check_edge(objects(R"({"type": "mandelbulb", "power": 8, "iterations": 9})"), &Limits::iterations, 9, "E0312");
  const std::string film = R"("film": {"width": 30, "height": 20}, "render": {"spp": 9}, )";
  check_edge(objects(kBall, film), &Limits::image_side, 30, "E0312");
  check_edge(objects(kBall, film), &Limits::pixels, 600, "E0312");
  check_edge(objects(kBall, film), &Limits::samples, 9, "E0312");
  check_edge(objects(R"({"type": "sphere", "radius": 1, "translate": [0, -1000, 0]})"), &Limits::coordinate, 1000,
             "E0301");
}

TEST_CASE("limits: the memory that a scene's nodes take", "[source][limits]") {
  const std::string two = objects(kBall + ", " + R"({"type": "box", "half_size": [1, 1, 1]})");
  check_edge(two, &Limits::memory, 5 * kBytesPerNode, "E0312");
}

// Each of three glass balls is cut by the balls before it: 2 + 4 + 6 nodes. A transform and a paint count one node
// each.
TEST_CASE("limits: the solids of transparent materials", "[source][limits]") {
  std::string materials, balls;
  for (int i = 0; i < 3; ++i) {
    materials += fmt::format(R"({}"g{}": {{"type": "transparent"}})", i == 0 ? "" : ", ", i);
    balls += fmt::format(R"({}{{"type": "sphere", "radius": {}, "material": "g{}"}})", i == 0 ? "" : ", ", i + 1, i);
  }
  check_edge(objects(balls, R"("materials": {)" + materials + "}, "), &Limits::media, 12, "E0312");
}

TEST_CASE("limits: the length of a program and its stack", "[source][limits]") {
  const std::string three = objects(kBall + R"(, {"type": "sphere", "radius": 2, "translate": [4, 0, 0]},
      {"type": "box", "half_size": [1, 2, 3], "translate": [0, 9, 0]})");
  Limits limits;
  int least = 0;
  for (limits.instructions = 1; limits.instructions < 30 && !outcome_of(three, limits).good; ++limits.instructions) {
    ++least;
  }
  CHECK(least >= 3);
  CHECK(least < 20);
  limits.instructions = least;
  CHECK(outcome_of(three, limits).text.find("more than") != std::string::npos);
  const std::string deep = objects(R"f({"type": "expression", "half_size": [1, 1, 1],
      "formula": "(x*y + y*z)*(x*z + z*z) - (x*x*y + y*y*z)*(x + y*(z + x*x))"})f");
  limits = {};
  CHECK(outcome_of(deep, limits).good);
  limits.stack = 1;
  const Outcome refused = outcome_of(deep, limits);
  CHECK(refused.text.find("values, and 1 are allowed") != std::string::npos);
  CHECK(refused.text.find("`--limit stack=") != std::string::npos);
}

TEST_CASE("limits: forty doublings of a node are forty nodes, and moved ones are refused before they are made",
          "[source][limits]") {
  std::string plain = R"("a0": )" + kBall, moved = plain;
  for (int i = 1; i <= 40; ++i) {
    plain +=
        fmt::format(R"(, "a{}": {{"type": "union", "of": [{{"use": "a{}"}}, {{"use": "a{}"}}]}})", i, i - 1, i - 1);
    moved += fmt::format(R"(, "a{0}": {{"type": "union", "of": [{{"use": "a{1}", "translate": [{0}, 0, 0]}},
        {{"use": "a{1}", "rotate": [0, {0}, 0]}}]}})",
                         i, i - 1);
  }
  const auto begin = std::chrono::steady_clock::now();
  const Outcome same = outcome_of(objects(R"({"use": "a40"})", R"("nodes": {)" + plain + "}, "), {});
  CHECK(same.good);
  CHECK(same.nodes <= 42);
  CHECK(same.instructions <= 42);
  const Outcome other = outcome_of(objects(R"({"use": "a40"})", R"("nodes": {)" + moved + "}, "), {});
  CHECK_FALSE(other.good);
  CHECK(other.text.find("scene.json:") != std::string::npos);
  CHECK(other.text.find("more than 1000000 instructions") != std::string::npos);
  CHECK(other.text.find("--limit instructions=2000000") != std::string::npos);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  CHECK(seconds.count() < 20);  // 2^40 would take days; hostile_test.cpp limits processor time
}

// The program of a formula is subject to the user's limits, too. Exceeding a limit is a user error, not an internal
// error.
TEST_CASE("limits: what a program remembers", "[source][limits]") {
  std::string list = "a0 var-x\nm0 var-y\n";
  for (int i = 0; i < 40; ++i) list += fmt::format("a{1} add a{0} m{0}\nm{1} sin a{0}\n", i, i + 1);
  Limits limits;
  limits.locals = 10;
  const Outcome refused = outcome_of(list, limits);
  INFO(refused.text);
  CHECK_FALSE(refused.good);
  CHECK(refused.text.find("values, and 10 are allowed") != std::string::npos);
  CHECK(refused.text.find("`--limit locals=") != std::string::npos);
  limits.locals = 100;
  CHECK(outcome_of(list, limits).good);
}

// Regression: the compiler built a list of operands for each union, as long as all unions before it.
TEST_CASE("limits: a chain of twenty thousand unions compiles to as many instructions", "[source][limits]") {
  std::string nodes = R"("a0": )" + kBall;
  for (int i = 1; i <= 20000; ++i) {
    nodes += fmt::format(R"(, "a{}": {{"type": "union", "of": [{{"use": "a{}"}},
        {{"type": "sphere", "radius": 1, "translate": [{}, 0, 0]}}]}})",
                         i, i - 1, 3 * i);
  }
  const Outcome chain = outcome_of(objects(R"({"use": "a20000"})", R"("nodes": {)" + nodes + "}, "), {});
  CHECK(chain.good);
  CHECK(chain.instructions <= 20002);
}

TEST_CASE("limits: docs/reference/limits.md is the table", "[source][limits]") {
  std::stringstream page;
  page << std::ifstream(std::string(FATHOM_SOURCE_DIR) + "/docs/reference/limits.md").rdbuf();
  const std::string text = page.str();
  std::size_t rows = 0;
  for (std::size_t at = text.find("\n| `"); at != text.npos; at = text.find("\n| `", at + 1)) ++rows;
  CHECK(rows == kLimits.size());
  for (const LimitRow& row : kLimits) {
    const double value = Limits{}.*row.value;
    const std::string line = fmt::format("| `{}` | {} | {:.15g} | {} | {} | {} |", row.name,
                                         value > 0 ? fmt::format("{:.15g}", value) : "3/4 of all", row.largest,
                                         row.unit, row.bounds, row.why);
    INFO(line);
    CHECK(text.find("\n" + line + "\n") != text.npos);
    CHECK(value <= row.largest);
  }
}

TEST_CASE("limits: how to allow more is a number that is easily read", "[source][limits]") {
  CHECK(raise(&Limits::nodes, 1234567) == "`--limit nodes=1300000` allows more");
  CHECK(raise(&Limits::nodes, 999999) == "`--limit nodes=1000000` allows more");
  CHECK(raise(&Limits::nodes, 1000000) == "`--limit nodes=1000000` allows more");
  CHECK(raise(&Limits::nodes, 1000001) == "`--limit nodes=1100000` allows more");
  CHECK(raise(&Limits::samples, 9) == "`--limit samples=9` allows more");
  CHECK(raise(&Limits::nesting, 5000) == "4096 levels are the most that can be: the stack's size");
}

}  // namespace

}  // namespace fathom::limits_test
