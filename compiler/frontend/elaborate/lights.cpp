#include "compiler/frontend/elaborate/lights.h"

#include <fmt/format.h>

#include "compiler/frontend/records/record_family.h"
#include "compiler/frontend/records/record_reader.h"
#include "compiler/geometry/direction.h"
#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

// Returns the unit vector along which a spot or directional light shines.
glm::dvec3 read_direction(const RecordReader& reader, const Light& light, Diagnostics& diagnostics) {
  if (light.type == Light::Type::Directional) {
    return reader.value("toward") ? -direction(reader.vec3("toward")) : direction(reader.vec3("direction"));
  }
  const syntax::Value* target = reader.value("target");
  if (target == nullptr) return direction(reader.vec3("direction"));
  const glm::dvec3 way = reader.vec3("target") - light.position;
  if (way != glm::dvec3(0)) return direction(way);
  diagnostics.error("E0310", target->span, fmt::format("the `target` of light `{}` is its `position`", light.name),
                    "no direction to shine in", {"move one of them, or give a `direction`"});
  return light.direction;
}

Background::Sky read_sky(const RecordReader& reader, Diagnostics& diagnostics) {
  Background::Sky sky;
  sky.sun = direction(reader.vec3("sun"));
  if (reader.value("elevation") || reader.value("azimuth")) {
    const auto [up, along] = vm::real::sin_cos_degrees(reader.number("elevation"));
    const auto [sine, cosine] = vm::real::sin_cos_degrees(reader.number("azimuth"));
    sky.sun = {along * cosine, up, -along * sine};
  }
  if (sky.sun.y < 0) {
    diagnostics.error("E0309", reader.value("sun")->span, "the sun is below the horizon", "y is negative",
                      {"the model knows the sky of the day alone; for a low sun give a y near 0"});
  }
  sky.turbidity = reader.number("turbidity");
  sky.ground_albedo = reader.vec3("ground_albedo");
  sky.strength = reader.number("strength");
  sky.sun_disc = reader.flag("sun_disc", true);
  return sky;
}

}  // namespace

Background read_background(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  Background background;
  const auto* record = std::get_if<syntax::Record>(&value.data);
  if (record == nullptr) {
    background.bottom = background.top = three_numbers(value).value_or(glm::dvec3(0));
    return background;
  }
  const RecordSpec* row = row_by_type(background_records(), "background", *record, opening(value.span), diagnostics);
  if (row == nullptr) return background;
  const RecordReader reader(*row, *record, opening(value.span), scope, diagnostics);
  check_exclusions(*row, *record, diagnostics);
  if (row->type == "sky") {
    background.type = Background::Type::Sky;
    background.sky = read_sky(reader, diagnostics);
  } else if (row->type == "image") {
    background.type = Background::Type::Image;
    if (const syntax::Value* file = reader.value("file")) {
      background.image.name = background.image.file = std::get<std::string>(file->data);
      background.image.span = file->span;
    }
    background.image.rotate = reader.number("rotate");
    background.image.strength = reader.number("strength");
  } else {
    background.bottom = reader.vec3("bottom");
    background.top = reader.vec3("top");
  }
  return background;
}

std::vector<Light> read_lights(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  std::vector<Light> lights;
  for (const syntax::Property& property : std::get<syntax::Record>(value.data).properties) {
    Light& light = lights.emplace_back();
    light.name = property.name;
    const syntax::Record* record = record_of(
        property, "light", R"({"type": "point", "position": [0, 2, 0], "intensity": [1, 1, 1]})", diagnostics);
    if (record == nullptr) continue;
    const RecordSpec* row = row_by_type(light_records(), "light", *record, property.name_span, diagnostics);
    if (row == nullptr) continue;
    const RecordReader reader(*row, *record, property.name_span, scope, diagnostics);
    check_exclusions(*row, *record, diagnostics);
    light.intensity = reader.vec3(row->type == "directional" ? "irradiance" : "intensity");
    if (row->type != "directional") light.position = reader.vec3("position");
    if (row->type == "point") continue;
    light.type = row->type == "spot" ? Light::Type::Spot : Light::Type::Directional;
    light.direction = read_direction(reader, light, diagnostics);
    light.angle = reader.number("angle");
    if (light.type == Light::Type::Spot) light.blend = reader.number("blend");
  }
  return lights;
}

}  // namespace fathom::compiler
