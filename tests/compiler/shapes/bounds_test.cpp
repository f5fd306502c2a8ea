// The compiler's bounds of float errors and operator norms. Boxes and Lipschitz constants are in passes_test.cpp.
#include "compiler/shapes/bounds.h"

#include <cmath>

#include "compiler/geometry/affine.h"
#include "runtime/field/field.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/random/random_scene.h"
#include "vm/interpret/evaluate.h"

namespace fathom::bounds_test {

namespace {

using namespace fathom;
using fathom::test::compiled_objects;

// Max |float - double| relative to d_f, at random points near the surface within `size` of the origin.
double largest_error(const compiler::CompiledScene& scene, double size) {
  const runtime::Field field = runtime::make_field(scene);
  test::Random random(1);
  vm::Workspace workspace;
  double largest = 0;
  for (int i = 0; i < 3000; ++i) {
    const float x = static_cast<float>(random.uniform(-size, size)),
                z = static_cast<float>(random.uniform(-size, size));
    float y = 0;
    for (int step = 0; step < 8; ++step) {  // moves the point vertically onto the surface
      const double d = vm::evaluate_distance(scene.distance, glm::dvec3(x, y, z), workspace);
      y = static_cast<float>(y - d);
    }
    float d;
    vm::evaluate_distance(scene.distance, {&x, &y, &z}, 1, &d, workspace);
    const double exact = vm::evaluate_distance(scene.distance, glm::dvec3(x, y, z), workspace);
    const double allowed = static_cast<double>(runtime::distance_error(field, x, y, z, d));
    largest = std::max(largest, std::abs(static_cast<double>(d) - exact) / allowed);
  }
  return largest;
}

}  // namespace

// Regression: d_f depended on the ray's coordinates alone and was a thousand times too small where large numbers
// cancel.
TEST_CASE("d_f holds where large numbers cancel", "[shapes][bounds]") {
  for (const char* r : {"1", "100", "10000", "1000000"}) {
    const std::string s(r);
    CAPTURE(s);
    CHECK(largest_error(
              compiled_objects(R"({"type": "sphere", "radius": )" + s + R"(, "translate": [0, -)" + s + ", 0]}"),
              3) <= 1);
    CHECK(largest_error(compiled_objects(R"({"type": "union", "translate": [-)" + s + R"(, 0, 0], "of": [
        {"type": "box", "half_size": [3, 1, 3], "translate": [)" +
                                         s + R"(, -1, 0]}, {"type": "sphere", "radius": 1}]})"),
                        2) <= 1);
    CHECK(largest_error(compiled_objects(R"({"type": "round", "radius": )" + s +
                                         R"(, "of": {"type": "sphere", "radius": 1,
        "translate": [0, -)" + s + R"(, 0]}})"),
                        2) <= 1);
    CHECK(largest_error(compiled_objects(R"({"type": "smooth_union", "k": )" + s + R"(, "of": [
        {"type": "plane", "normal": [0, 1, 0]}, {"type": "plane", "normal": [0.1, 1, 0]}]})"),
                        2) <= 1);
    CHECK(largest_error(compiled_objects(R"({"type": "sphere", "radius": 1, "scale": )" + s +
                                         R"(, "translate": [0, -)" + s + ", 0]}"),
                        2) <= 1);
  }
}

// Regression: a light far away would have made every distance look uncertain.
TEST_CASE("what is far away costs nothing here", "[shapes][bounds]") {
  CHECK(compiled_objects(
            R"({"type": "sphere", "radius": 2, "translate": [0, 1000, 0]}, {"type": "sphere", "radius": 1})")
            .cancellation <= 2);
  CHECK(compiled_objects(R"({"type": "box", "half_size": [1000, 0.1, 1000], "translate": [0, -0.1, 0]})")
            .cancellation <= 0.1);
}

// Regression: the smallest singular value was computed from squares and lost its digits next to a large one.
TEST_CASE("stretches of nested scales", "[shapes][bounds]") {
  for (const double b : {1.0, 1e2, 1e4, 1e6}) {
    using glm::dvec3;
    const double c = std::sqrt(0.5);
    const compiler::Affine first{{dvec3(b, 0, 0), dvec3(0, 1 / b, 0), dvec3(0, 0, 1)}, dvec3(0)};
    const compiler::Affine turn{{dvec3(c, -c, 0), dvec3(c, c, 0), dvec3(0, 0, 1)}, dvec3(1, 2, 3)};
    const compiler::SingularValues s = compiler::singular_values(compiler::compose(turn, first));
    CAPTURE(b);
    CHECK(s.most == Approx(b).epsilon(1e-9));
    CHECK(s.least == Approx(1 / b).epsilon(1e-9));
  }
}

}  // namespace fathom::bounds_test
