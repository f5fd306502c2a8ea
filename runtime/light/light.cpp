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
    boxes_.push_back(area_lights_.back().shape.box().value_or(BoxLight{}));
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

namespace {

// The queries that are answered together, and their probabilities.
struct ChosenQueries {
  std::size_t count = 0;
  std::array<std::size_t, LightQueries::kCapacity> query;
  std::array<float, LightQueries::kCapacity> probability;

  // Returns the new place.
  std::size_t add(std::size_t i, float p) {
    query[count] = i;
    probability[count] = p;
    return count++;
  }
};

float share_of(float choice, float share) { return std::min(choice / share, 0x1.fffffep-1f); }

}  // namespace

// Samples of the environment are drawn together, and those of boxes.
void Lights::sample(const LightQueries& queries, std::span<LightSample> samples) const {
  EnvironmentSamples beyond;
  BoxLightRows boxes;
  ChosenQueries of_beyond, of_boxes;
  for (std::size_t i = 0; i < queries.contexts.size(); ++i) {
    if (!queries.active[i]) continue;
    samples[i] = {};
    const LightSampleContext& context = queries.contexts[i];
    const SelectionProbabilities share = selection_probabilities(context);
    const float rest = queries.choice[i] - share.near;
    if (rest < 0) {
      const std::optional<LightTree::SampledLight> chosen =
          tree_.sample(context, share_of(queries.choice[i], share.near));
      if (!chosen) continue;
      const float probability = share.near * chosen->pmf;
      if (chosen->light < area_lights_.size() && area_lights_[chosen->light].shape.box()) {
        const std::size_t k = of_boxes.add(i, probability);
        boxes.set(k, chosen->light, context.position);
        boxes.u[k] = static_cast<double>(queries.u[i]);
        boxes.v[k] = static_cast<double>(queries.v[i]);
      } else {
        samples[i] = sample_near(context, chosen->light, {queries.u[i], queries.v[i]});
        samples[i].pdf *= probability;
      }
    } else if (rest < share.environment) {
      const std::size_t k = of_beyond.add(i, share.environment);
      beyond.context[k] = &context;
      beyond.choice[k] = share_of(rest, share.environment);
      beyond.u[k] = queries.u[i];
      beyond.v[k] = queries.v[i];
    } else if (rest - share.environment < share.directional) {  // the even part of the background is left to BSDFs
      samples[i] = sample_directional(context, (rest - share.environment) / share.directional);
      samples[i].pdf *= share.directional;
    }
  }
  if (of_boxes.count > 0) {
    sample_box_lights(boxes_, of_boxes.count, boxes);
    for (std::size_t k = 0; k < of_boxes.count; ++k) {
      const std::size_t i = of_boxes.query[k];
      samples[i] = box_sample(queries.contexts[i], boxes, k);
      samples[i].pdf *= of_boxes.probability[k];
    }
  }
  if (of_beyond.count == 0) return;
  environment_.sample(of_beyond.count, beyond);
  const DirectionRows& rows = beyond.rows;
  for (std::size_t k = 0; k < of_beyond.count; ++k) {
    LightSample& out = samples[of_beyond.query[k]];
    out.wi = rows.direction_of(k);
    out.radiance = rows.radiance(k);
    out.pdf = of_beyond.probability[k] * environment_.pdf(*beyond.context[k], out.wi, rows.density(k));
  }
}

LightSample Lights::sample_near(const LightSampleContext& context, std::uint32_t light, glm::vec2 u) const {
  if (light >= area_lights_.size()) return sample_delta(context, near_delta_lights_[light - area_lights_.size()]);
  const ShapeSample place = area_lights_[light].shape.sample(context.position, u);
  if (!(place.pdf > 0)) return {};
  const glm::dvec3 way = place.position - context.position;
  LightSample out = area_light_sample(context, light, way, glm::length(way), place.pdf);
  out.light_cosine = std::max(0.0f, -glm::dot(glm::vec3(place.normal), out.wi));
  return out;
}

LightSample Lights::box_sample(const LightSampleContext& context, const BoxLightRows& rows, std::size_t k) const {
  if (!(rows.pdf[k] > 0)) return {};
  const auto light = static_cast<std::uint32_t>(rows.light[k]);
  LightSample out = area_light_sample(context, light, rows.way_of(k), rows.distance[k], rows.pdf[k]);
  out.light_cosine = static_cast<float>(rows.cosine[k]);
  return out;
}

// All but the cosine.
LightSample Lights::area_light_sample(const LightSampleContext& context, std::uint32_t light, glm::dvec3 way,
                                      double distance, double pdf) const {
  const DiffuseAreaLight& area_light = area_lights_[light];
  if (!(distance > 0)) return {};
  if (area_light.touches_earlier && area_light_at(context.position + way) != light) return {};
  LightSample out;
  out.distance = distance;
  out.wi = glm::vec3(way / distance);
  out.radiance = area_light.radiance;
  out.pdf = static_cast<float>(pdf);
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
