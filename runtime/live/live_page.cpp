#include "runtime/live/live_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "compiler/emit/emit.h"
#include "compiler/scene/framing.h"
#include "runtime/chart/markup.h"
#include "runtime/light/sky.h"
#include "runtime/live/live_files.h"
#include "runtime/sampling/camera.h"

namespace fathom::runtime {
namespace {

using compiler::AreaLight;
using compiler::CompiledScene;
using compiler::Material;
using glm::dvec3;
using nlohmann::json;

constexpr int kSteps = 256;  // evaluations per ray
// Share of a distance that a ray may step in a field without a Lipschitz constant.
constexpr double kGuessedStep = 0.3;
// Max number of lights, and distance up to which rays of an unbounded scene are followed, relative to the distance to
// the camera's target.
constexpr std::size_t kMaxLights = 8;
constexpr double kFar = 100;

json list(dvec3 v) { return {v.x, v.y, v.z}; }

compiler::Camera placed_camera(const CompiledScene& scene) {
  const double width = scene.film.width, height = scene.film.height;
  compiler::Camera camera = compiler::placed(scene.camera, scene.extent, width / height);
  if (camera.projection == compiler::Camera::Projection::Panorama) {
    camera.projection = compiler::Camera::Projection::Perspective;
  }
  return camera;
}

json camera_of(const CompiledScene& scene, const compiler::Camera& camera) {
  const Camera axes(camera, scene.film.width, scene.film.height);
  return {{"position", list(camera.position + scene.origin)},
          {"target", list(camera.target + scene.origin)},
          {"up", list(camera.up)},
          {"half", {axes.half_extent().x, axes.half_extent().y}},
          {"orthographic", camera.projection == compiler::Camera::Projection::Orthographic}};
}

json surface_of(const CompiledScene& scene, const compiler::Surface& surface) {
  const Material& material = scene.materials[surface.material];
  const bool mirror = material.type == Material::Type::Specular;
  const bool glossy = mirror || material.type == Material::Type::Transparent;
  const bool plain = material.type == Material::Type::Diffuse || material.type == Material::Type::Emissive;
  const dvec3 glow = compiler::emits(material) ? material.emission * material.emission_luminance : dvec3(0);
  return {{"name", surface.name},
          {"color", list(material.base_weight * material.color)},
          {"roughness", glossy  ? 0.05
                        : plain ? 1
                                : material.roughness},
          {"metalness", mirror            ? 1
                        : plain || glossy ? 0
                                          : material.metalness},
          {"emission", list(glow)}};
}

// Returns the mean area that a light shows, over all directions: a quarter of a convex body's surface.
double shown_area(const AreaLight& light) {
  const double r = light.radius, h = light.half_height;
  const dvec3 s = light.half_size;
  switch (light.shape) {
    case AreaLight::Shape::Sphere:
      return std::numbers::pi * r * r;
    case AreaLight::Shape::Box:
      return 2 * (s.x * s.y + s.y * s.z + s.z * s.x);
    case AreaLight::Shape::Cylinder:
      return std::numbers::pi * r * (r / 2 + h);
    case AreaLight::Shape::Capsule:
      return std::numbers::pi * r * (r + h);
    case AreaLight::Shape::Quad: {
      const glm::dvec2 a = light.corners[2] - light.corners[0], b = light.corners[3] - light.corners[1];
      return std::abs(a.x * b.y - a.y * b.x) / 4;
    }
  }
  return 0;
}

double radius_of(const AreaLight& light) {
  if (light.shape == AreaLight::Shape::Box) return glm::length(light.half_size);
  double radius = light.radius + light.half_height;
  if (light.shape == AreaLight::Shape::Quad) {
    for (const glm::dvec2 corner : light.corners) radius = std::max(radius, glm::length(corner) + light.radius);
  }
  return radius;
}

json light_of(dvec3 at, bool place, dvec3 power, double radius = 0) {
  return {{"at", {at.x, at.y, at.z, place ? 1 : 0}}, {"power", list(power)}, {"radius", radius}};
}

std::vector<json> lights_of(const CompiledScene& scene) {
  std::vector<json> lights;
  for (const compiler::Light& light : scene.lights) {
    const bool directional = light.type == compiler::Light::Type::Directional;
    lights.push_back(
        light_of(directional ? -light.direction : light.position + scene.origin, !directional, light.intensity));
  }
  const compiler::Background::Sky& sky = scene.background.sky;
  if (scene.background.type == compiler::Background::Type::Sky && sky.sun_disc) {
    lights.push_back(light_of(sky.sun, false, dvec3(Sky(sky).sun_irradiance())));
  }
  for (const AreaLight& light : scene.area_lights) {
    const Material& material = scene.materials[light.material];
    lights.push_back(light_of(light.translation + scene.origin, true,
                              shown_area(light) * material.emission * material.emission_luminance, radius_of(light)));
  }
  if (lights.size() > kMaxLights) lights.resize(kMaxLights);
  return lights;
}

// Returns the background straight down and straight up. A picture counts as an even grey.
std::pair<dvec3, dvec3> background_of(const compiler::Background& background) {
  if (background.type == compiler::Background::Type::Gradient) return {background.bottom, background.top};
  if (background.type == compiler::Background::Type::Image) return {dvec3(0.5), dvec3(0.5)};
  const Sky sky(background.sky);
  return {dvec3(sky.radiance({0, -1, 0})), dvec3(sky.radiance({0, 1, 0}))};
}

std::string shader_of(const CompiledScene& scene, std::size_t lights) {
  const double step = std::isfinite(scene.lipschitz) ? 1 / std::max(scene.lipschitz, 1e-6) : kGuessedStep;
  return compiler::emit_glsl(scene, "scene", true) +
         fmt::format(
             "\nconst int kSteps = {};\nconst int kSurfaces = {};\nconst int kLights = {};\n"
             "const float kInverseLipschitz = {:e};\n",
             kSteps, std::max<std::size_t>(1, scene.surfaces.size()), std::max<std::size_t>(1, lights), step) +
         std::string(kLiveShader);
}

json scene_of(const CompiledScene& scene, const std::vector<json>& lights) {
  const auto [bottom, top] = background_of(scene.background);
  const compiler::Camera camera = placed_camera(scene);
  json surfaces = json::array();
  for (const compiler::Surface& surface : scene.surfaces) surfaces.push_back(surface_of(scene, surface));
  json bound;
  if (scene.bound.finite() && !scene.bound.empty()) {
    bound = {list(scene.bound.lo + scene.origin), list(scene.bound.hi + scene.origin)};
  }
  return {{"summary", scene.summary},
          {"camera", camera_of(scene, camera)},
          {"bottom", list(bottom)},
          {"top", list(top)},
          {"lights", lights},
          {"bound", bound},
          {"surfaces", surfaces},
          {"far", kFar * glm::length(camera.target - camera.position)},
          {"exposure", std::exp2(scene.film.exposure)},
          {"shader", shader_of(scene, lights.size())}};
}

// Returns JSON as the text of an element. It must not contain `<`, because a name could end the element: all text of
// the scene, and so its shader, whose comments have names, is in this one.
std::string as_element(const json& value) {
  std::string text;
  for (const char c : value.dump(-1, ' ', true, json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

constexpr std::string_view kPage = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'">
<title>{title}</title>
<style>
{style}</style>
<header><h1>{title}</h1><span id="status" role="status"></span></header>
<canvas id="view" aria-label="{title}"></canvas>
<footer><span>drag: orbit</span><span><kbd>Shift</kbd> drag: pan</span><span>wheel: zoom</span>
<span><kbd>W</kbd> <kbd>A</kbd> <kbd>S</kbd> <kbd>D</kbd> <kbd>Q</kbd> <kbd>E</kbd>: walk</span>
<span><kbd>Home</kbd>: the scene's camera</span><span><kbd>C</kbd>: copy the camera</span></footer>
<script type="application/json" id="scene">{scene}</script>
<script>
{script}</script>
</html>
)";

}  // namespace

std::string live_page(const CompiledScene& scene) {
  const std::vector<json> lights = lights_of(scene);
  return fmt::format(fmt::runtime(kPage), fmt::arg("title", escape_markup(scene.source.name())),
                     fmt::arg("style", kLiveStyle), fmt::arg("scene", as_element(scene_of(scene, lights))),
                     fmt::arg("script", kLiveScript));
}

}  // namespace fathom::runtime
