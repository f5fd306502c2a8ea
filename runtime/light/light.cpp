#include "runtime/light/light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "runtime/base/color.h"
#include "runtime/material/material.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

// Minimum probability of near lights, and of those beyond the scene, when there are both: estimates may be far off.
constexpr float kMinLightShare = 0.25f;

float cosine_of_degrees(double degrees) { return static_cast<float>(vm::real::cos(degrees * vm::real::kDegree)); }

// Rises from 0 at the cone's edge to 1, smoothly.
float spot_falloff(float cosine, float outer, float inner) {
  if (cosine <= outer) return 0;
  if (cosine >= inner) return 1;
  const float t = (cosine - outer) / (inner - outer);
  return t * t * (3 - 2 * t);
}

// The projected area of a convex body is on average a quarter of its surface area (Cauchy). The projected area of a
// quad is known.
LightBounds bounds_of(const AreaLightShape& shape, glm::vec3 radiance) {
  LightBounds bounds{shape.centre(), shape.radius()};
  const bool quad = shape.area_light().shape == compiler::AreaLight::Shape::Quad;
  bounds.intensity = luminance(radiance) * static_cast<float>(quad ? shape.area() : shape.area() / 4);
  if (quad) {
    bounds.axis = glm::vec3(glm::normalize(shape.normal()));
    bounds.cos_spread = 1;
    bounds.two_sided = true;
  }
  return bounds;
}

}  // namespace

Lights::Lights(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentMap> map)
    : environment_(scene, std::move(map)), tree_({}) {
  std::vector<LightBounds> bounds;
  add_area_lights(scene, bounds);
  for (const compiler::Light& light : scene.lights) add_delta(light, bounds);
  tree_ = LightTree(std::move(bounds));
  all_near_ = directional_.empty() && !environment_.emits();
  if (tree_.empty() && directional_.empty() && environment_.is_uniform()) everywhere_ = selection_probabilities({});
  find_touching();
}

void Lights::add_area_lights(const compiler::CompiledScene& scene, std::vector<LightBounds>& bounds) {
  has_area_lights_.resize(scene.surfaces.size(), false);
  for (const compiler::AreaLight& area_light : scene.area_lights) {
    const compiler::Material& material = scene.materials[area_light.material];
    const glm::vec3 radiance = untextured_point(material).emitted_radiance();
    area_lights_.push_back({AreaLightShape(area_light), radiance, false});
    bounds.push_back(bounds_of(area_lights_.back().shape, radiance));
    has_area_lights_[area_light.surface] = true;
  }
}

void Lights::add_delta(const compiler::Light& light, std::vector<LightBounds>& bounds) {
  const float strength = luminance(glm::vec3(light.intensity));
  const bool directional = light.type == compiler::Light::Type::Directional;
  if (!(strength > 0) || (directional && light.angle > 0)) return;  // with an angle it is a disc of the environment
  DeltaLight delta{light};
  if (directional) {
    directional_.push_back(delta);
    return;
  }
  LightBounds bound;
  bound.centre = light.position;
  bound.intensity = strength;
  if (light.type == compiler::Light::Type::Spot) {
    delta.cos_outer = cosine_of_degrees(light.angle);
    delta.cos_inner = cosine_of_degrees(light.angle * (1 - light.blend));
    bound.axis = glm::vec3(light.direction);
    bound.cos_spread = 1;
    bound.cos_emission = delta.cos_outer;
  }
  near_delta_lights_.push_back(delta);
  bounds.push_back(bound);
}

double Lights::tolerance(const AreaLightShape& shape, glm::dvec3 place) const {
  const double largest = std::max({1.0, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  return 1e-4 * shape.radius() + 4e-6 * largest;
}

void Lights::find_touching() {
  for (std::uint32_t i = 0; i < area_lights_.size(); ++i) {
    const AreaLightShape& shape = area_lights_[i].shape;
    const double reach = shape.radius() + 2 * tolerance(shape, shape.centre());
    tree_.for_each_near(shape.centre(), reach,
                        [&](std::uint32_t other) { area_lights_[i].touches_earlier |= other < i; });
  }
}

std::optional<std::uint32_t> Lights::area_light_at(glm::dvec3 place) const {
  std::optional<std::uint32_t> first;
  const double widest = 4e-6 * std::max({1.0, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  const auto consider = [&](std::uint32_t i) {
    if (i >= area_lights_.size() || (first && *first <= i)) return;
    if (area_lights_[i].shape.distance(place) <= tolerance(area_lights_[i].shape, place)) first = i;
  };
  tree_.for_each_near(place, widest, consider);
  return first;
}

bool Lights::empty() const { return tree_.empty() && all_near_; }

bool Lights::has_choice() const { return !all_near_ || tree_.size() > 1; }

float Lights::directional_importance(const DeltaLight& delta, const LightSampleContext& context) const {
  const float cosine = -glm::dot(context.normal, glm::vec3(delta.light.direction));
  return luminance(glm::vec3(delta.light.intensity)) * std::max(0.0f, context.both_sides ? std::abs(cosine) : cosine);
}

Lights::SelectionProbabilities Lights::selection_probabilities(const LightSampleContext& context) const {
  if (everywhere_) return *everywhere_;
  if (all_near_) return {1, 0, 0};
  const float near = tree_.total_importance(context), environment = environment_.importance(context);
  float directional = 0;
  for (const DeltaLight& delta : directional_) directional += directional_importance(delta, context);
  if (!(near + environment + directional > 0)) return {0, 0, 0};
  const float beyond = environment + environment_.even_importance() + directional;
  float share = near / (near + beyond);
  if (near > 0 && beyond > 0) share = std::clamp(share, kMinLightShare, 1 - kMinLightShare);
  const float rest = beyond > 0 ? (1 - share) / beyond : 0;
  return {share, rest * environment, rest * directional};
}

// Samples of the environment are drawn together.
void Lights::sample(const LightQueries& queries, std::span<LightSample> samples) const {
  EnvironmentSamples beyond;
  std::array<std::size_t, EnvironmentSamples::kCapacity> place;
  std::array<float, EnvironmentSamples::kCapacity> probability;
  std::size_t count = 0;
  for (std::size_t i = 0; i < queries.contexts.size(); ++i) {
    if (!queries.active[i]) continue;
    const LightSampleContext& context = queries.contexts[i];
    const SelectionProbabilities share = selection_probabilities(context);
    const float rest = queries.choice[i] - share.near;
    if (rest < 0 || rest >= share.environment) {
      samples[i] = sample_others(context, share, queries.choice[i], {queries.u[i], queries.v[i]});
      continue;
    }
    beyond.context[count] = &context;
    beyond.choice[count] = std::min(rest / share.environment, 0x1.fffffep-1f);
    beyond.u[count] = queries.u[i];
    beyond.v[count] = queries.v[i];
    probability[count] = share.environment;
    place[count++] = i;
  }
  if (count == 0) return;
  environment_.sample(count, beyond);
  const DirectionRows& rows = beyond.rows;
  for (std::size_t k = 0; k < count; ++k) {
    LightSample& out = samples[place[k]] = {};
    out.wi = rows.direction_of(k);
    out.radiance = rows.radiance(k);
    out.pdf = probability[k] * environment_.pdf(*beyond.context[k], out.wi, rows.density(k));
  }
}

LightSample Lights::sample_others(const LightSampleContext& context, const SelectionProbabilities& share,
                                  float choice, glm::vec2 u) const {
  if (choice < share.near) {
    const std::optional<LightTree::SampledLight> chosen =
        tree_.sample(context, std::min(choice / share.near, 0x1.fffffep-1f));
    if (!chosen) return {};
    const bool area_light = chosen->light < area_lights_.size();
    LightSample out = area_light ? sample_area_light(context, chosen->light, u)
                                 : sample_delta(context, near_delta_lights_[chosen->light - area_lights_.size()]);
    out.pdf *= share.near * chosen->pmf;
    return out;
  }
  const float rest = choice - share.near - share.environment;
  if (!(rest < share.directional)) return {};  // the even part of the background is left to BSDF sampling
  LightSample out = sample_directional(context, std::max(0.0f, rest) / share.directional);
  out.pdf *= share.directional;
  return out;
}

LightSample Lights::sample_area_light(const LightSampleContext& context, std::uint32_t index, glm::vec2 u) const {
  const DiffuseAreaLight& area_light = area_lights_[index];
  const ShapeSample place = area_light.shape.sample(context.position, u);
  if (!(place.pdf > 0)) return {};
  if (area_light.touches_earlier && area_light_at(place.position) != index) return {};
  const glm::dvec3 way = place.position - context.position;
  LightSample out;
  out.distance = glm::length(way);
  if (!(out.distance > 0)) return {};
  out.wi = glm::vec3(way / out.distance);
  out.radiance = area_light.radiance;
  out.pdf = static_cast<float>(place.pdf);
  out.light_cosine = std::max(0.0f, -glm::dot(glm::vec3(place.normal), out.wi));
  out.material = area_light.shape.area_light().material;
  out.surface = area_light.shape.area_light().surface;
  return out;
}

LightSample Lights::sample_delta(const LightSampleContext& context, const DeltaLight& delta) const {
  const glm::dvec3 way = delta.light.position - context.position;
  LightSample out;
  out.distance = glm::length(way);
  if (!(out.distance > 0)) return {};
  out.wi = glm::vec3(way / out.distance);
  out.radiance = glm::vec3(delta.light.intensity / (out.distance * out.distance));
  if (delta.light.type == compiler::Light::Type::Spot) {
    out.radiance *=
        spot_falloff(-glm::dot(out.wi, glm::vec3(delta.light.direction)), delta.cos_outer, delta.cos_inner);
  }
  out.pdf = luminance(out.radiance) > 0 ? 1 : 0;
  out.delta = true;
  return out;
}

LightSample Lights::sample_directional(const LightSampleContext& context, float choice) const {
  float all = 0;
  for (const DeltaLight& delta : directional_) all += directional_importance(delta, context);
  float rest = choice * all;
  LightSample out;
  for (const DeltaLight& delta : directional_) {
    const float own = directional_importance(delta, context);
    if (!(own > 0)) continue;
    out.wi = -glm::vec3(delta.light.direction);
    out.radiance = glm::vec3(delta.light.intensity);
    out.pdf = own / all;
    out.delta = true;
    if (rest < own) break;
    rest -= own;
  }
  return out;
}

float Lights::pdf_of_hit(const LightSampleContext& context, std::uint32_t surface, glm::dvec3 hit) const {
  if (surface >= has_area_lights_.size() || !has_area_lights_[surface]) return 0;
  const std::optional<std::uint32_t> area_light = area_light_at(hit);
  if (!area_light || area_lights_[*area_light].shape.area_light().surface != surface) return 0;
  const double pdf = area_lights_[*area_light].shape.pdf(context.position, hit);
  if (!(pdf > 0)) return 0;
  return selection_probabilities(context).near * tree_.pmf(context, *area_light) * static_cast<float>(pdf);
}

float Lights::pdf_of_background(const LightSampleContext& context, glm::vec3 direction, float density) const {
  const float share = selection_probabilities(context).environment;
  return share > 0 ? share * environment_.pdf(context, direction, density) : 0;
}

}  // namespace fathom::runtime
