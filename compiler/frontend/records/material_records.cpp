// Tables of materials and of the patterns that material parameters may vary by.
#include <array>
#include <utility>

#include "compiler/frontend/records/material_presets.h"
#include "compiler/frontend/records/property_rows.h"
#include "compiler/frontend/records/records.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {
namespace {

using namespace rows;

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

// Rows of OpenPBR parameters: a share between 0 and 1, a colour of shares, and a positive index.
PropertySpec share(std::string_view name, std::string_view doc, double fallback) {
  return varying(number(name, doc, {fallback}, kUnit));
}
PropertySpec tint(std::string_view name, std::string_view doc, double fallback) {
  return varying(color(name, doc, fallback));
}
PropertySpec index(std::string_view name, std::string_view doc, double fallback) {
  return varying(number(name, doc, {fallback}, {}, Rule::Positive));
}

// Short name of a property. The alias copies the row of that property.
struct Alias {
  std::string_view of, name;
};
constexpr Alias kAliases[] = {
    {"base_color", "color"},         {"base_diffuse_roughness", "diffuse_roughness"},
    {"base_metalness", "metalness"}, {"specular_roughness", "roughness"},
    {"specular_ior", "ior"},         {"transmission_weight", "transmission"},
    {"coat_weight", "coat"},         {"emission_color", "emission"},
    {"geometry_opacity", "opacity"}, {"geometry_thin_walled", "thin_walled"},
};

PropertySpec preset_row() {
  PropertySpec row = other("preset", ValueType::Choice, "values of a known substance, for what is not given");
  for (const MaterialPreset& preset : material_presets()) row.choices.push_back(preset.name);
  return row;
}

// Follows OpenPBR 1.1, including the defaults. The properties `preset` and `priority` are additions.
RecordSpec principled() {
  RecordSpec record = material(
      "principled",
      {preset_row(),
       share("base_weight", "factor of base_color", 1),
       tint("base_color", "albedo; of a metal its reflectance head-on", 0.8),
       share("base_diffuse_roughness", "of the diffuse base: 0 is Lambert's", 0),
       share("base_metalness", "share that is metal and not dielectric", 0),
       share("specular_weight", "strength of the reflection", 1),
       tint("specular_color", "tint of a dielectric's reflection; of a metal, at 82 degrees", 1),
       share("specular_roughness", "of the surface: 0 is smooth", 0.3),
       index("specular_ior", "index of refraction relative to vacuum", 1.5),
       share("transmission_weight", "share that is clear and not opaque", 0),
       tint("transmission_color", "what is left of light after transmission_depth", 1),
       varying(number("transmission_depth", "scene units; 0: transmission_color tints each crossing", {0}, {},
                      Rule::NotNegative)),
       share("coat_weight", "share that has a clear coat", 0),
       tint("coat_color", "what the coat lets through", 1),
       share("coat_roughness", "of the coat's surface", 0),
       index("coat_ior", "index of refraction of the coat", 1.6),
       varying(color("emission_color", "radiance, both sides, times emission_luminance", 1, {}, Rule::NotNegative)),
       varying(number("emission_luminance", "factor of emission_color; 1 when that is given", {0}, {},
                      Rule::NotNegative)),
       share("geometry_opacity", "share of the surface that is there", 1),
       other("geometry_thin_walled", ValueType::Boolean, "whether it is a sheet without an inside (false)"),
       integer("priority", kPriority, 0, {-1000, 1000})});
  for (const Alias& alias : kAliases) {
    PropertySpec row = *record.find(alias.of);
    row.name = alias.name;
    row.alias_of = alias.of;
    record.properties.push_back(std::move(row));
  }
  return record;
}

RecordSpec pattern(std::string type, std::vector<PropertySpec> own) {
  PropertySpec kind = choice({"checker", "stripes", "gradient", "noise", "bricks"}, "how the two are spread", true);
  kind.name = "pattern";
  // row_for() in textures.cpp sets the types of `a` and `b` from the property that has the pattern.
  RecordSpec record{type, "`" + type + "`", type + " pattern", {kind}};
  record.properties.push_back(varying(other("a", ValueType::Color, "where the pattern is 0", true)));
  record.properties.push_back(varying(other("b", ValueType::Color, "where the pattern is 1", true)));
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  // The same rows as for a node.
  for (const char* name : {"scale", "rotate"}) record.properties.push_back(*use_record().find(name));
  record.properties.push_back(vec3("translate", "how far to move the pattern, after scale and rotate", {0, 0, 0}));
  record.properties.push_back(
      space_row("whose coordinates it is in, and all that it mixes: the scene's, or the node's"));
  return record;
}

}  // namespace

const std::vector<RecordSpec>& material_records() {
  static const std::vector<RecordSpec> records = {
      material("diffuse", {tint("color", "albedo", 0.8)}),
      material("emissive", {varying(color("emission", "radiance, both sides", 1, {}, Rule::NotNegative)),
                            tint("color", "albedo of the lamp itself", 0)}),
      material("specular", {tint("color", "reflectance of the mirror", 1)}),
      material("transparent", {index("ior", "index of refraction relative to vacuum", 1.5),
                               tint("color", "tint at each crossing", 1),
                               varying(color("absorption", "inside, per scene unit", 0, {}, Rule::NotNegative)),
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
                        integer("seed", "another number, another noise", 0, {0, kLargestWhole})}),
      pattern("bricks", {number("width", "of a brick with its mortar", {1}, {}, Rule::Positive),
                         number("height", "of a brick with its mortar", {0.5}, {}, Rule::Positive),
                         number("mortar", "how wide it is; b", {0.05}, {}, Rule::NotNegative),
                         number("shift", "of each row against the one below, share of a brick", {0.5}, kUnit)})};
  return records;
}

}  // namespace fathom::compiler
