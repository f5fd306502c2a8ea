#include "runtime/light/light.h"

#include <algorithm>
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
constexpr float kLeastShare = 0.25f;

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
LightBounds bounds_of(const LampShape& shape, glm::vec3 radiance) {
  LightBounds bounds{shape.centre(), shape.radius()};
  const bool quad = shape.lamp().shape == compiler::Lamp::Shape::Quad;
  bounds.intensity = luminance(radiance) * static_cast<float>(quad ? shape.area() : shape.area() / 4);
  if (quad) {
    bounds.axis = glm::vec3(glm::normalize(shape.normal()));
    bounds.cos_spread = 1;
    bounds.two_sided = true;
  }
  return bounds;
}

}  // namespace

Lights::Lights(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentImage> image)
    : environment_(scene, std::move(image)), tree_({}) {
  std::vector<LightBounds> bounds;
  add_lamps(scene, bounds);
  for (const compiler::Light& light : scene.lights) add_delta(light, bounds);
  tree_ = LightTree(std::move(bounds));
  all_near_ = directional_.empty() && !environment_.emits();
  find_touching();
}

void Lights::add_lamps(const compiler::CompiledScene& scene, std::vector<LightBounds>& bounds) {
  has_lamps_.resize(scene.surfaces.size(), false);
  for (const compiler::Lamp& lamp : scene.lamps) {
    const compiler::Material& material = scene.materials[lamp.material];
    const glm::vec3 radiance = typical_point(material).emitted();
    lamps_.push_back({LampShape(lamp), radiance, false});
    bounds.push_back(bounds_of(lamps_.back().shape, radiance));
    has_lamps_[lamp.surface] = true;
  }
}

void Lights::add_delta(const compiler::Light& light, std::vector<LightBounds>& bounds) {
  const float strength = luminance(glm::vec3(light.intensity));
  const bool directional = light.type == compiler::Light::Type::Directional;
  if (!(strength > 0) || (directional && light.angle > 0)) return;  // with an angle it is a disc of the environment
  Delta delta{light};
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
  near_deltas_.push_back(delta);
  bounds.push_back(bound);
}

double Lights::tolerance(const LampShape& shape, glm::dvec3 place) const {
  const double largest = std::max({1.0, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  return 1e-4 * shape.radius() + 4e-6 * largest;
}

void Lights::find_touching() {
  for (std::uint32_t i = 0; i < lamps_.size(); ++i) {
    const LampShape& shape = lamps_[i].shape;
    const double reach = shape.radius() + 2 * tolerance(shape, shape.centre());
    tree_.near(shape.centre(), reach, [&](std::uint32_t other) { lamps_[i].touches_earlier |= other < i; });
  }
}

std::optional<std::uint32_t> Lights::lamp_at(glm::dvec3 place) const {
  std::optional<std::uint32_t> first;
  const double widest = 4e-6 * std::max({1.0, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  const auto consider = [&](std::uint32_t i) {
    if (i >= lamps_.size() || (first && *first <= i)) return;
    if (lamps_[i].shape.distance(place) <= tolerance(lamps_[i].shape, place)) first = i;
  };
  tree_.near(place, widest, consider);
  return first;
}

bool Lights::empty() const { return tree_.empty() && all_near_; }

bool Lights::has_choice() const { return !all_near_ || tree_.size() > 1; }

float Lights::directional_estimate(const Delta& delta, const LightQuery& query) const {
  const float cosine = -glm::dot(query.normal, glm::vec3(delta.light.direction));
  return luminance(glm::vec3(delta.light.intensity)) * std::max(0.0f, query.both_sides ? std::abs(cosine) : cosine);
}

Lights::Shares Lights::shares(const LightQuery& query) const {
  if (all_near_) return {1, 0, 0};
  const float near = tree_.total(query), environment = environment_.estimate(query);
  float directional = 0;
  for (const Delta& delta : directional_) directional += directional_estimate(delta, query);
  const float beyond = environment + directional;
  if (!(near + beyond > 0)) return {0, 0, 0};
  float share = near / (near + beyond);
  if (near > 0 && beyond > 0) share = std::clamp(share, kLeastShare, 1 - kLeastShare);
  const float rest = beyond > 0 ? (1 - share) / beyond : 0;
  return {share, rest * environment, rest * directional};
}

LightSample Lights::sample(const LightQuery& query, float choice, glm::vec2 u) const {
  const Shares share = shares(query);
  if (choice < share.near) {
    const std::optional<LightTree::Choice> chosen =
        tree_.choose(query, std::min(choice / share.near, 0x1.fffffep-1f));
    if (!chosen) return {};
    const bool lamp = chosen->light < lamps_.size();
    LightSample out = lamp ? sample_lamp(query, chosen->light, u)
                           : sample_delta(query, near_deltas_[chosen->light - lamps_.size()]);
    out.pdf *= share.near * chosen->probability;
    return out;
  }
  choice -= share.near;
  if (share.environment > 0 && (choice < share.environment || !(share.directional > 0))) {
    LightSample out;
    out.wi = environment_.sample(query, std::min(choice / share.environment, 0x1.fffffep-1f), u);
    out.radiance = environment_.radiance(out.wi);
    out.pdf = share.environment * environment_.pdf(query, out.wi);
    return out;
  }
  if (!(share.directional > 0)) return {};
  LightSample out = sample_directional(query, std::max(0.0f, choice - share.environment) / share.directional);
  out.pdf *= share.directional;
  return out;
}

LightSample Lights::sample_lamp(const LightQuery& query, std::uint32_t index, glm::vec2 u) const {
  const LampLight& lamp = lamps_[index];
  const ShapeSample place = lamp.shape.sample(query.position, u);
  if (!(place.pdf > 0)) return {};
  if (lamp.touches_earlier && lamp_at(place.position) != index) return {};
  const glm::dvec3 way = place.position - query.position;
  LightSample out;
  out.distance = glm::length(way);
  if (!(out.distance > 0)) return {};
  out.wi = glm::vec3(way / out.distance);
  out.radiance = lamp.radiance;
  out.pdf = static_cast<float>(place.pdf);
  out.lamp_cosine = std::max(0.0f, -glm::dot(glm::vec3(place.normal), out.wi));
  out.material = lamp.shape.lamp().material;
  out.surface = lamp.shape.lamp().surface;
  return out;
}

LightSample Lights::sample_delta(const LightQuery& query, const Delta& delta) const {
  const glm::dvec3 way = delta.light.position - query.position;
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

LightSample Lights::sample_directional(const LightQuery& query, float choice) const {
  float all = 0;
  for (const Delta& delta : directional_) all += directional_estimate(delta, query);
  float rest = choice * all;
  LightSample out;
  for (const Delta& delta : directional_) {
    const float own = directional_estimate(delta, query);
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

float Lights::pdf_of_hit(const LightQuery& query, std::uint32_t surface, glm::dvec3 hit) const {
  if (surface >= has_lamps_.size() || !has_lamps_[surface]) return 0;
  const std::optional<std::uint32_t> lamp = lamp_at(hit);
  if (!lamp || lamps_[*lamp].shape.lamp().surface != surface) return 0;
  const double pdf = lamps_[*lamp].shape.pdf(query.position, hit);
  if (!(pdf > 0)) return 0;
  return shares(query).near * tree_.probability(query, *lamp) * static_cast<float>(pdf);
}

float Lights::pdf_of_background(const LightQuery& query, glm::vec3 direction) const {
  const float share = shares(query).environment;
  return share > 0 ? share * environment_.pdf(query, direction) : 0;
}

}  // namespace fathom::runtime
