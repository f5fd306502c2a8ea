#include "compiler/frontend/elaborate/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/frontend/elaborate/textures.h"
#include "compiler/frontend/records/material_presets.h"
#include "compiler/frontend/records/record_family.h"
#include "compiler/frontend/records/record_reader.h"
#include "compiler/frontend/records/written_numbers.h"

namespace fathom::compiler {
namespace {

void put(MaterialNumbers& numbers, const MaterialParameter& parameter, glm::dvec3 value) {
  if (const auto* number = std::get_if<MaterialNumber>(&parameter.member)) numbers.*(*number) = value.x;
  if (const auto* color = std::get_if<MaterialColor>(&parameter.member)) numbers.*(*color) = value;
}

// Lower bound for textured parameters that must be positive, such as an index of refraction.
constexpr double kMinPositive = 1e-3;

TexturedParameter textured(const MaterialParameter& parameter, std::uint32_t texture, const PropertySpec& row) {
  double least = row.range.least;
  if (row.rule == Rule::Positive) least = std::max(least, kMinPositive);
  if (row.rule == Rule::NotNegative) least = std::max(least, 0.0);
  return {parameter.member, texture, least, row.range.most};
}

// Returns the property that gives a parameter its value, or nullptr if materials of this type have none. Principled
// materials have their own names.
const PropertySpec* material_property(const RecordSpec& row, const MaterialParameter& parameter) {
  const PropertySpec* property = row.find(parameter.property);
  return property ? property : row.find(parameter.name);
}

class MaterialReader {
 public:
  MaterialReader(const Scope& scope, Diagnostics& diagnostics)
      : scope_(scope), diagnostics_(diagnostics), textures_(scope, diagnostics) {}

  void read(const syntax::Property& property) {
    Material& material = tables_.materials.emplace_back();
    material.name = property.name;
    const auto* record = std::get_if<syntax::Record>(&property.value->data);
    if (record == nullptr) {
      diagnostics_.error(
          "E0101", property.value->span,
          fmt::format("material `{}` must be an object {{...}}, not {}", property.name, describe(*property.value)),
          "", {"such as {\"type\": \"diffuse\", \"color\": [0.8, 0.8, 0.8]}"});
      return;
    }
    const auto& family = material_records();
    const RecordSpec* row = row_by_type(family, "material", *record, property.name_span, diagnostics_);
    if (row == nullptr) return;
    material.type = static_cast<Material::Type>(row - family.data());
    const RecordReader reader(*row, *record, property.name_span, scope_, diagnostics_);
    read_parameters(reader, *row, material);
    if (row->find("priority")) material.priority = static_cast<int>(reader.number("priority"));
    const syntax::Value* thin = reader.value("geometry_thin_walled");
    material.thin_walled = thin && std::get<bool>(thin->data);
  }

  MaterialTables take() {
    tables_.textures = std::move(textures_.textures);
    tables_.formulas = std::move(textures_.formulas);
    return std::move(tables_);
  }

 private:
  void read_parameters(const RecordReader& reader, const RecordSpec& row, Material& material) {
    const MaterialPreset* preset = find_preset(reader);
    const TextureSpace space = space_of(reader, TextureSpace::World);
    for (const MaterialParameter& parameter : kMaterialParameters) {
      const PropertySpec* property = material_property(row, parameter);
      if (property == nullptr) continue;
      const syntax::Value* given = reader.value(property->name);
      if (given && varies(*given)) {
        read_texture(*given, *property, space, parameter, material);
      } else if (const glm::dvec3* known = given ? nullptr : find(preset, property->name)) {
        put(material, parameter, *known);
      } else {
        const std::vector<double> numbers = reader.numbers(property->name);
        put(material, parameter, {numbers[0], numbers[numbers.size() / 2], numbers.back()});
      }
    }
    // An emission colour without a luminance emits: the luminance is then 1, although OpenPBR's default is 0.
    const bool colored = material.type == Material::Type::Emissive || reader.value("emission_color");
    if (colored && !reader.value("emission_luminance")) material.emission_luminance = 1;
  }

  void read_texture(const syntax::Value& value, const PropertySpec& row, TextureSpace space,
                    const MaterialParameter& parameter, Material& material) {
    const std::optional<ReadTexture> texture = textures_.read(value, row, space);
    if (!texture) return;
    put(material, parameter, texture->typical);
    if (texture->index) material.textured.push_back(textured(parameter, *texture->index, row));
  }

  // Returns nullptr without a valid preset. The reader has already reported an unknown name.
  static const MaterialPreset* find_preset(const RecordReader& reader) {
    const syntax::Value* value = reader.value("preset");
    if (value == nullptr) return nullptr;
    const auto& name = std::get<std::string>(value->data);
    const auto presets = material_presets();
    const auto found =
        std::find_if(presets.begin(), presets.end(), [&](const auto& row) { return row.name == name; });
    return found == presets.end() ? nullptr : &*found;
  }

  static const glm::dvec3* find(const MaterialPreset* preset, std::string_view property) {
    if (preset == nullptr) return nullptr;
    for (const auto& [name, value] : preset->values) {
      if (name == property) return &value;
    }
    return nullptr;
  }

  const Scope& scope_;
  Diagnostics& diagnostics_;
  TextureReader textures_;
  MaterialTables tables_;
};

}  // namespace

MaterialTables read_materials(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  MaterialReader reader(scope, diagnostics);
  for (const syntax::Property& property : std::get<syntax::Record>(value.data).properties) reader.read(property);
  return reader.take();
}

}  // namespace fathom::compiler
