#include "compiler/frontend/settings.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/direction.h"
#include "compiler/frontend/record_reader.h"
#include "compiler/frontend/suggest.h"
#include "compiler/sine_cosine.h"

namespace fathom::compiler {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// The row of the family that the record's `type` names; nullptr after reporting that there is none. `place` is where
// a missing type is reported.
const RecordSpec* row_by_type(const std::vector<RecordSpec>& family, std::string_view what,
                              const syntax::Record& record, Span place, Diagnostics& diagnostics) {
  const syntax::Property* type = record.find("type");
  const PropertySpec& row = *family[0].find("type");
  std::vector<std::string_view> known(row.choices);
  if (type == nullptr) {
    if (!row.required) return &family[0];
    diagnostics.error("E0103", place, fmt::format("the {} has no `type`", what), "",
                      {fmt::format("known: {}", fmt::join(known, ", "))});
    return nullptr;
  }
  const auto* name = std::get_if<std::string>(&type->value->data);
  if (name == nullptr) {
    diagnostics.error("E0101", type->value->span,
                      fmt::format("`type` must be a string, not {}", describe(*type->value)), "",
                      {fmt::format("known: {}", fmt::join(known, ", "))});
    return nullptr;
  }
  for (const RecordSpec& member : family) {
    if (member.type == *name) return &member;
  }
  diagnostics.error("E0108", type->value->span, fmt::format("unknown type of {} `{}`", what, *name), "",
                    {did_you_mean(*name, known)});
  return nullptr;
}

// Reports properties of which at most one may be given.
void check_exclusions(const RecordSpec& row, const syntax::Record& record, Diagnostics& diagnostics) {
  for (const PropertySpec& property : row.properties) {
    for (const std::string_view other : property.instead_of) {
      if (!record.find(other) || !record.find(property.name)) continue;
      diagnostics.error(
          "E0106", record.find(property.name)->name_span,
          fmt::format("both `{}` and `{}` are given", other, property.name), "one follows from the other",
          {fmt::format("keep `{}` ({}) or `{}` ({})", other, row.find(other)->doc, property.name, property.doc)});
    }
  }
}

// The record of a named material or light; nullptr after reporting that it is none.
const syntax::Record* record_of(const syntax::Property& named, std::string_view what, std::string_view example,
                                Diagnostics& diagnostics) {
  const auto* record = std::get_if<syntax::Record>(&named.value->data);
  if (record == nullptr) {
    diagnostics.error(
        "E0101", named.value->span,
        fmt::format("{} `{}` must be an object {{...}}, not {}", what, named.name, describe(*named.value)), "",
        {fmt::format("such as {}", example)});
  }
  return record;
}

// Reports a camera that has no direction of view, or no way to tell what is up in the picture.
void check_view(const Camera& camera, const RecordReader& reader, Span place, Diagnostics& diagnostics) {
  const auto span_of = [&](std::string_view name) {
    const syntax::Value* value = reader.value(name);
    return value ? value->span : place;
  };
  const glm::dvec3 view = camera.target - camera.position;
  if (glm::length(view) == 0) {
    diagnostics.error("E0303", reader.value("target") ? span_of("target") : span_of("position"),
                      "the camera's `target` is its `position`", "no direction to look in",
                      {fmt::format("move one of them; position is [{}, {}, {}]", camera.position.x, camera.position.y,
                                   camera.position.z)});
    return;
  }
  // sin of the angle between them; below 1e-6 the picture's axes would be rounding errors.
  const double sine = glm::length(glm::cross(glm::normalize(view), glm::normalize(camera.up)));
  if (sine > 1e-6) return;
  diagnostics.error("E0304", reader.value("up") ? span_of("up") : span_of("target"),
                    "the camera looks along its own `up`", "the picture could be turned any way",
                    {fmt::format("for a view straight up or down give another `up`, such as {}",
                                 camera.up.z == 0 ? "[0, 0, -1]" : "[0, 1, 0]")});
}

void read_field_of_view(const RecordReader& reader, Camera& camera) {
  camera.fov = reader.number("fov") * kDegree;
  camera.sensor_width = reader.number("sensor_width");
  if (reader.value("fov_y")) camera.vertical_fov = reader.number("fov_y") * kDegree;
  if (reader.value("focal_length")) camera.focal_length = reader.number("focal_length");
}

// The aperture and the plane that is sharp. Of a camera that has a direction of view.
void read_lens(const RecordReader& reader, Camera& camera, Diagnostics& diagnostics) {
  if (reader.value("lens_radius")) camera.lens_radius = reader.number("lens_radius");
  if (reader.value("f_stop")) camera.f_stop = reader.number("f_stop");
  camera.blades = static_cast<int>(reader.number("blades"));
  camera.blade_rotation = reader.number("blade_rotation") * kDegree;
  if (reader.value("focus_distance")) camera.focus_distance = reader.number("focus_distance");
  const syntax::Value* focus = reader.value("focus");
  if (focus == nullptr) return;
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  camera.focus_distance = glm::dot(reader.vec3("focus") - camera.position, forward);
  if (*camera.focus_distance > 0) return;
  diagnostics.error("E0302", focus->span, "the camera's `focus` is not in front of it",
                    fmt::format("{} along the direction of view", *camera.focus_distance),
                    {"give a point that the camera sees"});
}

// The unit vector a spot or directional light shines along.
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
    const auto [up, along] = sine_cosine(reader.number("elevation"));
    const auto [sine, cosine] = sine_cosine(reader.number("azimuth"));
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

Camera read_camera(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  Camera camera;
  const auto& record = std::get<syntax::Record>(value.data);
  const RecordSpec* row = row_by_type(camera_records(), "camera", record, opening(value.span), diagnostics);
  if (row == nullptr) return camera;
  const RecordReader reader(*row, record, opening(value.span), scope, diagnostics);
  check_exclusions(*row, record, diagnostics);
  camera.position = reader.vec3("position");
  camera.target = reader.vec3("target");
  camera.up = reader.vec3("up");
  if (row->type == "orthographic") {
    camera.projection = Camera::Projection::Orthographic;
    camera.width = reader.number("width");
  } else if (row->type == "panorama") {
    camera.projection = Camera::Projection::Panorama;
  } else {
    read_field_of_view(reader, camera);
  }
  if (reader.good()) check_view(camera, reader, opening(value.span), diagnostics);
  if (reader.good() && camera.projection == Camera::Projection::Perspective) read_lens(reader, camera, diagnostics);
  return camera;
}

Film read_film(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  const RecordReader reader(film_record(), std::get<syntax::Record>(value.data), opening(value.span), scope,
                            diagnostics);
  Film film;
  film.width = static_cast<int>(reader.number("width"));
  film.height = static_cast<int>(reader.number("height"));
  film.exposure = reader.number("exposure");
  film.tone = static_cast<ToneCurve>(reader.choice("tone"));
  film.filter = static_cast<FilterKind>(reader.choice("filter"));
  if (reader.value("filter_width")) film.filter_width = reader.number("filter_width");
  return film;
}

RenderSettings read_render(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  const RecordReader reader(render_record(), std::get<syntax::Record>(value.data), opening(value.span), scope,
                            diagnostics);
  RenderSettings settings;
  settings.spp = static_cast<int>(reader.number("spp"));
  settings.bounces = static_cast<int>(reader.number("bounces"));
  settings.tile = static_cast<int>(reader.number("tile"));
  settings.seed = static_cast<std::uint64_t>(reader.number("seed"));
  settings.sampler = static_cast<SamplerKind>(reader.choice("sampler"));
  if (reader.value("far")) settings.far = reader.number("far");
  return settings;
}

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
      background.image.file = std::get<std::string>(file->data);
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

std::vector<Material> read_materials(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  std::vector<Material> materials;
  for (const syntax::Property& property : std::get<syntax::Record>(value.data).properties) {
    Material& material = materials.emplace_back();
    material.name = property.name;
    const syntax::Record* record =
        record_of(property, "material", R"({"type": "diffuse", "color": [0.8, 0.8, 0.8]})", diagnostics);
    if (record == nullptr) continue;
    const RecordSpec* row = row_by_type(material_records(), "material", *record, property.name_span, diagnostics);
    if (row == nullptr) continue;
    const RecordReader reader(*row, *record, property.name_span, scope, diagnostics);
    material.color = reader.vec3("color");
    if (row->type == "emissive") {
      material.type = Material::Type::Emissive;
      material.emission = reader.vec3("emission");
    } else if (row->type == "specular") {
      material.type = Material::Type::Specular;
    } else if (row->type == "transparent") {
      material.type = Material::Type::Transparent;
      material.ior = reader.number("ior");
      material.absorption = reader.vec3("absorption");
    }
  }
  return materials;
}

}  // namespace fathom::compiler
