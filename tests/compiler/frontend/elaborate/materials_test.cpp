// Materials as the front end reads them: OpenPBR's names and defaults, presets, textures.
#include "compiler/frontend/elaborate/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <map>
#include <set>
#include <sstream>
#include <type_traits>

#include "compiler/frontend/records/material_presets.h"
#include "compiler/frontend/records/records.h"
#include "tests/compiler/frontend/elaborate/elaborated.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"

namespace fathom::materials_test {

namespace {

using namespace fathom::compiler;
using fathom::test::of_objects;

ElaboratedScene scene_of(const std::string& material, const std::string& params = "{}") {
  return of_objects(R"({"type": "sphere", "radius": 1, "material": "m"})",
                    R"(, "params": )" + params + R"(, "materials": {"m": )" + material + "}");
}
Material material_of(const std::string& material) {
  const ElaboratedScene scene = scene_of(material);
  CHECK(scene.textures.empty());
  return scene.materials[0];
}

glm::dvec3 value_of(const MaterialNumbers& numbers, const MaterialParameter& row) {
  return std::visit([&](auto member) { return glm::dvec3(numbers.*member); }, row.member);
}

void check_same_numbers(const MaterialNumbers& a, const MaterialNumbers& b) {
  for (const MaterialParameter& row : kMaterialParameters) {
    CAPTURE(row.name);
    CHECK(value_of(a, row) == value_of(b, row));
  }
}

// Returns a valid value of the parameter that is not its default.
double another_value(const MaterialParameter& row) {
  return row.domain == ParameterDomain::Share ? 0.5 + row.value / 4 : 2 + row.value;
}

TEST_CASE("materials: a row of the table has a member, a property and its short name", "[frontend][material]") {
  for (const MaterialParameter& row : kMaterialParameters) {
    CAPTURE(row.name);
    CHECK(value_of(MaterialNumbers(), row) == glm::dvec3(row.value));
    CHECK(&parameter_of(row.member) == &row);
    for (const std::string_view property : {row.property, row.alias}) {
      if (property.empty()) continue;
      const double value = another_value(row);
      MaterialNumbers expected;
      std::visit([&](auto member) { expected.*member = std::decay_t<decltype(expected.*member)>(value); },
                 row.member);
      if (row.property == "emission_color") expected.emission_luminance = 1;
      check_same_numbers(material_of(fmt::format(R"({{"type": "principled", "{}": {}}})", property, value)),
                         expected);
    }
  }
}

struct DocumentedProperty {
  std::string alias, fallback;
};

// Returns the rows of the table of principled materials in docs/reference/materials.md.
std::map<std::string, DocumentedProperty> documented_properties() {
  std::istringstream page(test::read_file(FATHOM_SOURCE_DIR "/docs/reference/materials.md"));
  std::string line;
  while (std::getline(page, line) && line != "| property | short | default | meaning |") continue;
  std::getline(page, line);
  std::map<std::string, DocumentedProperty> rows;
  while (std::getline(page, line) && line.starts_with("| `")) {
    std::erase_if(line, [](char c) { return c == ' ' || c == '`'; });
    std::istringstream row(line.substr(1));
    std::string name, alias, fallback;
    std::getline(std::getline(std::getline(row, name, '|'), alias, '|'), fallback, '|');
    CHECK(rows.try_emplace(name, DocumentedProperty{alias, fallback}).second);
  }
  return rows;
}

TEST_CASE("materials: docs/reference/materials.md has the properties of principled materials and their defaults",
          "[frontend][material]") {
  std::map<std::string, DocumentedProperty> documented = documented_properties();
  const RecordSpec& principled = material_records().back();
  std::map<std::string_view, std::string_view> aliases;
  for (const PropertySpec& row : principled.properties) {
    if (!row.alias_of.empty()) aliases[row.alias_of] = row.name;
  }
  for (const PropertySpec& row : principled.properties) {
    if (!row.alias_of.empty() || row.name == "type" || row.name == "space") continue;
    CAPTURE(row.name);
    const auto found = documented.extract(std::string(row.name));
    REQUIRE(!found.empty());
    const auto& [alias, fallback] = found.mapped();
    CHECK(alias == aliases[row.name]);
    if (!row.fallback.empty()) CHECK(fallback.substr(0, fallback.find(',')) == fmt::format("{}", row.fallback[0]));
  }
  CHECK(documented.empty());
}

TEST_CASE("materials: without properties a principled one has OpenPBR's defaults", "[frontend][material]") {
  const Material m = material_of(R"({"type": "principled"})");
  CHECK(m.type == Material::Type::Principled);
  check_same_numbers(m, MaterialNumbers());
  CHECK(m.color == glm::dvec3(0.8));
  CHECK(m.roughness == 0.3);
  CHECK(m.coat_ior == 1.6);
  CHECK(!m.thin_walled);
  CHECK(m.priority == 0);
  CHECK(!emits(m));
}

TEST_CASE("materials: full names and short ones are the same", "[frontend][material]") {
  const Material full = material_of(R"({"type": "principled", "base_color": [0.1, 0.2, 0.3], "base_metalness": 0.4,
    "base_diffuse_roughness": 0.5, "specular_roughness": 0.6, "specular_ior": 1.7, "transmission_weight": 0.8,
    "coat_weight": 0.9, "emission_color": [1, 2, 3], "geometry_opacity": 0.25, "geometry_thin_walled": true})");
  const Material brief = material_of(R"({"type": "principled", "color": [0.1, 0.2, 0.3], "metalness": 0.4,
    "diffuse_roughness": 0.5, "roughness": 0.6, "ior": 1.7, "transmission": 0.8, "coat": 0.9, "emission": [1, 2, 3],
    "opacity": 0.25, "thin_walled": true})");
  check_same_numbers(full, brief);
  CHECK(full.color == glm::dvec3(0.1, 0.2, 0.3));
  CHECK(full.opacity == 0.25);
  CHECK(full.thin_walled);
  CHECK(brief.thin_walled);
}

TEST_CASE("materials: light is emission_color times emission_luminance", "[frontend][material]") {
  const auto radiance = [](const std::string& properties) {
    const Material m = material_of(R"({"type": "principled")" + properties + "}");
    CHECK(emits(m) == (m.emission * m.emission_luminance != glm::dvec3(0)));
    return m.emission * m.emission_luminance;
  };
  CHECK(radiance("") == glm::dvec3(0));
  CHECK(radiance(R"(, "emission": [1, 2, 3])") == glm::dvec3(1, 2, 3));
  CHECK(radiance(R"(, "emission_luminance": 5)") == glm::dvec3(5));
  CHECK(radiance(R"(, "emission": [1, 2, 3], "emission_luminance": 2)") == glm::dvec3(2, 4, 6));
  CHECK(radiance(R"(, "emission": [1, 2, 3], "emission_luminance": 0)") == glm::dvec3(0));
}

TEST_CASE("materials: gold reflects as its refractive index says, and what is given goes first",
          "[frontend][material]") {
  const Material gold = material_of(R"({"type": "principled", "preset": "gold"})");
  CHECK(gold.metalness == 1);
  CHECK(gold.roughness == 0.3);
  // Reflectance at normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
  CHECK(gold.color.x == Approx(0.945).margin(2e-3));
  CHECK(gold.color.y == Approx(0.776).margin(2e-3));
  CHECK(gold.color.z == Approx(0.373).margin(2e-3));
  CHECK(gold.specular_color.x == Approx(0.9831).margin(1e-3));  // Fresnel's 0.954 over Schlick's 0.971
  const Material chromium = material_of(R"({"type": "principled", "preset": "chrome"})");
  CHECK(chromium.specular_color.x == Approx(0.7288).margin(1e-3));
  const Material painted = material_of(R"({"type": "principled", "preset": "gold", "color": 0.5, "roughness": 0.1})");
  CHECK(painted.color == glm::dvec3(0.5));
  CHECK(painted.roughness == 0.1);
  CHECK(painted.metalness == 1);
  CHECK(painted.specular_color == gold.specular_color);
  const Material water = material_of(R"({"type": "principled", "preset": "water", "priority": 3})");
  CHECK(water.ior == 1.333);
  CHECK(water.transmission == 1);
  CHECK(water.roughness == 0);
  CHECK(water.priority == 3);
}

TEST_CASE("materials: presets are known properties within their ranges", "[frontend][material]") {
  std::set<std::string_view> names;
  const RecordSpec& row = material_records().back();
  for (const MaterialPreset& preset : material_presets()) {
    CAPTURE(std::string(preset.name));
    CHECK(names.insert(preset.name).second);
    for (const auto& [property, value] : preset.values) {
      const PropertySpec* spec = row.find(property);
      REQUIRE(spec != nullptr);
      CHECK(spec->alias_of.empty());
      CHECK(glm::all(glm::greaterThanEqual(value, glm::dvec3(std::max(0.0, spec->range.least)))));
      CHECK(glm::all(glm::lessThanEqual(value, glm::dvec3(spec->range.most))));
    }
  }
}

TEST_CASE("materials: a conductor's reflectance is Fresnel's", "[frontend][material]") {
  // Without absorption the formula is a dielectric's: glass reflects 4 % at normal incidence and everything at
  // grazing incidence.
  CHECK(conductor_reflectance(1, 1.5, 0) == Approx(0.04));
  CHECK(conductor_reflectance(0, 1.5, 0) == Approx(1));
  // At Brewster's angle, tan = n, only the perpendicular half reflects: ((n^2 - 1) / (n^2 + 1))^2.
  CHECK(conductor_reflectance(1 / std::sqrt(1 + 1.5 * 1.5), 1.5, 0) ==
        Approx(0.5 * std::pow((1.5 * 1.5 - 1) / (1.5 * 1.5 + 1), 2)));
  CHECK(conductor_reflectance(1, 0.2, 3) == Approx((0.64 + 9) / (1.44 + 9)));
}

TEST_CASE("materials: the four plain types read as before", "[frontend][material]") {
  CHECK(material_of(R"({"type": "diffuse", "color": [0.1, 0.2, 0.3]})").color == glm::dvec3(0.1, 0.2, 0.3));
  const Material lamp = material_of(R"({"type": "emissive"})");
  CHECK(lamp.emission == glm::dvec3(1));
  CHECK(lamp.color == glm::dvec3(0));
  CHECK(emits(lamp));
  CHECK(material_of(R"({"type": "specular"})").color == glm::dvec3(1));
  const Material glass = material_of(R"({"type": "transparent", "absorption": 0.5, "priority": -2})");
  CHECK(glass.type == Material::Type::Transparent);
  CHECK(glass.absorption == glm::dvec3(0.5));
  CHECK(glass.priority == -2);
}

TEST_CASE("materials: what does not vary is a number", "[frontend][material]") {
  CHECK(
      material_of(R"({"type": "diffuse", "color": {"pattern": "checker", "a": 0.5, "b": [0.5, 0.5, 0.5]}})").color ==
      glm::dvec3(0.5));
  CHECK(material_of(R"({"type": "principled", "roughness": "1/4"})").roughness == 0.25);
  const ElaboratedScene scene = scene_of(R"({"type": "diffuse", "color": ["r", 0.5, "2*r"]})", R"({"r": 0.25})");
  CHECK(scene.textures.empty());
  CHECK(scene.materials[0].color == glm::dvec3(0.25, 0.5, 0.5));
}

TEST_CASE("materials: patterns become textures, ends first", "[frontend][material]") {
  const ElaboratedScene scene = scene_of(R"({"type": "principled", "roughness":
      {"pattern": "stripes", "axis": [0, 0, 3], "width": 0.25, "scale": 2, "a": 0.2,
       "b": {"pattern": "noise", "seed": 7, "a": 0.4, "b": "x*x"}},
    "ior": {"pattern": "checker", "a": 1.25, "b": 1.75}})");
  const Material& m = scene.materials[0];
  REQUIRE(m.textured.size() == 2);
  const TexturedParameter& row = m.textured[0];
  CHECK(std::get<MaterialNumber>(row.parameter) == &MaterialNumbers::roughness);
  CHECK(row.least == 0);
  CHECK(row.most == 1);
  CHECK(m.textured[1].least > 0);
  CHECK(m.ior == 1.5);
  const auto& stripes = std::get<Pattern>(scene.textures[row.texture]);
  CHECK(std::get<Pattern::Stripes>(stripes.kind).axis == glm::dvec3(0, 0, 1));
  CHECK(std::get<Pattern::Stripes>(stripes.kind).width == 0.25);
  CHECK(stripes.to_pattern({2, 4, 6}) == glm::dvec3(1, 2, 3));
  CHECK(std::get<glm::dvec3>(scene.textures[stripes.a]).x == 0.2);
  const auto& noise = std::get<Pattern>(scene.textures[stripes.b]);
  CHECK(std::get<Pattern::Noise>(noise.kind).seed == 7);
  CHECK(std::get<Pattern::Noise>(noise.kind).octaves == 4);
  CHECK(std::holds_alternative<TextureFormula>(scene.textures[noise.b]));
  CHECK(scene.formulas.size() == 1);
  CHECK(stripes.a < row.texture);
  CHECK(stripes.b < row.texture);
  CHECK(noise.b < stripes.b);
}

TEST_CASE("materials: light that varies counts as light", "[frontend][material]") {
  CHECK(emits(scene_of(R"~({"type": "emissive", "emission": "max(x, 0)"})~").materials[0]));
  CHECK(emits(scene_of(R"~({"type": "principled", "emission_luminance": "max(x, 0)"})~").materials[0]));
  CHECK(emits(scene_of(R"({"type": "principled", "emission": ["x", 0, 0]})").materials[0]));
}

}  // namespace

}  // namespace fathom::materials_test
