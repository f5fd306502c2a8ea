#include "runtime/light/light_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "compiler/geometry/box.h"

namespace fathom::runtime {
namespace {

// Returns the cosine of max(0, a - b) for angles in [0, pi] given by their cosines.
float cosine_of_difference(float cos_a, float cos_b) {
  if (cos_a >= cos_b) return 1;
  const auto sine = [](float c) { return std::sqrt(std::max(0.0f, 1 - c * c)); };
  return cos_a * cos_b + sine(cos_a) * sine(cos_b);
}

// kSlack: for lights that shine past the edge of their cone by rounding. kMinFacing: keeps lights at the edge of
// their cone from being sampled too rarely.
constexpr float kSlack = 1e-4f, kMinFacing = 0.05f;

bool everywhere(const LightBounds& light) { return light.cos_spread <= -1; }

// Returns the bounds of all members together.
LightBounds merge(std::span<const std::uint32_t> members, const std::vector<LightBounds>& lights) {
  LightBounds out;
  compiler::Box box;
  bool directed = true;
  glm::dvec3 axis(0);
  const glm::dvec3 reference(lights[members[0]].axis);
  const auto aligned = [&](const LightBounds& light) {
    const glm::dvec3 own(light.axis);
    return light.two_sided && glm::dot(own, reference) < 0 ? -own : own;
  };
  for (const std::uint32_t member : members) {
    const LightBounds& light = lights[member];
    box = unite(box, {light.centre - light.radius, light.centre + light.radius});
    out.intensity += light.intensity;
    directed = directed && !everywhere(light) && light.two_sided == lights[members[0]].two_sided;
    axis += aligned(light);
  }
  out.centre = 0.5 * (box.lo + box.hi);
  for (const std::uint32_t member : members) {
    out.radius = std::max(out.radius, glm::length(lights[member].centre - out.centre) + lights[member].radius);
  }
  if (!directed || !(glm::dot(axis, axis) > 1e-6)) return out;
  out.axis = glm::vec3(glm::normalize(axis));
  out.two_sided = lights[members[0]].two_sided;
  out.cos_spread = out.cos_emission = 1;
  for (const std::uint32_t member : members) {
    const LightBounds& light = lights[member];
    const float apart = std::clamp(glm::dot(glm::vec3(aligned(light)), out.axis), -1.0f, 1.0f);
    // cos(a + b). Beyond half a turn the lights face everywhere.
    const float sines = std::sqrt((1 - apart * apart) * (1 - light.cos_spread * light.cos_spread));
    const float sum = apart + light.cos_spread > 0 ? apart * light.cos_spread - sines : -1;
    out.cos_spread = std::min(out.cos_spread, sum - kSlack);
    out.cos_emission = std::min(out.cos_emission, light.cos_emission);
  }
  return out;
}

}  // namespace

float importance(const LightBounds& light, const LightSampleContext& context) {
  const glm::vec3 way(light.centre - context.position);
  const auto radius = static_cast<float>(light.radius);
  const float d2 = glm::dot(way, way), r2 = radius * radius;
  if (!(std::max(d2, r2) > 0)) return 0;
  const float strength = light.intensity / std::max(d2, r2);
  if (d2 <= r2) return strength;
  const glm::vec3 wi = way / std::sqrt(d2);
  const float cos_ball = std::sqrt(1 - r2 / d2);
  float arriving = glm::dot(context.normal, wi);
  if (context.both_sides) arriving = std::abs(arriving);
  arriving = cosine_of_difference(arriving, cos_ball);
  if (!(arriving > 0)) return 0;
  if (everywhere(light)) return strength * arriving;
  float leaving = -glm::dot(light.axis, wi);
  if (light.two_sided) leaving = std::abs(leaving);
  leaving = cosine_of_difference(cosine_of_difference(leaving, light.cos_spread), cos_ball);
  if (leaving < light.cos_emission - kSlack) return 0;
  return strength * arriving * std::max(leaving, kMinFacing);
}

LightTree::LightTree(std::vector<LightBounds> lights) : lights_(std::move(lights)) {
  order_.resize(lights_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  const std::size_t count = lights_.size();
  if (count > 0) build(0, static_cast<std::uint32_t>(count), count <= kFewLights ? kFewLights : kLeafLights);
  slot_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) slot_[order_[i]] = i;
}

// The recursion's depth is the logarithm of the number of lights.
void LightTree::build(std::uint32_t first, std::uint32_t count, std::size_t max_in_leaf) {
  const std::span<std::uint32_t> members = std::span(order_).subspan(first, count);
  const std::size_t self = nodes_.size();
  nodes_.push_back({merge(members, lights_), first, count});
  if (count <= max_in_leaf) return;
  compiler::Box centres;
  for (const std::uint32_t member : members)
    centres = unite(centres, {lights_[member].centre, lights_[member].centre});
  const glm::dvec3 size = centres.hi - centres.lo;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  std::nth_element(members.begin(), members.begin() + half, members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(lights_[a].centre[axis], a) < std::tuple(lights_[b].centre[axis], b);
  });
  build(first, half, max_in_leaf);
  nodes_[self].second_child = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half, max_in_leaf);
}

std::optional<LightTree::SampledLight> LightTree::sample(const LightSampleContext& context, float u) const {
  if (empty()) return std::nullopt;
  double rest = static_cast<double>(u);
  float pmf = 1;
  std::uint32_t at = 0;
  while (nodes_[at].second_child != 0) {
    const float left = importance(nodes_[at + 1].bounds, context),
                right = importance(nodes_[nodes_[at].second_child].bounds, context);
    if (!(left + right > 0)) return std::nullopt;
    const float share = left / (left + right);
    const bool go_left = rest < static_cast<double>(share);
    const float taken = go_left ? share : 1 - share;
    rest = (go_left ? rest : rest - static_cast<double>(share)) / static_cast<double>(taken);
    pmf *= taken;
    at = go_left ? at + 1 : nodes_[at].second_child;
  }
  const Node& leaf = nodes_[at];
  std::array<float, std::max(kFewLights, kLeafLights)> importances;
  float all = 0;
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    importances[i] = importance(lights_[order_[leaf.first + i]], context);
    all += importances[i];
  }
  if (!(all > 0)) return std::nullopt;
  double sought = rest * static_cast<double>(all);
  std::optional<SampledLight> last;
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    if (!(importances[i] > 0)) continue;
    last = SampledLight{order_[leaf.first + i], pmf * (importances[i] / all)};
    if (sought < static_cast<double>(importances[i])) break;
    sought -= static_cast<double>(importances[i]);
  }
  return last;
}

float LightTree::pmf(const LightSampleContext& context, std::uint32_t light) const {
  const std::uint32_t slot = slot_[light];
  float pmf = 1;
  std::uint32_t at = 0;
  while (nodes_[at].second_child != 0) {
    const float left = importance(nodes_[at + 1].bounds, context),
                right = importance(nodes_[nodes_[at].second_child].bounds, context);
    if (!(left + right > 0)) return 0;
    const float share = left / (left + right);
    const bool go_left = slot < nodes_[nodes_[at].second_child].first;
    pmf *= go_left ? share : 1 - share;
    at = go_left ? at + 1 : nodes_[at].second_child;
  }
  const float all = total_importance_of(nodes_[at], context);
  return all > 0 ? pmf * (importance(lights_[light], context) / all) : 0;
}

float LightTree::total_importance(const LightSampleContext& context) const {
  if (empty()) return 0;
  return nodes_[0].second_child == 0 ? total_importance_of(nodes_[0], context)
                                     : importance(nodes_[0].bounds, context);
}

float LightTree::total_importance_of(const Node& leaf, const LightSampleContext& context) const {
  float sum = 0;
  for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) sum += importance(lights_[order_[i]], context);
  return sum;
}

}  // namespace fathom::runtime
