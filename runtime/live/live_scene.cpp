#include "runtime/live/live_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compiler/emit/emit.h"
#include "compiler/scene/framing.h"
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

}  // namespace

json live_scene(const CompiledScene& scene) {
  const std::vector<json> lights = lights_of(scene);
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

}  // namespace fathom::runtime
