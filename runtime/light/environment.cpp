#include "runtime/light/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "runtime/base/color.h"
#include "runtime/base/elementary.h"
#include "runtime/sampling/warp.h"
#include "vm/number/real.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

constexpr float kPiFloat = std::numbers::pi_v<float>;
// Maximum change of a unit vector by rounding to floats: half of 2^-24 along each axis.
constexpr double kRounding = 0x1p-24;
// Minimum angle of a disc, degrees. Directions in float would make the disc larger by kRounding all round: at this
// angle by 0.03 % of its area.
constexpr double kMinDisc = 0.02;

// Returns mean luminances of cells, from the middles of the quarters of each cell.
template <class Radiance>
std::vector<float> cell_luminance(int width, int height, const Radiance& radiance) {
  std::vector<float> out;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float sum = 0;
      for (int i = 0; i < 4; ++i) {
        const glm::dvec2 uv((x + 0.25 + 0.5 * (i & 1)) / width, (y + 0.25 + 0.5 * (i >> 1)) / height);
        sum += luminance(radiance(glm::vec3(from_latlong(uv))));
      }
      out.push_back(sum / 4);
    }
  }
  return out;
}

// Returns the share of the gradient's upper colour in a direction of this height.
double gradient_share(float height) { return std::clamp((static_cast<double>(height) + 1) / 2, 0.0, 1.0); }

}  // namespace

Environment::Environment(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentMap> map)
    : type_(scene.background.type), bottom_(scene.background.bottom), top_(scene.background.top) {
  const compiler::Background& background = scene.background;
  if (type_ == Type::Image) {
    CHECK(map != nullptr, "the scene's background is a picture, which must be read first");
    strength_ = static_cast<float>(background.image.strength);
    const double turn = background.image.rotate / 360;
    turn_ = static_cast<float>(std::ceil(turn) - turn);
    light_ = std::shared_ptr<const UnevenLight>(map, &map->light);
  }
  if (type_ == Type::Sky) {
    constexpr int kRows = 64;
    sky_.emplace(background.sky);
    light_ = std::make_shared<UnevenLight>(
        2 * kRows, kRows, cell_luminance(2 * kRows, kRows, [&](glm::vec3 w) { return sky_->radiance(w); }));
    if (background.sky.sun_disc) add_disc(background.sky.sun, kSunAngle, sky_->sun_irradiance());
  }
  for (const compiler::Light& light : scene.lights) {
    if (light.type != compiler::Light::Type::Directional || light.angle == 0) continue;
    add_disc(-light.direction, light.angle, glm::vec3(light.intensity));
  }
}

// A disc of radiance L gives an irradiance of L pi sin^2 of its angle to a surface that faces it.
void Environment::add_disc(glm::dvec3 direction, double degrees, glm::vec3 irradiance) {
  const double sine = vm::real::sin(std::max(degrees, kMinDisc) * vm::real::kDegree), sin2 = sine * sine;
  if (!(luminance(irradiance) > 0)) return;
  const double height = sin2 / (1 + std::sqrt(1 - sin2));
  discs_.push_back({direction, height, std::sqrt(2 * height) + kRounding,
                    irradiance / static_cast<float>(std::numbers::pi * sin2), luminance(irradiance)});
}

// Compares chords, because the cosine of a small angle has few digits.
bool Environment::Disc::contains(glm::vec3 w) const {
  const glm::dvec3 chord = glm::normalize(glm::dvec3(w)) - direction;
  return glm::dot(chord, chord) <= rim * rim;
}

void Environment::set_gradient(std::size_t count, DirectionRows& rows) const {
  for (int channel = 0; channel < 3; ++channel) {
    const double bottom = bottom_[channel], top = top_[channel];
    for (std::size_t i = 0; i < count; ++i) {
      const double share = gradient_share(rows.direction[1][i]);
      rows.light[i][channel] = static_cast<float>(bottom * (1 - share) + top * share);
    }
  }
}

void Environment::set_sky(std::size_t count, DirectionRows& rows) const {
  for (std::size_t i = 0; i < count; ++i) rows.set_radiance(i, sky_->radiance(rows.direction_of(i)));
}

void Environment::add_discs(std::size_t count, DirectionRows& rows) const {
  for (const Disc& disc : discs_) {
    for (std::size_t i = 0; i < count; ++i) {
      if (disc.contains(rows.direction_of(i))) rows.set_radiance(i, rows.radiance(i) + disc.radiance);
    }
  }
}

void Environment::look_up(std::size_t count, DirectionRows& rows) const {
  if (light_) light_->sphere.look_up(count, turn_, rows);
  complete(count, rows);
}

// Makes the radiance of the table that of the background with its discs.
void Environment::complete(std::size_t count, DirectionRows& rows) const {
  if (type_ == Type::Gradient) set_gradient(count, rows);
  if (type_ == Type::Sky) set_sky(count, rows);
  if (type_ == Type::Image && strength_ != 1) {
    for (std::size_t i = 0; i < count; ++i) rows.set_radiance(i, strength_ * rows.radiance(i));
  }
  if (!discs_.empty()) add_discs(count, rows);
}

float Environment::mean() const { return light_ ? strength_ * static_cast<float>(light_->sphere.mean()) : 0; }

float Environment::importance(const Disc& disc, const LightSampleContext& context) const {
  const float cosine = glm::dot(context.normal, glm::vec3(disc.direction));
  // A disc that the horizon cuts counts as far as it may rise above the horizon.
  const auto rise = static_cast<float>(std::sqrt(disc.height * (2 - disc.height)));
  return disc.irradiance * std::max(0.0f, (context.both_sides ? std::abs(cosine) : cosine) + rise);
}

float Environment::importance(const LightSampleContext& context) const {
  float sum = kPiFloat * mean();
  for (const Disc& disc : discs_) sum += importance(disc, context);
  return sum;
}

const Environment::Disc* Environment::choose_disc(const LightSampleContext& context, float choice) const {
  float rest = choice * importance(context) - kPiFloat * mean();
  const Disc* chosen = nullptr;
  for (const Disc& disc : discs_) {
    const float own = importance(disc, context);
    if (rest < 0 && (chosen != nullptr || mean() > 0)) break;
    if (own > 0) chosen = &disc;
    rest -= own;
  }
  return chosen;
}

glm::vec3 Environment::Disc::sample(glm::vec2 u) const {
  const double below = static_cast<double>(u.x) * height, sine = std::sqrt(below * (2 - below));
  const SinCos turn = sincos_turn(u.y);
  const FrameOf<double> frame(direction);
  return frame.to_world({sine * static_cast<double>(turn.cos), sine * static_cast<double>(turn.sin), 1 - below});
}

void Environment::sample(std::size_t count, EnvironmentSamples& samples) const {
  if (mean() > 0) light_->sphere.sample(count, samples.u, samples.v, turn_, samples.rows);
  if (!discs_.empty()) aim_at_discs(count, samples);
  complete(count, samples.rows);
}

void Environment::aim_at_discs(std::size_t count, EnvironmentSamples& samples) const {
  DirectionRows aimed;
  std::array<std::size_t, DirectionRows::kCapacity> place;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Disc* disc = choose_disc(*samples.context[i], samples.choice[i]);
    if (disc == nullptr) continue;
    aimed.set_direction(chosen, disc->sample({samples.u[i], samples.v[i]}));
    place[chosen++] = i;
  }
  if (light_) light_->sphere.look_up(chosen, turn_, aimed);
  for (std::size_t k = 0; k < chosen; ++k) {
    samples.rows.set_direction(place[k], aimed.direction_of(k));
    std::copy_n(aimed.light[k], 4, samples.rows.light[place[k]]);
  }
}

float Environment::pdf(const LightSampleContext& context, glm::vec3 direction, float density) const {
  if (discs_.empty()) return density;
  const float all = importance(context);
  if (!(all > 0)) return 0;
  float sum = kPiFloat * mean() * density;
  for (const Disc& disc : discs_) {
    if (!disc.contains(direction)) continue;
    sum += importance(disc, context) / (2 * kPiFloat * static_cast<float>(disc.height));
  }
  return sum / all;
}

}  // namespace fathom::runtime
