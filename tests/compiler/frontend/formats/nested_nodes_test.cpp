#include "compiler/frontend/formats/nested_nodes.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/golden.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::nested_nodes_test {

namespace {

using namespace fathom;
using namespace fathom::compiler;
using fathom::test::compiled;
using glm::dvec3;
using nlohmann::json;

std::string molecule() {
  return test::read_file(std::filesystem::path(FATHOM_SOURCE_DIR) / "tests/data/molecule.json");
}

// Reference evaluator, modelled on the program that defines the format: a point passes through the matrices from the
// leaf to the root.
double plain(const json& node, dvec3 p, std::vector<std::array<double, 12>>& path) {
  path.push_back(node.at("matrix").get<std::array<double, 12>>());
  double d = 0;
  if (node.at("nodeType") == "primitive") {
    for (auto m = path.rbegin(); m != path.rend(); ++m) {
      const auto& a = *m;
      p = {a[0] * p.x + a[1] * p.y + a[2] * p.z + a[3], a[4] * p.x + a[5] * p.y + a[6] * p.z + a[7],
           a[8] * p.x + a[9] * p.y + a[10] * p.z + a[11]};
    }
    const std::string type = node.at("primitiveType");
    const double ring = std::hypot(p.x, p.z);
    if (type == "sphere") d = glm::length(p) - double(node.at("radius"));
    if (type == "cylinder") {
      const double u = ring - double(node.at("radius")), v = std::abs(p.y) - double(node.at("height")) / 2;
      d = std::min(std::max(u, v), 0.0) + std::hypot(std::max(u, 0.0), std::max(v, 0.0));
    }
    if (type == "cone") {
      const double radius = node.at("radius"), half = double(node.at("height")) / 2;
      const double x = ring - radius, y = p.y + half, ex = -radius, ey = 2 * half;
      const double t = std::clamp((x * ex + y * ey) / (ex * ex + ey * ey), 0.0, 1.0);
      const double qx = x - ex * t, qy = y - ey * t, slant = std::hypot(qx, qy);
      // The format's own formula is right inside and beside the cone. Below the base the disc is nearest.
      d = std::max(qx, qy) > 0 ? slant : -std::min(slant, y);
      if (y < 0) d = std::hypot(std::max(x, 0.0), y);
    }
    if (type == "box") {
      const double r = node.at("round_x");
      dvec3 q;
      for (int i = 0; i < 3; ++i)
        q[i] = std::abs(p[i]) - double(node.at("sides")[static_cast<std::size_t>(i)]) / 2 + r;
      d = glm::length(glm::max(q, dvec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0) - r;
    }
  } else {
    const double a = plain(node.at("leftChild"), p, path), k = node.at("blendRadius");
    double b = plain(node.at("rightChild"), p, path);
    const double s = node.at("blendMode") == "union" ? 1 : -1;
    if (node.at("blendMode") == "sub") b = -b;
    const double m = std::max(0.0, k - std::abs(a - b));
    d = s * (std::min(s * a, s * b) - (k == 0 ? 0 : m * m * 0.25 / k));
  }
  path.pop_back();
  return d;
}

double farthest(const std::string& text, int count) {
  const CompiledScene scene = compiled(text);
  const json model = json::parse(text);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> side(-1.5, 1.5);
  vm::Workspace workspace;
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double x = side(random), y = side(random);
    const dvec3 p(x, y, side(random));
    std::vector<std::array<double, 12>> path;
    worst = std::max(worst, std::abs(vm::evaluate_distance(scene.distance, p, workspace) - plain(model, p, path)));
  }
  return worst;
}

const char* const kTurn = "[0.8, 0.6, 0, 0.1, -0.6, 0.8, 0, -0.2, 0, 0, 1, 0.3]";
const char* const kHalfTurn = "[-1, 0, 0, 0.2, 0, 1, 0, 0, 0, 0, -1, 0]";
const char* const kMirror = "[1, 0, 0, 0.3, 0, 0, 1, 0.1, 0, 1, 0, 0]";

std::string primitive(const std::string& shape, const std::string& matrix, const std::string& color = "[1, 0, 0]") {
  return R"({"aabb_min": [-1, -1, -1], "aabb_max": [1, 1, 1], "nodeType": "primitive", "primitiveType": )" + shape +
         R"(, "matrix": )" + matrix + R"(, "color": )" + color +
         (shape.find("round_x") == std::string::npos ? R"(, "round_x": 0, "round_y": 0})" : "}");
}

std::string join(const std::string& mode, double k, const std::string& matrix, const std::string& left,
                 const std::string& right) {
  return fmt::format(R"({{"aabb_min": [-1, -1, -1], "aabb_max": [1, 1, 1], "nodeType": "binaryOperator", )"
                     R"("blendMode": "{}", "blendRadius": {}, "matrix": {}, "leftChild": {}, "rightChild": {}}})",
                     mode, k, matrix, left, right);
}

const char* const kSphere = R"("sphere", "radius": 0.5)";
const char* const kCylinder = R"("cylinder", "radius": 0.3, "height": 0.9)";
const char* const kCone = R"("cone", "radius": 0.4, "height": 0.8)";
const char* const kBox = R"("box", "sides": [0.6, 0.8, 1], "bevel": [0, 0, 0, 0])";
const char* const kRoundBox =
    R"("box", "sides": [0.6, 0.8, 1], "bevel": [0.1, 0.1, 0.1, 0.1], "round_x": 0.1, "round_y": 0.1)";

}  // namespace

TEST_CASE("primitives of nested nodes under every kind of matrix", "[frontend][import]") {
  for (const char* shape : {kSphere, kCylinder, kCone, kBox, kRoundBox}) {
    for (const char* matrix : {kTurn, kHalfTurn, kMirror}) {
      CAPTURE(shape, matrix);
      CHECK(farthest(primitive(shape, matrix), 500) < 1e-9);
    }
  }
}

TEST_CASE("operators of nested nodes, matrices within matrices", "[frontend][import]") {
  for (const char* mode : {"union", "sub", "inter"}) {
    for (const double k : {0.0, 0.2}) {
      CAPTURE(mode, k);
      const std::string pair = join(mode, k, kTurn, primitive(kSphere, kMirror), primitive(kBox, kTurn));
      CHECK(farthest(pair, 300) < 1e-9);
      CHECK(farthest(join(mode, k, kHalfTurn, pair, primitive(kCone, kTurn)), 300) < 1e-9);
      CHECK(farthest(join("union", 0.1, kTurn, primitive(kCylinder, kTurn), pair), 300) < 1e-9);
    }
  }
}

TEST_CASE("colours are materials", "[frontend][import]") {
  const CompiledScene scene =
      compiled(join("union", 0.1, kTurn, primitive(kSphere, kTurn), primitive(kSphere, kMirror, "[0, 0.5, 1]")));
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[0].color == dvec3(1, 0, 0));
  CHECK(scene.materials[1].color == dvec3(0, 0.5, 1));
  CHECK(scene.surfaces.size() == 2);
}

TEST_CASE("the molecule is what its file says", "[frontend][import]") {
  // Chains of 1000 blends: the reference sums them in another form.
  CHECK(farthest(molecule(), test::scaled_cases(200)) < 1e-6);
  const CompiledScene scene = compiled(molecule());
  CHECK(scene.surfaces.size() == 1);
  CHECK(scene.lipschitz < 1.001);
}

TEST_CASE("nested nodes written as a scene are the same scene", "[frontend][import]") {
  // Chains whose right operand is the rest, with changing blend widths, become named parts.
  std::string deep = primitive(kSphere, kTurn);
  for (int i = 0; i < 1300; ++i) {
    const std::string leaf = primitive(i % 2 == 0 ? kSphere : kBox, kMirror);
    const double k = 0.01 + 0.001 * (i % 3);
    deep = i % 5 == 0 ? join("union", k, "[1, 0, 0, 0.001, 0, 1, 0, 0, 0, 0, 1, 0]", deep, leaf)
                      : join("inter", k, "[1, 0, 0, 0, 0, 1, 0, 0.001, 0, 0, 1, 0]", leaf, deep);
  }
  CHECK(farthest(deep, 20) < 1e-6);
  for (const std::string& text : {molecule(), deep}) {
    std::string written, again;
    const CompiledScene direct = compiled(text, written);
    const CompiledScene imported = compiled(written, again);
    CHECK(written == again);
    CHECK(imported.summary == direct.summary);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> side(-1.5, 1.5);
    vm::Workspace workspace;
    for (int i = 0; i < 500; ++i) {
      const double x = side(random), y = side(random);
      const dvec3 p(x, y, side(random));
      REQUIRE(vm::evaluate_distance(imported.distance, p, workspace) ==
              vm::evaluate_distance(direct.distance, p, workspace));
    }
  }
}

}  // namespace fathom::nested_nodes_test
