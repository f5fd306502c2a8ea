#include "runtime/cli/options/camera_options.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "compiler/scene/framing.h"
#include "vm/number/real.h"

namespace fathom::cli {
namespace {

using compiler::Camera;

std::string point(glm::dvec3 p) { return fmt::format("[{}, {}, {}]", p.x, p.y, p.z); }

// Formats an angle with 15 digits, few enough to drop the rounding error of the conversion to radians and back.
std::string degrees(double radians) { return fmt::format("{:.15g}", radians / vm::real::kDegree); }

bool along(glm::dvec3 a, glm::dvec3 b) {
  return !(glm::length(glm::cross(glm::normalize(a), glm::normalize(b))) > 1e-6);
}

// Checks the view direction. If the view is parallel to the camera's up vector, as from straight above, -z becomes up
// in the image, as on a map and in a slice.
std::optional<ExitCode> check_view(compiler::CompiledScene& scene, const Streams& streams) {
  Camera& camera = scene.camera;
  const glm::dvec3 view = camera.target - camera.position;
  if (!(glm::length(view) > 0)) {
    return fail(streams, kUsage,
                fmt::format("--position and --look-at: the camera would look at its own place, {}",
                            point(camera.position + scene.origin)),
                {"move one of them"});
  }
  if (along(view, camera.up)) camera.up = {0, 0, -1};
  if (along(view, camera.up)) camera.up = {0, 1, 0};
  return std::nullopt;
}

}  // namespace

void add_camera_options(Arguments& arguments, CameraOptions& options) {
  arguments.group("Camera (a scene without one is framed whole, from three quarters above)");
  arguments.option("--position", "X,Y,Z",
                   "Where the camera is, in scene units (the scene's); -z is up in a view from straight above",
                   into(read_point, options.position));
  arguments.option("--look-at", "X,Y,Z", "What the camera looks at, in scene units (the scene's)",
                   into(read_point, options.look_at));
  arguments.flag("--frame", "Move the camera so that it shows the whole scene; its direction and field of view stay",
                 options.frame);
}

std::optional<ExitCode> place_camera(const CameraOptions& options, compiler::CompiledScene& scene,
                                     const Streams& streams) {
  const double aspect = static_cast<double>(scene.film.width) / scene.film.height;
  scene.camera = compiler::placed(scene.camera, scene.extent, aspect);
  if (options.position) scene.camera.position = *options.position - scene.origin;
  if (options.look_at) scene.camera.target = *options.look_at - scene.origin;
  if (options.position || options.look_at) {
    if (const auto code = check_view(scene, streams)) return code;
  }
  if (!options.frame) return std::nullopt;
  const std::optional<Camera> framed = compiler::framed(scene.camera, scene.extent, aspect);
  if (!framed) {
    return fail(streams, kUsage, "--frame: nothing in the scene has an end, so that no picture shows it whole",
                {"say where the camera is: --position X,Y,Z --look-at X,Y,Z"});
  }
  scene.camera = *framed;
  return std::nullopt;
}

std::string camera_text(const compiler::CompiledScene& scene) {
  const Camera& camera = scene.camera;
  std::string text = "\"camera\": {";
  if (camera.projection == Camera::Projection::Orthographic) text += "\"type\": \"orthographic\", ";
  if (camera.projection == Camera::Projection::Panorama) text += "\"type\": \"panorama\", ";
  text += fmt::format("\"position\": {}, \"target\": {}", point(camera.position + scene.origin),
                      point(camera.target + scene.origin));
  if (camera.up != Camera().up) text += fmt::format(", \"up\": {}", point(camera.up));
  if (camera.projection == Camera::Projection::Orthographic) text += fmt::format(", \"width\": {}", camera.width);
  if (camera.projection != Camera::Projection::Perspective) return text + "}";
  if (camera.vertical_fov) {
    text += fmt::format(", \"fov_y\": {}", degrees(*camera.vertical_fov));
  } else if (camera.focal_length) {
    text += fmt::format(", \"focal_length\": {}", *camera.focal_length);
  } else {
    text += fmt::format(", \"fov\": {}", degrees(camera.fov));
  }
  if (camera.sensor_width != Camera().sensor_width)
    text += fmt::format(", \"sensor_width\": {}", camera.sensor_width);
  if (camera.lens_radius) text += fmt::format(", \"lens_radius\": {}", *camera.lens_radius);
  if (camera.f_stop) text += fmt::format(", \"f_stop\": {}", *camera.f_stop);
  if (camera.focus_distance) text += fmt::format(", \"focus_distance\": {}", *camera.focus_distance);
  if (camera.blades != 0) text += fmt::format(", \"blades\": {}", camera.blades);
  if (camera.blade_rotation != 0) text += fmt::format(", \"blade_rotation\": {}", degrees(camera.blade_rotation));
  return text + "}";
}

}  // namespace fathom::cli
