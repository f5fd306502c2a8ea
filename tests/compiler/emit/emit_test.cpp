// The text of emitted code: names, comments about the scene, and length.
#include "compiler/emit/emit.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::test::emit_test {
namespace {

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Returns the text from the last line that begins with `begin`.
std::string tail(const std::string& text, const std::string& begin) {
  const std::size_t at = text.rfind('\n' + begin);
  REQUIRE(at != text.npos);
  return text.substr(at + 1);
}

constexpr const char* kTwoShapes =
    R"({"name": "ball", "type": "sphere", "radius": 0.9, "translate": [1, 2, 3]}, {"type": "box", "half_size": [0.7, 0.8, 0.6]})";

}  // namespace

TEST_CASE("emitted GLSL reads as one writes it", "[emit]") {
  CHECK(tail(compiler::emit_glsl(compiled_objects(kTwoShapes), "two"), "float two_sphere") ==
        R"(float two_sphere(vec3 p, float radius) {
  return length(vec3(p.x, p.y, p.z)) - radius;
}
float two_box(vec3 p, float x, float y, float z) {
  float t1 = abs(p.x) - x;
  float t2 = abs(p.y) - y;
  float t3 = abs(p.z) - z;
  return length(vec3(max(t1, 0.0), max(t2, 0.0), max(t3, 0.0))) + min(max(max(t3, t2), t1), 0.0);
}

float two_distance(vec3 p) {
  float d1 = two_sphere(two_translate(p, 1.0, 2.0, 3.0), 0.9);  // sphere "ball"
  float d2 = min(two_box(p, 0.7, 0.8, 0.6), d1);
  return d2;
}
)");
}

TEST_CASE("emitted GLSL tells surfaces apart", "[emit]") {
  CHECK(tail(compiler::emit_glsl(compiled_objects(kTwoShapes), "two", true), "int two_surface") ==
        R"(int two_surface(vec3 p) {
  float d1 = two_sphere(two_translate(p, 1.0, 2.0, 3.0), 0.9);  // sphere "ball"
  float d2 = two_box(p, 0.7, 0.8, 0.6);
  float d3 = min(d2, d1);
  int s1 = d1 < d2 ? 0 : d2 < d1 ? 1 : min(0, 1);
  return s1;
}
)");
}

TEST_CASE("emitted C++ reads as one writes it", "[emit]") {
  CHECK(tail(compiler::emit_cpp(compiled_objects(kTwoShapes), "two"), "static FATHOM_SCENE_INLINE T distance") ==
        R"(static FATHOM_SCENE_INLINE T distance([[maybe_unused]] vec3 p) {
  const T d1 = sphere(translate(p, 1, 2, 3), 0.9);  // sphere "ball"
  const T d2 = min(d1, box(p, 0.7, 0.8, 0.6));
  return d2;
}
};

template <class T>
FATHOM_SCENE_INLINE T distance(T x, T y, T z) {
  return Scene<T>::distance({x, y, z});
}

}  // namespace two

#endif
)");
}

TEST_CASE("a name cannot lengthen its comment", "[emit]") {
  const auto scene = compiled_objects(R"({"name": "\\ \u00e9 ??/", "type": "sphere", "radius": 1})");
  const std::string text = compiler::emit_glsl(scene, "scene");
  CAPTURE(text);
  CHECK(text.find("// sphere \". .. ../\"\n") != std::string::npos);
}

TEST_CASE("emitted code grows with the program and has each function once", "[emit]") {
  const auto lines = [](int count) {
    std::string objects;
    for (int i = 0; i < count; ++i) {
      objects += fmt::format(R"({}{{"type": "torus", "major_radius": {}, "minor_radius": 0.1, "translate": [{}, 0, 0]}})",
                             i == 0 ? "" : ", ", 0.5 + 0.01 * i, i);
    }
    return lines_of(compiler::emit_cpp(compiled_objects(objects), "tori"));
  };
  CHECK(lines(60) - lines(10) == 50);
}

TEST_CASE("an emitted function takes places of the scene", "[emit]") {
  const auto scene = fathom::test::compiled(
      R"({"version": 1, "camera": {}, "objects": [{"type": "sphere", "radius": 1, "translate": [30000, 0, 0]}]})");
  REQUIRE(scene.origin == glm::dvec3(30000, 0, 0));
  CHECK(compiler::emit_glsl(scene, "scene").find("vec3 q = scene_translate(p, 30000.0, 0.0, 0.0);") !=
        std::string::npos);
}

TEST_CASE("names that a language does not allow are refused", "[emit]") {
  for (const char* good : {"a", "a1", "wall::door", "_x"}) CHECK(compiler::problem_with_namespace(good).empty());
  for (const char* bad : {"", "1a", "a b", "a::", "::a", "a:b", "a__b", "ä"}) {
    CHECK_FALSE(compiler::problem_with_namespace(bad).empty());
  }
  for (const char* good : {"a", "wall_1"}) CHECK(compiler::problem_with_glsl_name(good).empty());
  for (const char* bad : {"", "1a", "a::b", "gl_a", "a__b", "a_"}) {
    CHECK_FALSE(compiler::problem_with_glsl_name(bad).empty());
  }
}

}  // namespace fathom::test::emit_test
