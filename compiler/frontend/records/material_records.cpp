// Tables of materials and of the patterns that material parameters may vary by.
#include <array>
#include <utility>
#include <variant>

#include "compiler/frontend/records/material_presets.h"
#include "compiler/frontend/records/property_rows.h"
#include "compiler/frontend/records/records.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {
namespace {

using namespace rows;
using M = MaterialNumbers;

constexpr std::string_view kPriority = "of solids at the same place, the medium is that of the highest";

PropertySpec varying(PropertySpec property) {
  property.varies = true;
  return property;
}

PropertySpec space_row(std::string_view doc) { return choice("space", doc, kTextureSpaces); }

RecordSpec material(std::string type, std::vector<PropertySpec> own) {
  RecordSpec record{type,
                    "`" + type + "`",
                    type + " material",
                    {choice({"diffuse", "emissive", "specular", "transparent", "principled"},
                            "how the surface scatters light", true)}};
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  record.properties.push_back(
      space_row("whose coordinates formulas and patterns are in: the scene's, or the node's"));
  return record;
}

PropertySpec parameter_row(const MaterialParameter& parameter, std::string_view name, std::string_view doc,
                           double fallback) {
  const ParameterDomain domain = parameter.domain;
  const Range range = domain == ParameterDomain::Share ? kUnit : Range{};
  const Rule rule = domain == ParameterDomain::Positive      ? Rule::Positive
                    : domain == ParameterDomain::NotNegative ? Rule::NotNegative
                                                             : Rule::Any;
  return varying(std::holds_alternative<MaterialColor>(parameter.member)
                     ? color(name, doc, fallback, range, rule)
                     : number(name, doc, {fallback}, range, rule));
}

// Row of a plain material, where a parameter has its own meaning and default.
PropertySpec plain_row(MaterialMember member, std::string_view doc, double fallback) {
  const MaterialParameter& parameter = parameter_of(member);
  return parameter_row(parameter, parameter.name, doc, fallback);
}

// Adds the short name of a property, with a copy of its row.
void add_alias(RecordSpec& record, std::string_view property, std::string_view alias) {
  PropertySpec row = *record.find(property);
  row.name = alias;
  row.alias_of = property;
  record.properties.push_back(std::move(row));
}

PropertySpec preset_row() {
  PropertySpec row = other("preset", ValueType::Choice, "values of a known substance, for what is not given");
  for (const MaterialPreset& preset : material_presets()) row.choices.push_back(preset.name);
  return row;
}

// Follows OpenPBR 1.1, including the defaults. The properties `preset` and `priority` are additions.
RecordSpec principled() {
  std::vector<PropertySpec> own = {preset_row()};
  for (const MaterialParameter& row : kMaterialParameters) {
    if (!row.property.empty()) own.push_back(parameter_row(row, row.property, row.doc, row.value));
  }
  own.push_back(other("geometry_thin_walled", ValueType::Boolean, "whether it is a sheet without an inside (false)"));
  own.push_back(integer("priority", kPriority, 0, {-1000, 1000}));
  RecordSpec record = material("principled", std::move(own));
  for (const MaterialParameter& row : kMaterialParameters) {
    if (!row.alias.empty()) add_alias(record, row.property, row.alias);
  }
  add_alias(record, "geometry_thin_walled", "thin_walled");
  return record;
}

RecordSpec pattern(std::string type, std::vector<PropertySpec> own) {
  PropertySpec kind =
      choice({"checker", "stripes", "gradient", "noise", "bricks"}, "arrangement of the two values", true);
  kind.name = "pattern";
  // row_for() in textures.cpp sets the types of `a` and `b` from the property that has the pattern.
  RecordSpec record{type, "`" + type + "`", type + " pattern", {kind}};
  record.properties.push_back(varying(other("a", ValueType::Color, "value where the pattern is 0", true)));
  record.properties.push_back(varying(other("b", ValueType::Color, "value where the pattern is 1", true)));
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  // The same rows as for a node.
  for (const char* name : {"scale", "rotate"}) record.properties.push_back(*use_record().find(name));
  record.properties.push_back(vec3("translate", "translation of the pattern, after scale and rotate", {0, 0, 0}));
  record.properties.push_back(
      space_row("coordinates of the pattern and of all patterns that it mixes: the scene's or the node's"));
  return record;
}

}  // namespace

const std::vector<RecordSpec>& material_records() {
  static const std::vector<RecordSpec> records = {
      material("diffuse", {plain_row(&M::color, "albedo", 0.8)}),
      material("emissive", {plain_row(&M::emission, "radiance, both sides", 1),
                            plain_row(&M::color, "albedo of the surface itself", 0)}),
      material("specular", {plain_row(&M::color, "reflectance of the mirror", 1)}),
      material("transparent", {plain_row(&M::ior, "index of refraction relative to vacuum", 1.5),
                               plain_row(&M::color, "tint at each crossing", 1),
                               plain_row(&M::absorption, "inside, per scene unit", 0),
                               integer("priority", kPriority, 0, {-1000, 1000})}),
      principled()};
  return records;
}

const std::vector<RecordSpec>& pattern_records() {
  static const std::vector<RecordSpec> records = {
      pattern("checker", {}),
      pattern("stripes", {vec3("axis", "direction across the stripes", {1, 0, 0}, Rule::NotZero),
                          number("width", "share of a period that is a", {0.5}, kUnit),
                          number("softness", "share of the narrower stripe that is transition", {0}, kUnit)}),
      pattern("gradient", {vec3("from", "where it is a, and before", {0, 0, 0}),
                           vec3("to", "where it is b, and beyond", {0, 1, 0})}),
      pattern("noise", {integer("octaves", "how many sizes of detail", 4, {1, 16}),
                        number("gain", "strength of each octave against the one before", {0.5}, kUnit),
                        number("lacunarity", "fineness of each octave against the one before", {2}, {1, 16}),
                        number("contrast", "factor of the deviation from the middle", {1}, {0, 1000}),
                        seed("seed", "another number, another noise")}),
      pattern("bricks", {number("width", "of a brick with its mortar", {1}, {}, Rule::Positive),
                         number("height", "of a brick with its mortar", {0.5}, {}, Rule::Positive),
                         number("mortar", "how wide it is; b", {0.05}, {}, Rule::NotNegative),
                         number("shift", "of each row against the one below, share of a brick", {0.5}, kUnit)})};
  return records;
}

}  // namespace fathom::compiler
