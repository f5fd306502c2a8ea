#include "runtime/live/live_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/emit/emit.h"
#include "compiler/scene/framing.h"
#include "runtime/light/environment_file.h"
#include "runtime/light/sky.h"
#include "runtime/live/live_files.h"
#include "runtime/live/live_surfaces.h"
#include "runtime/sampling/camera.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

using compiler::AreaLight;
using compiler::CompiledScene;
using compiler::Material;
using glm::dvec3;
using nlohmann::json;

// Share of a distance that a ray may step in a field without a Lipschitz constant.
constexpr double kGuessedStep = 0.3;
constexpr double kLeastLipschitz = 1e-6;
// Max number of lights (kMaxLights of live.frag), and distance up to which rays of an unbounded scene are followed,
// relative to the distance to the camera's target.
constexpr std::size_t kMaxLights = 8;
constexpr double kFar = 100;
constexpr double kSunRadius = 0.00465;  // of the sun's disc, at unit distance
// Stands for an infinite side of a box.
constexpr double kEndless = 1e20;
// Share by which the slice goes beyond the scene on each side.
constexpr double kMargin = 0.1;
// Max size of a background's file that is read for its mean colours.
constexpr std::uintmax_t kMaxBackground = 32 << 20;  // bytes

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

// `point`: the surface's material, without textures.
json surface_of(const CompiledScene& scene, const compiler::Surface& surface, const MaterialPoint& point) {
  const Material& material = scene.materials[surface.material];
  const bool mirror = material.type == Material::Type::Specular;
  const bool glossy = mirror || material.type == Material::Type::Transparent;
  const bool plain = material.type == Material::Type::Diffuse || material.type == Material::Type::Emissive;
  const dvec3 glow = compiler::emits(material) ? dvec3(point.emitted_radiance()) : dvec3(0);
  const bool clear = material.type == Material::Type::Principled;
  const float through = clear ? point.transmission : 0;
  return {{"name", surface.name},
          {"color", list(glm::mix(point.base_color, point.transmission_color, through))},
          {"roughness", glossy  ? 0.05
                        : plain ? 1
                                : point.roughness},
          {"metalness", mirror            ? 1
                        : plain || glossy ? 0
                                          : point.metalness},
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

// `radius`: of the body, or of a directional light's disc at unit distance.
json light_of(dvec3 at, bool place, dvec3 power, double radius = 0) {
  return {{"at", {at.x, at.y, at.z, place ? 1 : 0}}, {"power", list(power)}, {"radius", radius}};
}

std::vector<json> lights_of(const CompiledScene& scene) {
  std::vector<json> lights;
  for (const compiler::Light& light : scene.lights) {
    const bool directional = light.type == compiler::Light::Type::Directional;
    lights.push_back(light_of(directional ? -light.direction : light.position + scene.origin, !directional,
                              light.intensity, directional ? vm::real::tan(light.angle * vm::real::kDegree) : 0));
  }
  const compiler::Background::Sky& sky = scene.background.sky;
  if (scene.background.type == compiler::Background::Type::Sky && sky.sun_disc) {
    lights.push_back(light_of(sky.sun, false, dvec3(Sky(sky).sun_irradiance()), kSunRadius));
  }
  for (const AreaLight& light : scene.area_lights) {
    const Material& material = scene.materials[light.material];
    lights.push_back(light_of(light.translation + scene.origin, true,
                              shown_area(light) * material.emission * material.emission_luminance, radius_of(light)));
  }
  if (lights.size() > kMaxLights) lights.resize(kMaxLights);
  return lights;
}

// Returns the gradient whose lower and upper halves have the means of a background image's. Grey if the image is too
// large to be read each time that the scene changes.
std::pair<dvec3, dvec3> means_of(const compiler::Background::Image& background) {
  const std::pair<dvec3, dvec3> grey = {dvec3(0.5), dvec3(0.5)};
  std::error_code error;
  if (!(std::filesystem::file_size(background.file, error) <= kMaxBackground)) return grey;
  const auto read = read_environment(background.file, {16.0 * kMaxBackground});
  const auto* image = std::get_if<EnvironmentImage>(&read);
  if (image == nullptr) return grey;
  dvec3 sums[2] = {dvec3(0), dvec3(0)};
  double weights[2] = {0, 0};
  for (int y = 0; y < image->height; ++y) {
    const std::size_t half = 2 * y < image->height ? 1 : 0;
    // Rows near the poles show less of the sphere.
    const double weight = vm::real::sin(std::numbers::pi * (y + 0.5) / image->height);
    for (int x = 0; x < image->width; ++x) {
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image->width) + static_cast<std::size_t>(x);
      sums[half] += weight * dvec3(image->pixels[at]);
      weights[half] += weight;
    }
  }
  const auto mean = [&](int half) { return background.strength * sums[half] / std::max(weights[half], 1e-9); };
  // The means of a gradient's halves are half as far apart as its ends.
  const dvec3 down = mean(0), up = mean(1), more = (up - down) / 2.0;
  return {glm::max(down - more, 0.0), glm::max(up + more, 0.0)};
}

// Returns the background straight down and straight up.
std::pair<dvec3, dvec3> background_of(const compiler::Background& background) {
  if (background.type == compiler::Background::Type::Gradient) return {background.bottom, background.top};
  if (background.type == compiler::Background::Type::Image) return means_of(background.image);
  const Sky sky(background.sky);
  return {dvec3(sky.radiance({0, -1, 0})), dvec3(sky.radiance({0, 1, 0}))};
}

// Returns the box that a slice shows: the bounded parts of the scene along an axis without end, or what the camera
// looks at if there are none.
compiler::Box slice_box(const CompiledScene& scene, const compiler::Camera& camera) {
  compiler::Box box = scene.bound;
  const dvec3 reach(glm::length(camera.target - camera.position));
  const bool has_parts = !scene.contents.empty() && scene.contents.finite();
  const compiler::Box instead =
      has_parts ? scene.contents : compiler::Box{camera.target - reach, camera.target + reach};
  for (int axis = 0; axis < 3; ++axis) {
    if (box.lo[axis] < box.hi[axis] && std::isfinite(box.hi[axis] - box.lo[axis])) continue;
    box.lo[axis] = instead.lo[axis], box.hi[axis] = instead.hi[axis];
  }
  return {box.lo + scene.origin, box.hi + scene.origin};
}

json finite_list(dvec3 v) { return list(glm::clamp(v, -kEndless, kEndless)); }

// Returns the bits of numbers, because JSON has no infinity.
json bits_of(const std::vector<float>& numbers) {
  json bits = json::array();
  for (const float number : numbers) bits.push_back(std::bit_cast<std::uint32_t>(number));
  return bits;
}

// Precedes the scene's functions. {0}: vectors of numbers, {1}: surfaces.
constexpr std::string_view kHead = R"(const int kNumbers = {0}, kSurfaces = {1};
#ifdef COPY_NUMBERS
layout(std140) uniform scene_block {{ vec4 u_numbers[kNumbers]; }};
vec4 scene_numbers[kNumbers];
#else
layout(std140) uniform scene_block {{ vec4 scene_numbers[kNumbers]; }};
#endif

)";

std::string shader_of(const CompiledScene& scene, const compiler::GlslTemplate& glsl) {
  return fmt::format(fmt::runtime(kHead), glsl.numbers.size() / 4, std::max<std::size_t>(1, scene.surfaces.size())) +
         glsl.text + '\n' + std::string(kLiveShader);
}

}  // namespace

json live_scene(const CompiledScene& scene) {
  const std::vector<json> lights = lights_of(scene);
  const auto [bottom, top] = background_of(scene.background);
  const compiler::Camera camera = placed_camera(scene);
  json surfaces = json::array();
  const std::vector<MaterialPoint> materials = mean_materials(scene, camera);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    surfaces.push_back(surface_of(scene, scene.surfaces[i], materials[i]));
  }
  const compiler::Box slice = slice_box(scene, camera);
  const dvec3 margin = kMargin * (slice.hi - slice.lo);
  const compiler::GlslTemplate glsl = compiler::emit_glsl_template(scene, "scene");
  return {{"summary", scene.summary},
          {"camera", camera_of(scene, camera)},
          {"bottom", list(bottom)},
          {"top", list(top)},
          {"lights", lights},
          {"box", {finite_list(scene.bound.lo + scene.origin), finite_list(scene.bound.hi + scene.origin)}},
          {"slice", {list(slice.lo), list(slice.hi)}},
          {"sliceBox", {list(slice.lo - margin), list(slice.hi + margin)}},
          {"surfaces", surfaces},
          {"far", scene.settings.far.value_or(kFar * glm::length(camera.target - camera.position))},
          {"inverseLipschitz",
           std::isfinite(scene.lipschitz) ? 1 / std::max(scene.lipschitz, kLeastLipschitz) : kGuessedStep},
          {"exposure", vm::real::exp(scene.film.exposure * std::numbers::ln2)},
          {"numbers", bits_of(glsl.numbers)},
          {"shader", shader_of(scene, glsl)}};
}

json live_exactness(const CompiledScene& scene) {
  const std::vector<compiler::Exactness> all = exactness_of_surfaces(scene);
  std::vector<std::uint32_t> packed(std::max<std::size_t>(1, (all.size() + 15) / 16));
  for (std::size_t i = 0; i < all.size(); ++i) {
    packed[i / 16] |= static_cast<std::uint32_t>(all[i]) << (2 * (i % 16));
  }
  return packed;
}

}  // namespace fathom::runtime
