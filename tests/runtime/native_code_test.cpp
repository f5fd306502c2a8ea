// Pictures do not depend on machine code.
#include <string>

#include "runtime/field/field.h"
#include "runtime/render.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/not_run.h"
#include "vm/native/native_program.h"

namespace fathom::test::native_code_test {
namespace {

// A formula, some convex shapes, and a glass ball, whose inside is a medium of its own.
const char* const kScenes[] = {
    R"J({"version": 1, "objects": [{"type": "expression", "formula": "x^2 + sin(3*y)/3 + abs(z)^1.5 - 0.7",
        "half_size": [1, 1, 1]}]})J",
    R"({"version": 1, "objects": [{"type": "sphere", "radius": 0.5, "translate": [0, 0.5, 0]}, {"type": "plane", "normal": [0, 1, 0]},
        {"type": "box", "half_size": [0.2, 0.5, 0.2], "translate": [0.8, 0.5, 0]}]})",
    R"({"version": 1, "materials": {"glass": {"type": "transparent", "ior": 1.5}}, "objects": [{"type": "plane", "normal": [0, 1, 0]},
        {"type": "sphere", "radius": 0.5, "translate": [0, 0.6, 0], "material": "glass"}]})"};

}  // namespace

TEST_CASE("native code leaves no trace in pictures", "[runtime][native][render]") {
  if (vm::NativeProgram::available().empty()) return not_run("this processor has no native code");
  for (const char* text : kScenes) {
    CAPTURE(text);
    const compiler::CompiledScene scene = compiled(text);
    runtime::RenderOptions options;
    options.width = 96, options.height = 64, options.spp = 8, options.threads = 2;
    options.native_code = false;
    const std::uint64_t expected = render(scene, options).film.hash();
    options.native_code = true;
    CHECK(render(scene, options).film.hash() == expected);
  }
}

TEST_CASE("a field has native code only for enough evaluations and without regions", "[runtime][native]") {
  const compiler::CompiledScene scene = compiled(kScenes[1]);
  runtime::Field field = runtime::make_field(scene);
  runtime::add_native_code(field, 100);
  CHECK(field.native.convex == nullptr);
  runtime::add_native_code(field, 1e9);
  CHECK((field.native.convex != nullptr) == !vm::NativeProgram::available().empty());
  CHECK(field.native.distance == nullptr);  // convex shapes march with their convexity radius
}

}  // namespace fathom::test::native_code_test
