// The text of emitted code: names, comments about the scene, and length.
#include "compiler/emit/emit.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <variant>

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

// Ten thousand bodies were 27,962 lines.
TEST_CASE("bodies that repeat are a loop over rows of numbers", "[emit]") {
  std::string balls;
  for (int i = 0; i < 30; ++i)
    balls += fmt::format(R"({}{{"type": "sphere", "radius": 0.5, "translate": [{}, 0.5, {}]}})", i == 0 ? "" : ", ",
                         i, 2 * i);
  const compiler::CompiledScene scene = compiled_objects(balls);
  const std::string text = compiler::emit_glsl(scene, "many");
  CHECK(lines_of(text) < 60);
  CHECK(tail(text, "float many_distance").starts_with(R"(float many_distance(vec3 p) {
  float d1 = many_sphere(many_translate(p, 0.0, 0.5, 0.0), 0.5);
  float d2 = d1;
  for (int i = 0; i < 29; ++i) {
    float d3 = min(many_sphere(many_translate(p, many_row(2 * i), 0.5, many_row(2 * i + 1)), 0.5), d2);
    d2 = d3;
  }
  return d2;
}
)"));
  CHECK(lines_of(compiler::emit_cpp(scene, "many")) <
        lines_of(compiler::emit_cpp(compiled_objects(kTwoShapes), "two")) + 20);
}

// A loop took its value from an empty stack.
TEST_CASE("a body that repeats before the first value is no loop", "[emit]") {
  vm::Program program;
  for (int i = 0; i < 16; ++i) {
    program.append(vm::Opcode::Translate, 0, {0.1 * i, 0, 0}, {});
    program.append(vm::Opcode::Drop, 0, {}, {});
  }
  program.append(vm::Opcode::Sphere, 0, {0.5}, {});
  compiler::CompiledScene scene = compiled_objects(kTwoShapes);
  scene.distance = std::get<vm::VerifiedProgram>(vm::verify(program));
  CHECK(tail(compiler::emit_glsl(scene, "late"), "  return") == "  return d1;\n}\n");
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
      // No body repeats in Thue and Morse's sequence.
      const char* const shape = std::popcount(static_cast<unsigned>(i)) % 2 == 0
                                    ? R"("torus", "major_radius": {0}, "minor_radius": 0.1)"
                                    : R"("sphere", "radius": {0})";
      objects += i == 0 ? "" : ", ";
      objects += fmt::format(R"({{"type": {}, "translate": [{}, 0, 0]}})",
                             fmt::format(fmt::runtime(shape), 0.5 + 0.01 * i), i);
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
