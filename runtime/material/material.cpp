#include "runtime/material/material.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "runtime/base/elementary.h"
#include "runtime/material/pattern.h"

namespace fathom::runtime {
namespace {

using compiler::MaterialNumbers;

// Maximum absorption of a medium, per scene unit: beyond it no light is left anyway.
constexpr float kLargestAbsorption = 1e18f;

// Inverts Beer and Lambert's law: returns the absorption after which `left` of the light remains at `depth` > 0.
glm::vec3 absorption_for(glm::vec3 left, float depth) {
  return glm::min(-log(left) / depth, glm::vec3(kLargestAbsorption));
}

void put_transmission(const MaterialNumbers& n, MaterialType type, MaterialPoint& point) {
  if (type == MaterialType::Transparent) {
    point.transmission = 1;
    point.roughness = 0;
    point.transmission_color = point.base_color;
  } else if (const auto depth = static_cast<float>(n.transmission_depth); depth > 0) {
    point.absorption = absorption_for(point.transmission_color, depth);
    point.transmission_color = glm::vec3(1);
  }
}

// Closes the holes of a material that fills a body: a path that came in by a hole would leave by refraction, brighter
// than it came.
void close(MaterialPoint& point) {
  if (point.has_interior()) point.opacity = 1;
}

MaterialPoint to_point(const MaterialNumbers& n, MaterialType type, bool thin_walled) {
  MaterialPoint point;
  point.type = type;
  point.thin_walled = thin_walled;
#define PARAMETER(Type, member, ...) point.member = MaterialPoint::Type(n.member);
#define COMBINED(...)
#include "compiler/scene/material_parameters.def"
  point.base_color = glm::vec3(n.base_weight * n.color);
  point.emission = glm::vec3(n.emission_luminance * n.emission);
  put_transmission(n, type, point);
  close(point);
  return point;
}

// Replaces a stand-in by a texture's value, component by component if the component is not NaN.
void put(MaterialNumbers& numbers, const compiler::TexturedParameter& row, glm::dvec3 value) {
  const auto fit = [&](double given, double stand_in) {
    return given == given ? std::clamp(given, row.least, row.most) : stand_in;
  };
  if (const auto* number = std::get_if<compiler::MaterialNumber>(&row.parameter)) {
    numbers.*(*number) = fit(value.x, numbers.*(*number));
  } else {
    glm::dvec3& color = numbers.*std::get<compiler::MaterialColor>(row.parameter);
    for (int i = 0; i < 3; ++i) color[i] = fit(value[i], color[i]);
  }
}

// True if a texture of the parameter may make the surface let light straight through.
bool may_open(const compiler::TexturedParameter& row) {
  const auto* number = std::get_if<compiler::MaterialNumber>(&row.parameter);
  return number && (*number == &MaterialNumbers::opacity || *number == &MaterialNumbers::transmission);
}

// (1 - 1/7)^5: the part of the rest to 1 that Schlick's approximation adds at F82's angle.
constexpr float kEdge = (6.0f * 6 * 6 * 6 * 6) / (7.0f * 7 * 7 * 7 * 7);

}  // namespace

// Light crosses the coat once, so that the tint is the square root of coat_color.
glm::vec3 MaterialPoint::emitted_radiance() const {
  if (coat_weight == 0) return emission * opacity;
  return emission * opacity * glm::sqrt(glm::mix(glm::vec3(1), coat_color, coat_weight));
}

MaterialPoint untextured_point(const compiler::Material& material) {
  return to_point(material, material.type, material.thin_walled);
}

Materials::Materials(const compiler::CompiledScene& scene)
    : scene_(&scene), uses_object_space_(compiler::in_object_space(scene.materials, scene.textures)) {
  for (const compiler::Material& m : scene.materials) {
    points_.push_back(untextured_point(m));
    any_null_transmission_ |= m.thin_walled || points_.back().has_null_transmission() ||
                              std::any_of(m.textured.begin(), m.textured.end(), may_open);
  }
}

MaterialPoint Materials::at(std::uint32_t material, glm::dvec3 position, glm::dvec3 place,
                            vm::Workspace& workspace) const {
  const compiler::Material& m = scene_->materials[material];
  if (m.textured.empty()) return points_[material];
  MaterialNumbers numbers = m;
  const TexturePoint point{position + scene_->origin, place};
  for (const compiler::TexturedParameter& row : m.textured) {
    put(numbers, row, value(row.texture, point, workspace));
  }
  return to_point(numbers, m.type, m.thin_walled);
}

// The recursion is shallow: patterns nest a few levels at most (compiler/frontend/elaborate/textures.cpp).
glm::dvec3 Materials::value(std::uint32_t texture, const TexturePoint& point, vm::Workspace& workspace) const {
  const compiler::Texture& node = scene_->textures[texture];
  if (const auto* constant = std::get_if<glm::dvec3>(&node)) return *constant;
  if (const auto* formula = std::get_if<compiler::TextureFormula>(&node)) {
    const auto part = [&](std::size_t i) {
      return vm::evaluate_distance(scene_->formulas[formula->programs[i]], point.in(formula->space), workspace);
    };
    const bool grey = formula->programs[0] == formula->programs[1] && formula->programs[1] == formula->programs[2];
    return grey ? glm::dvec3(part(0)) : glm::dvec3(part(0), part(1), part(2));
  }
  const auto& pattern = std::get<compiler::Pattern>(node);
  const double t = pattern_value(pattern, point.in(pattern.space));
  if (t <= 0) return value(pattern.a, point, workspace);
  if (t >= 1) return value(pattern.b, point, workspace);
  return value(pattern.a, point, workspace) * (1 - t) + value(pattern.b, point, workspace) * t;
}

MaterialPoint to_principled(const MaterialPoint& m) {
  MaterialPoint p = m;
  p.type = MaterialType::Principled;
  switch (m.type) {
    case MaterialType::Diffuse:
    case MaterialType::Emissive:
      p.specular_weight = 0;
      break;
    case MaterialType::Specular:
      p.metalness = 1;
      p.roughness = 0;
      p.specular_color = m.base_color / (m.base_color + (1.0f - m.base_color) * kEdge);
      break;
    case MaterialType::Transparent:
      p.transmission = 1;
      p.roughness = 0;
      p.transmission_color = m.base_color;
      break;
    case MaterialType::Principled:
      break;
  }
  return p;
}

MaterialPoint mix(const MaterialPoint& a, const MaterialPoint& b, float t) {
  if (!(t > 0)) return a;
  if (t >= 1) return b;
  if (a.type != b.type) return mix(to_principled(a), to_principled(b), t);
  const auto between = [t](auto from, auto to) { return from * (1 - t) + to * t; };
  MaterialPoint m = a;
  m.thin_walled = t < 0.5f ? a.thin_walled : b.thin_walled;
  m.base_color = between(a.base_color, b.base_color);
  m.emission = between(a.emission, b.emission);
#define PARAMETER(Type, member, ...) m.member = between(a.member, b.member);
#define COMBINED(...)
#include "compiler/scene/material_parameters.def"
  close(m);
  return m;
}

glm::vec3 albedo_of(const MaterialPoint& m) {
  glm::vec3 color = m.base_color;
  if (m.type == MaterialType::Principled)
    color = color * (1 - m.transmission) + m.transmission_color * m.transmission;
  return glm::min(color + m.emitted_radiance(), glm::vec3(1));
}

}  // namespace fathom::runtime
