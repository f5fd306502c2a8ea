// Materials at points: evaluated textures, conversions, mixtures.
#include "runtime/material/material.h"

#include <cmath>
#include <string>

#include "runtime/material/pattern.h"
#include "tests/support/compiled.h"

namespace fathom::runtime::material_test {
namespace {

using compiler::CompiledScene;
using glm::dvec3;
using glm::vec3;
using Type = MaterialType;

CompiledScene scene_of(const std::string& material, const std::string& translate = "[0, 0, 0]") {
  return test::compiled(R"({"version": 1, "params": {"k": 2}, "materials": {"m": )" + material +
                        R"(}, "objects": [{"type": "sphere", "radius": 1, "material": "m", "translate": )" +
                        translate + "}]}");
}

// Returns the material of this text at a point of the scene.
MaterialPoint at(const std::string& material, dvec3 place) {
  const CompiledScene scene = scene_of(material);
  vm::Workspace workspace;
  return Materials(scene).at(0, place - scene.origin, place, workspace);
}

void check_same(const MaterialPoint& a, const MaterialPoint& b) {
  CHECK(a.type == b.type);
  CHECK(a.thin_walled == b.thin_walled);
  CHECK(a.base_color == b.base_color);
  CHECK(a.emission == b.emission);
#define PARAMETER(Type, member, ...) CHECK(a.member == b.member);
#define COMBINED(...)
#include "compiler/scene/material_parameters.def"
#include "tests/support/catch.h"
}

TEST_CASE("material: the default is OpenPBR's", "[material]") {
  MaterialPoint expected;
  expected.type = Type::Principled;
  check_same(at(R"({"type": "principled"})", dvec3(0)), expected);
}

TEST_CASE("material: base_weight and emission_luminance are multiplied in", "[material]") {
  const MaterialPoint m = at(R"({"type": "principled", "color": [0.8, 0.4, 0.2], "base_weight": 0.5,
    "emission": [1, 2, 4], "emission_luminance": 3})",
                             dvec3(0));
  CHECK(m.base_color == vec3(0.4f, 0.2f, 0.1f));
  CHECK(m.emission == vec3(3, 6, 12));
}

TEST_CASE("material: after transmission_depth transmission_color is left", "[material]") {
  const MaterialPoint m = at(R"({"type": "principled", "transmission": 1, "transmission_color": [0.5, 0.1, 1],
    "transmission_depth": 4})",
                             dvec3(0));
  CHECK(m.transmission_color == vec3(1));
  CHECK(std::exp(-4 * static_cast<double>(m.absorption.x)) == Approx(0.5).epsilon(1e-6));
  CHECK(std::exp(-4 * static_cast<double>(m.absorption.y)) == Approx(0.1).epsilon(1e-6));
  CHECK(m.absorption.z == 0);
  const MaterialPoint tint = at(R"({"type": "principled", "transmission_color": [0.5, 0.1, 1]})", dvec3(0));
  CHECK(tint.transmission_color == vec3(0.5f, 0.1f, 1));
  CHECK(tint.absorption == vec3(0));
  const MaterialPoint black =
      at(R"({"type": "principled", "transmission_color": 0, "transmission_depth": 1e-9})", dvec3(0));
  CHECK(std::isfinite(black.absorption.x));
  CHECK(black.absorption.x > 1e9f);
}

TEST_CASE("material: the plain types keep their meaning", "[material]") {
  const MaterialPoint glass =
      at(R"({"type": "transparent", "ior": 1.4, "color": 0.9, "absorption": [1, 2, 3]})", dvec3(0));
  CHECK(glass.type == Type::Transparent);
  CHECK(glass.base_color == vec3(0.9f));
  CHECK(glass.ior == 1.4f);
  CHECK(glass.absorption == vec3(1, 2, 3));
  const MaterialPoint lamp = at(R"({"type": "emissive", "emission": [4, 5, 6]})", dvec3(0));
  CHECK(lamp.emission == vec3(4, 5, 6));
  CHECK(lamp.base_color == vec3(0));
  CHECK(at(R"({"type": "diffuse"})", dvec3(0)).emission == vec3(0));
}

TEST_CASE("material: a formula is what it says in the scene's coordinates", "[material]") {
  const std::string text = R"~({"type": "diffuse", "color": ["0.5 + 0.25*sin(k*x)", 0.125, "x*y/z"]})~";
  for (const char* translate : {"[0, 0, 0]", "[100000, 3, 0]"}) {
    const CompiledScene scene = scene_of(text, translate);
    const Materials materials(scene);
    vm::Workspace workspace;
    CHECK(materials.is_textured(0));
    for (const dvec3 p : {dvec3(1, 0.25, 2), dvec3(100000.5, 0.001, 1000)}) {
      const vec3 color = materials.at(0, p - scene.origin, p, workspace).base_color;
      CHECK(static_cast<double>(color.x) == Approx(0.5 + 0.25 * std::sin(2 * p.x)).epsilon(1e-6));
      CHECK(color.y == 0.125f);
      CHECK(static_cast<double>(color.z) == Approx(p.x * p.y / p.z).epsilon(1e-6));
    }
  }
  CHECK(scene_of(text, "[100000, 3, 0]").origin != dvec3(0));
}

TEST_CASE("material: values out of range are clamped, what is no number is the stand-in", "[material]") {
  const std::string text = R"~({"type": "principled", "roughness": "x", "ior": "y", "color": "log(x)"})~";
  CHECK(at(text, {-3, 1, 0}).roughness == 0);
  CHECK(at(text, {3, 1, 0}).roughness == 1);
  CHECK(at(text, {0.25, 1.25, 0}).roughness == 0.25f);
  CHECK(at(text, {0.25, 1.25, 0}).ior == 1.25f);
  CHECK(at(text, {0.25, -5, 0}).ior == Approx(1e-3));
  CHECK(at(text, {0.25, 1, 0}).base_color == vec3(0));   // a negative colour
  CHECK(at(text, {-1, 1, 0}).base_color == vec3(0.8f));  // NaN
  CHECK(at(text, {100, 1, 0}).base_color == vec3(1));
}

TEST_CASE("material: patterns lie where scale, rotate and translate put them", "[material]") {
  const auto grey = [](const std::string& placement, dvec3 p) {
    return at(R"({"type": "diffuse", "color": {"pattern": "checker", "a": 0.25, "b": [0.75, 0.75, 0.75])" +
                  placement + "}}",
              p)
        .base_color.x;
  };
  CHECK(grey("", {0.5, 0.5, 0.5}) == 0.25f);
  CHECK(grey("", {1.5, 0.5, 0.5}) == 0.75f);
  CHECK(grey(R"(, "scale": 2)", {1.5, 0.5, 0.5}) == 0.25f);
  CHECK(grey(R"(, "scale": [4, 1, 1])", {3.5, 1.5, 0.5}) == 0.75f);
  CHECK(grey(R"(, "translate": [1, 0, 0])", {1.5, 0.5, 0.5}) == 0.25f);
  // A quarter turn about z moves the cube x in [0,1], y in [0,1] to x in [-1,0].
  CHECK(grey(R"(, "rotate": [0, 0, 90])", {-0.5, 0.5, 0.5}) == 0.25f);
  CHECK(grey(R"(, "rotate": {"axis": [0, 0, 1], "angle": 90})", {0.5, 0.5, 0.5}) == 0.75f);
}

TEST_CASE("material: patterns mix patterns", "[material]") {
  const std::string text = R"({"type": "principled", "metalness": {"pattern": "gradient", "to": [4, 0, 0], "a": 0.5,
    "b": {"pattern": "stripes", "axis": [0, 1, 0], "a": 0, "b": "z"}}})";
  CHECK(at(text, {-1, 0.25, 0}).metalness == 0.5f);
  CHECK(at(text, {1, 0.25, 0}).metalness == 0.375f);
  CHECK(at(text, {3, 0.75, 1}).metalness == 0.875f);
  CHECK(at(text, {9, 0.75, 0.5}).metalness == 0.5f);
}

TEST_CASE("material: noise is evaluated at the scene's own coordinates, whatever the origin", "[material]") {
  const std::string text = R"({"type": "diffuse", "color": {"pattern": "noise", "seed": 3, "a": 0, "b": 1}})";
  const CompiledScene far = scene_of(text, "[100000, 0, 0]"), near = scene_of(text);
  REQUIRE(far.origin != dvec3(0));
  vm::Workspace workspace;
  const dvec3 p(100000.375, 0.625, -0.25);
  const vec3 color = Materials(far).at(0, p - far.origin, p, workspace).base_color;
  CHECK(color == Materials(near).at(0, p, p, workspace).base_color);
  CHECK(static_cast<double>(color.x) == Approx(noise({4, 0.5, 2, 1, 3}, p)).epsilon(1e-6));
}

TEST_CASE("material: light and priority are known without a place", "[material]") {
  const CompiledScene scene = test::compiled(R"~({"version": 1, "materials": {
      "lamp": {"type": "emissive"}, "glow": {"type": "principled", "emission_luminance": "max(y, 0)"},
      "glass": {"type": "transparent", "priority": 4}},
    "objects": [{"type": "sphere", "radius": 1, "material": "lamp"},
      {"type": "sphere", "radius": 1, "translate": [3, 0, 0], "material": "glow"},
      {"type": "sphere", "radius": 1, "translate": [6, 0, 0], "material": "glass"}]})~");
  const Materials materials(scene);
  REQUIRE(materials.size() == 3);
  CHECK(materials.emits(0));
  CHECK(materials.emits(1));
  CHECK(!materials.emits(2));
  CHECK(materials.priority(2) == 4);
  CHECK(!materials.is_textured(0));
  CHECK(materials.is_textured(1));
  CHECK(materials.untextured(0).emission == vec3(1));
}

// One material of every type, with no parameter at its default.
std::vector<MaterialPoint> all_types() {
  std::vector<MaterialPoint> out;
  const char* texts[] = {R"({"type": "diffuse", "color": [0.1, 0.2, 0.3]})",
                         R"({"type": "emissive", "emission": [1, 2, 3], "color": 0.5})",
                         R"({"type": "specular", "color": [0.9, 0.8, 0.7]})",
                         R"({"type": "transparent", "ior": 1.3, "color": 0.9, "absorption": 0.2})",
                         R"({"type": "principled", "preset": "copper", "coat": 0.5, "coat_color": 0.5, "opacity": 0.5,
                             "coat_ior": 1.4, "coat_roughness": 0.1, "transmission": 0.25, "thin_walled": true,
                             "transmission_color": 0.3, "transmission_depth": 2, "diffuse_roughness": 0.1,
                             "specular_weight": 0.7, "emission": 2})"};
  for (const char* text : texts) out.push_back(at(text, dvec3(0)));
  return out;
}

TEST_CASE("material: a mixture begins with one and ends with the other", "[material]") {
  for (const MaterialPoint& a : all_types()) {
    for (const MaterialPoint& b : all_types()) {
      check_same(mix(a, b, 0), a);
      check_same(mix(a, b, 1), b);
      check_same(mix(a, b, NAN), a);
      const MaterialPoint m = mix(a, b, 0.25f), c = to_principled(a), d = to_principled(b);
      CHECK(m.type == (a.type == b.type ? a.type : Type::Principled));
      if (a.type == b.type) continue;
      CHECK(m.base_color.y == Approx(0.75f * c.base_color.y + 0.25f * d.base_color.y));
      CHECK(m.metalness == Approx(0.75f * c.metalness + 0.25f * d.metalness));
      CHECK(m.transmission == Approx(0.75f * c.transmission + 0.25f * d.transmission));
      CHECK(m.absorption.x == Approx(0.75f * c.absorption.x + 0.25f * d.absorption.x));
      CHECK(m.emission.z == Approx(0.75f * c.emission.z + 0.25f * d.emission.z));
      CHECK(m.opacity == Approx(m.has_interior() ? 1 : 0.75f * c.opacity + 0.25f * d.opacity));
    }
  }
}

TEST_CASE("material: every type can be principled", "[material]") {
  const std::vector<MaterialPoint> all = all_types();
  const MaterialPoint diffuse = to_principled(all[0]), lamp = to_principled(all[1]), mirror = to_principled(all[2]),
                      glass = to_principled(all[3]);
  for (const MaterialPoint& m : {diffuse, lamp, mirror, glass}) CHECK(m.type == Type::Principled);
  CHECK(diffuse.specular_weight == 0);
  CHECK(diffuse.metalness == 0);
  CHECK(diffuse.base_color == all[0].base_color);
  CHECK(lamp.emission == vec3(1, 2, 3));
  CHECK(mirror.metalness == 1);
  CHECK(mirror.roughness == 0);
  for (int i = 0; i < 3; ++i) {
    // F82 model: the tint times Schlick's approximation at 82 degrees is the mirror's own reflectance.
    const double f0 = static_cast<double>(mirror.base_color[i]), schlick = f0 + (1 - f0) * std::pow(6.0 / 7, 5);
    CHECK(static_cast<double>(mirror.specular_color[i]) * schlick == Approx(f0).epsilon(1e-6));
  }
  CHECK(glass.transmission == 1);
  CHECK(glass.roughness == 0);
  CHECK(glass.transmission_color == vec3(0.9f));
  CHECK(glass.absorption == vec3(0.2f));
  check_same(to_principled(all[4]), all[4]);
}

TEST_CASE("material: the albedo picture shows colour and light", "[material]") {
  const std::vector<MaterialPoint> all = all_types();
  CHECK(albedo_of(all[0]) == all[0].base_color);
  CHECK(albedo_of(all[1]) == vec3(1));
}

}  // namespace
}  // namespace fathom::runtime::material_test
