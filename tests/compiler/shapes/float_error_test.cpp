// Float errors of shapes and alterations of any proportion, compared with the compiler's bound. Near the surface the
// error is at most kFloatError * (max(1, |p|, |d|) + cancellation) (compiler/graph/node_facts.h).
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "compiler/lower/lower.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/make_node.h"
#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::float_error_test {
namespace {

using compiler::Kind;
using compiler::NodeId;
using compiler::NodeMaker;
using compiler::ParamType;
using compiler::Scene;
using compiler::Sort;
using glm::dvec3;

// Random parameters with each length scaled on its own by up to 10^4: fat rings, needles, wide floors. Returns
// nullopt when the lengths no longer fit together.
std::optional<std::vector<double>> stretched(Kind kind, Random& random) {
  const compiler::NodeSpec& row = compiler::spec(kind);
  std::vector<double> params = random_params(kind, random);
  const auto singular_values = [&](double& length) {
    if (random.chance(0.5)) length = static_cast<float>(length * std::pow(10.0, random.uniform(0, 4)));
  };
  if (kind == Kind::Quad) {  // its corners must stay in a plane
    const double factor = std::exp2(random.below(14));
    for (double& length : params) length *= factor;
    return params;
  }
  std::size_t next = 0;
  for (const compiler::ParamSpec& spec : row.params) {
    const bool points = spec.type == ParamType::Points;
    const std::size_t end = points ? params.size() : next + static_cast<std::size_t>(compiler::width(spec.type));
    const bool length = spec.type != ParamType::Integer && spec.name != "angle" && spec.name != "normal";
    for (; next < end; ++next) {
      if (length) singular_values(params[next]);
    }
  }
  if (row.check && row.check(params)) return std::nullopt;
  return params;
}

// Max error at points near the surface, relative to the allowed error. Returns 0 when the program's numbers do not
// fit into float.
double largest_error(const Scene& scene, bool flat, Random& random, int points) {
  auto result = vm::verify(*compiler::lower(scene, compiler::Source("", ""), 1'000'000));
  const auto* program = std::get_if<vm::VerifiedProgram>(&result);
  if (program == nullptr) return 0;
  const double cancellation = compiler::analyse(scene.graph)[scene.root].cancellation;
  CHECK(std::isfinite(cancellation));
  vm::Workspace workspace;
  double largest = 0;
  for (int i = 0; i < points; ++i) {
    dvec3 p = random.in_box(std::pow(10.0, random.uniform(-1, 4.5)));
    for (int step = 0; step < 6; ++step) {
      if (flat) p.z = 0;
      const vm::SurfaceValue value = vm::evaluate_surface(*program, p, workspace);
      p -= value.distance * value.gradient / std::max(1.0, glm::dot(value.gradient, value.gradient));
    }
    p += random.direction() * random.uniform(0, 0.1);
    if (flat) p.z = 0;
    const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
    if (!std::isfinite(x + y + z)) continue;
    p = dvec3(x, y, z);
    float narrow;
    vm::evaluate_distance(*program, {&x, &y, &z}, 1, &narrow, workspace);
    const double doubles = vm::evaluate_distance(*program, p, workspace);
    const double allowed = vm::kFloatError * (std::max({1.0, glm::length(p), std::abs(doubles)}) + cancellation);
    largest = std::max(largest, std::abs(static_cast<double>(narrow) - doubles) / allowed);
  }
  return largest;
}

}  // namespace

// Regression: the cancellation of fat rings, needle triangles and long stars ignored the far corners that their code
// computes from.
TEST_CASE("float errors of shapes of any proportion are within the bound", "[shapes][bounds]") {
  for (const Sort sort : {Sort::Solid, Sort::Outline}) {
    for (const Kind kind : primitive_kinds(sort, false)) {
      int tried = 0;
      for (int seed = 0; seed < scaled_cases(600); ++seed) {
        Random random(seed);
        const auto params = stretched(kind, random);
        if (!params) continue;
        ++tried;
        INFO(compiler::spec(kind).name << ", seed " << seed);
        CHECK(largest_error(single(kind, *params), sort == Sort::Outline, random, 20) <= 1);
      }
      CHECK(tried > scaled_cases(50));
    }
  }
}

// Regression: these nodes move a child in from far away, but their cancellation did not include the distance.
TEST_CASE("float errors of what brings a child from far off are within the bound", "[shapes][bounds]") {
  Random random(1);
  for (const double far : {1.0, 1e3, 1e6}) {
    INFO("from " << far);
    const auto check = [&](Kind kind, const std::vector<double>& params, Kind shape, const std::vector<double>& of) {
      Scene scene;
      NodeMaker maker(scene.graph);
      const NodeId child[] = {maker.make(shape, of, {})};
      REQUIRE(!maker.complaint(kind, params, child));
      scene.root = maker.make(kind, params, child);
      INFO(compiler::spec(kind).name);
      CHECK(largest_error(scene, false, random, scaled_cases(3000)) <= 1);
    };
    check(Kind::Revolve, {-far}, Kind::Polygon, {far + 1.25, 0, far + 2.75, 0, far + 2, 1});
    check(Kind::Mirror, {1, 0, 0, far}, Kind::Triangle,
          {2 * far - 1.25, 0, 0, 2 * far - 3, 0, 0.25, 2 * far - 2, 1, 0, 0.125});
    check(Kind::Taper, {1 / far, 1 / far, 1}, Kind::Cylinder, {far, 0.125});
    check(Kind::Taper, {1 / far, 1 / far, 1}, Kind::InfiniteCylinder, {far});
    check(Kind::Extrude, {1}, Kind::IsoscelesTriangle, {far, far});
    if (far > 1e3) continue;  // too many copies would count
    const double beside = 0.25 * far / 10;
    check(Kind::Repetition, {1, 0, 0, 0, 0, 0, 0, 0, 0}, Kind::Triangle,
          {beside, 0, 0, beside + 0.25, 0, 0, beside, 0.25, 0.125, 0.125});
  }
}

// Regression: the tube around a twist or taper touched the solid's own edges, where the tube's distance, many times
// as steep, entered the result.
TEST_CASE("float errors of twisted and tapered edges are within the bound", "[shapes][bounds]") {
  for (const auto& [kind, params] : {std::pair(Kind::Taper, std::vector<double>{0.3, 1, 0.001}),
                                     std::pair(Kind::Twist, std::vector<double>{2000})}) {
    Scene scene;
    NodeMaker maker(scene.graph);
    const NodeId child[] = {maker.make(Kind::Box, {{1.0, 1.0, 1.0}}, {})};
    scene.root = maker.make(kind, params, child);
    auto verified = vm::verify(*compiler::lower(scene, compiler::Source("", ""), 1000));
    const vm::VerifiedProgram& program = std::get<vm::VerifiedProgram>(verified);
    const double cancellation = maker.known(scene.root).cancellation;
    vm::Workspace workspace;
    Random random(1);
    for (int i = 0; i < 4000; ++i) {
      const double y = random.uniform(-0.999, 0.999);
      const double angle = kind == Kind::Twist ? params[0] * y * std::numbers::pi / 180 : 0;
      const double scale = kind == Kind::Taper ? std::clamp(0.65 + 350 * y, 0.3, 1.0) : 1;
      const double x = (std::cos(angle) - std::sin(angle)) * scale, z = (std::sin(angle) + std::cos(angle)) * scale;
      const float px = static_cast<float>(x), py = static_cast<float>(y), pz = static_cast<float>(z);
      const double doubles = vm::evaluate_distance(program, dvec3(px, py, pz), workspace);
      float narrow;
      vm::evaluate_distance(program, {&px, &py, &pz}, 1, &narrow, workspace);
      INFO(compiler::spec(kind).name << " at " << px << ' ' << py << ' ' << pz << ": " << doubles << ' ' << narrow);
      const double size = std::max({1.0, std::hypot(x, y, z), std::abs(doubles)});
      CHECK(std::abs(static_cast<double>(narrow) - doubles) <= vm::kFloatError * (size + cancellation));
    }
  }
}

}  // namespace fathom::test::float_error_test
