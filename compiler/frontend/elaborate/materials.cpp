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

using M = MaterialNumbers;

// Material parameter that receives the value of a property.
struct Slot {
  std::string_view property;
  std::variant<MaterialNumber, MaterialColor> parameter;
};
const Slot kPlaces[] = {
    {"base_weight", &M::base_weight},
    {"base_color", &M::color},
    {"color", &M::color},
    {"base_diffuse_roughness", &M::diffuse_roughness},
    {"base_metalness", &M::metalness},
    {"specular_weight", &M::specular_weight},
    {"specular_color", &M::specular_color},
    {"specular_roughness", &M::roughness},
    {"specular_ior", &M::ior},
    {"ior", &M::ior},
    {"transmission_weight", &M::transmission},
    {"transmission_color", &M::transmission_color},
    {"transmission_depth", &M::transmission_depth},
    {"coat_weight", &M::coat_weight},
    {"coat_color", &M::coat_color},
    {"coat_roughness", &M::coat_roughness},
    {"coat_ior", &M::coat_ior},
    {"emission_color", &M::emission},
    {"emission", &M::emission},
    {"emission_luminance", &M::emission_luminance},
    {"absorption", &M::absorption},
    {"geometry_opacity", &M::opacity},
};

void put(MaterialNumbers& numbers, const Slot& place, glm::dvec3 value) {
  if (const auto* number = std::get_if<MaterialNumber>(&place.parameter)) numbers.*(*number) = value.x;
  if (const auto* color = std::get_if<MaterialColor>(&place.parameter)) numbers.*(*color) = value;
}

// Lower bound for textured parameters that must be positive, such as an index of refraction.
constexpr double kLeastPositive = 1e-3;

TexturedParameter textured(const Slot& place, std::uint32_t texture, const PropertySpec& row) {
  double least = row.range.least;
  if (row.rule == Rule::Positive) least = std::max(least, kLeastPositive);
  if (row.rule == Rule::NotNegative) least = std::max(least, 0.0);
  return {place.parameter, texture, least, row.range.most};
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
    for (const Slot& place : kPlaces) {
      const PropertySpec* property = row.find(place.property);
      if (property == nullptr || !property->alias_of.empty()) continue;
      const syntax::Value* given = reader.value(place.property);
      if (given && varies(*given)) {
        read_texture(*given, *property, space, place, material);
      } else if (const glm::dvec3* known = given ? nullptr : find(preset, place.property)) {
        put(material, place, *known);
      } else {
        const std::vector<double> numbers = reader.numbers(place.property);
        put(material, place, {numbers[0], numbers[numbers.size() / 2], numbers.back()});
      }
    }
    // An emission colour given alone emits: its luminance is 1, although OpenPBR's default is 0.
    if (reader.value("emission_color") && !reader.value("emission_luminance")) material.emission_luminance = 1;
  }

  void read_texture(const syntax::Value& value, const PropertySpec& row, TextureSpace space, const Slot& place,
                    Material& material) {
    const std::optional<ReadTexture> texture = textures_.read(value, row, space);
    if (!texture) return;
    put(material, place, texture->typical);
    if (texture->index) material.textured.push_back(textured(place, *texture->index, row));
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
