#include "compiler/frontend/settings.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/frontend/record_reader.h"
#include "compiler/frontend/suggest.h"

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

}  // namespace

Camera read_camera(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  Camera camera;
  const auto& record = std::get<syntax::Record>(value.data);
  const RecordSpec* row = row_by_type(camera_records(), "camera", record, opening(value.span), diagnostics);
  if (row == nullptr) return camera;
  const RecordReader reader(*row, record, opening(value.span), scope, diagnostics);
  for (const PropertySpec& property : row->properties) {
    const std::string_view other = property.instead_of;
    if (other.empty() || !record.find(other) || !record.find(property.name)) continue;
    diagnostics.error(
        "E0106", record.find(property.name)->name_span,
        fmt::format("both `{}` and `{}` are given", other, property.name),
        "one follows from the other and the film's shape",
        {fmt::format("keep `{}` ({}) or `{}` ({})", other, row->find(other)->doc, property.name, property.doc)});
  }
  camera.position = reader.vec3("position");
  camera.target = reader.vec3("target");
  camera.up = reader.vec3("up");
  if (row->type == "orthographic") {
    camera.projection = Camera::Projection::Orthographic;
    camera.width = reader.number("width");
  } else {
    camera.fov = reader.number("fov") * kDegree;
    if (reader.value("fov_y")) camera.vertical_fov = reader.number("fov_y") * kDegree;
  }
  if (reader.good()) check_view(camera, reader, opening(value.span), diagnostics);
  return camera;
}

Film read_film(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  const RecordReader reader(film_record(), std::get<syntax::Record>(value.data), opening(value.span), scope,
                            diagnostics);
  return {static_cast<int>(reader.number("width")), static_cast<int>(reader.number("height")),
          reader.number("exposure"), static_cast<ToneCurve>(reader.choice("tone"))};
}

RenderSettings read_render(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  const RecordReader reader(render_record(), std::get<syntax::Record>(value.data), opening(value.span), scope,
                            diagnostics);
  RenderSettings settings;
  settings.spp = static_cast<int>(reader.number("spp"));
  settings.bounces = static_cast<int>(reader.number("bounces"));
  settings.tile = static_cast<int>(reader.number("tile"));
  settings.seed = static_cast<std::uint64_t>(reader.number("seed"));
  if (reader.value("far")) settings.far = reader.number("far");
  return settings;
}

Background read_background(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  if (const auto* record = std::get_if<syntax::Record>(&value.data)) {
    const RecordReader reader(gradient_record(), *record, opening(value.span), scope, diagnostics);
    return {reader.vec3("bottom"), reader.vec3("top")};
  }
  const glm::dvec3 color = three_numbers(value).value_or(glm::dvec3(0));
  return {color, color};
}

std::vector<Material> read_materials(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  std::vector<Material> materials;
  for (const syntax::Property& property : std::get<syntax::Record>(value.data).properties) {
    Material& material = materials.emplace_back();
    material.name = property.name;
    const auto* record = std::get_if<syntax::Record>(&property.value->data);
    if (record == nullptr) {
      diagnostics.error(
          "E0101", property.value->span,
          fmt::format("material `{}` must be an object {{...}}, not {}", property.name, describe(*property.value)),
          "", {"such as {\"type\": \"diffuse\", \"color\": [0.8, 0.8, 0.8]}"});
      continue;
    }
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
