#include "compiler/frontend/elaborate/settings.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <type_traits>

#include "compiler/frontend/records/record_family.h"
#include "compiler/frontend/records/record_reader.h"
#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

// Reports a camera without a direction of view, or without a defined up direction in the image.
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
  // Sine of the angle between view and up. Below 1e-6 rounding errors would determine the axes of the image.
  const double sine = glm::length(glm::cross(glm::normalize(view), glm::normalize(camera.up)));
  if (sine > 1e-6) return;
  diagnostics.error("E0304", reader.value("up") ? span_of("up") : span_of("target"),
                    "the camera looks along its own `up`", "the picture could be turned any way",
                    {fmt::format("for a view straight up or down give another `up`, such as {}",
                                 camera.up.z == 0 ? "[0, 0, -1]" : "[0, 1, 0]")});
}

void read_field_of_view(const RecordReader& reader, Camera& camera) {
  camera.fov = reader.number("fov") * vm::real::kDegree;
  camera.sensor_width = reader.number("sensor_width");
  if (reader.value("fov_y")) camera.vertical_fov = reader.number("fov_y") * vm::real::kDegree;
  if (reader.value("focal_length")) camera.focal_length = reader.number("focal_length");
}

// Reads the aperture and the plane of focus. The camera must have a direction of view.
void read_lens(const RecordReader& reader, Camera& camera, Diagnostics& diagnostics) {
  if (reader.value("lens_radius")) camera.lens_radius = reader.number("lens_radius");
  if (reader.value("f_stop")) camera.f_stop = reader.number("f_stop");
  camera.blades = static_cast<int>(reader.number("blades"));
  camera.blade_rotation = reader.number("blade_rotation") * vm::real::kDegree;
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

template <typename Record>
Record read_settings_of(const RecordSpec& row, const syntax::Value& value, const Scope& scope,
                        Diagnostics& diagnostics) {
  const RecordReader reader(row, std::get<syntax::Record>(value.data), opening(value.span), scope, diagnostics);
  Record record;
  for_each_setting_of<Record>([&](const auto& setting) {
    using Number = typename std::remove_cvref_t<decltype(setting)>::Value;
    if (reader.value(setting.name) == nullptr) return;
    if constexpr (std::is_enum_v<Number>) {
      record.*setting.member = static_cast<Number>(reader.choice(setting.name));
    } else if constexpr (std::is_same_v<Number, std::uint64_t>) {
      record.*setting.member = reader.seed(setting.name);
    } else {
      record.*setting.member = static_cast<Number>(reader.number(setting.name));
    }
  });
  return record;
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
  camera.shutter = reader.number("shutter");
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
  return read_settings_of<Film>(film_record(), value, scope, diagnostics);
}

RenderSettings read_render(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics) {
  return read_settings_of<RenderSettings>(render_record(), value, scope, diagnostics);
}

}  // namespace fathom::compiler
