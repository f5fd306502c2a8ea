#include "runtime/light/environment.h"

#include <algorithm>
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

// Turns a direction about y, counter-clockwise as seen from above.
glm::vec3 turned(glm::vec3 w, double sine, double cosine) {
  const glm::dvec3 d(w);
  return {cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x};
}

// Returns the mean luminance over each pixel of the image after bilinear filtering: weights 1, 6, 1 of 8 along each
// axis.
std::vector<float> filtered_luminance(const EnvironmentImage& image) {
  const int width = image.width, height = image.height;
  std::vector<float> across(image.pixels.size()), out(image.pixels.size());
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>((x + width) % width);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto l = [&](int i) { return luminance(image.pixels[at(i, y)]); };
      across[at(x, y)] = 0.125f * l(x - 1) + 0.75f * l(x) + 0.125f * l(x + 1);
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      out[at(x, y)] = 0.125f * across[at(x, y - 1)] + 0.75f * across[at(x, y)] + 0.125f * across[at(x, y + 1)];
    }
  }
  return out;
}

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

Environment::Environment(const compiler::CompiledScene& scene, std::shared_ptr<const EnvironmentImage> image)
    : type_(scene.background.type), bottom_(scene.background.bottom), top_(scene.background.top) {
  const compiler::Background& background = scene.background;
  if (type_ == Type::Image) {
    CHECK(image != nullptr && !image->pixels.empty(),
          "the scene's background is a picture, which must be read first");
    image_ = std::move(image);
    rotation_sine_ = vm::real::sin(background.image.rotate * vm::real::kDegree);
    rotation_cosine_ = vm::real::cos(background.image.rotate * vm::real::kDegree);
    strength_ = static_cast<float>(background.image.strength);
    table_ = PiecewiseConstantSphere(image_->width, image_->height, filtered_luminance(*image_));
  }
  if (type_ == Type::Sky) {
    constexpr int kRows = 64;
    sky_.emplace(background.sky);
    table_ = PiecewiseConstantSphere(
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

glm::vec3 Environment::pixel(glm::vec3 direction) const {
  const glm::dvec2 uv = to_latlong(glm::dvec3(turned(direction, -rotation_sine_, rotation_cosine_)));
  const int width = image_->width, height = image_->height;
  const double x = uv.x * width - 0.5, y = uv.y * height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto at = [&](int i, int j) {
    const int row = std::clamp(j, 0, height - 1), column = (i % width + width) % width;
    return image_
        ->pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  };
  const auto a = static_cast<float>(x - x0), b = static_cast<float>(y - y0);
  return strength_ * ((1 - b) * ((1 - a) * at(x0, y0) + a * at(x0 + 1, y0)) +
                      b * ((1 - a) * at(x0, y0 + 1) + a * at(x0 + 1, y0 + 1)));
}

glm::vec3 Environment::backdrop(glm::vec3 direction) const {
  if (type_ == Type::Sky) return sky_->radiance(direction);
  if (type_ == Type::Image) return pixel(direction);
  const double share = gradient_share(direction.y);
  return glm::vec3(bottom_ * (1 - share) + top_ * share);
}

glm::vec3 Environment::radiance(glm::vec3 direction) const {
  glm::vec3 sum = backdrop(direction);
  for (const Disc& disc : discs_) {
    if (disc.contains(direction)) sum += disc.radiance;
  }
  return sum;
}

void Environment::set_gradient(std::size_t count, BackgroundRows& rows) const {
  for (int channel = 0; channel < 3; ++channel) {
    const double bottom = bottom_[channel], top = top_[channel];
    for (std::size_t i = 0; i < count; ++i) {
      const double share = gradient_share(rows.direction[1][i]);
      rows.radiance[channel][i] = static_cast<float>(bottom * (1 - share) + top * share);
    }
  }
}

void Environment::set_radiance(std::size_t count, BackgroundRows& rows) const {
  // The colour of a gradient takes less time than a call.
  if (type_ == Type::Gradient && discs_.empty()) return set_gradient(count, rows);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 found = radiance({rows.direction[0][i], rows.direction[1][i], rows.direction[2][i]});
    for (int channel = 0; channel < 3; ++channel) rows.radiance[channel][i] = found[channel];
  }
}

// Returns 0 for a gradient, which is so even that BSDF sampling finds its light with less noise
// (docs/explanation/light.md).
float Environment::mean() const {
  return type_ == Type::Gradient ? 0 : strength_ * static_cast<float>(table_.mean());
}

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

glm::vec3 Environment::sample(const LightSampleContext& context, float choice, glm::vec2 u) const {
  float rest = choice * importance(context) - kPiFloat * mean();
  const Disc* chosen = nullptr;
  for (const Disc& disc : discs_) {
    const float own = importance(disc, context);
    if (rest < 0 && (chosen != nullptr || mean() > 0)) break;
    if (own > 0) chosen = &disc;
    rest -= own;
  }
  if (chosen == nullptr) return turned(table_.sample(u), rotation_sine_, rotation_cosine_);
  const double below = static_cast<double>(u.x) * chosen->height, sine = std::sqrt(below * (2 - below));
  const SinCos turn = sincos_turn(u.y);
  const FrameOf<double> frame(chosen->direction);
  return frame.to_world({sine * static_cast<double>(turn.cos), sine * static_cast<double>(turn.sin), 1 - below});
}

float Environment::pdf(const LightSampleContext& context, glm::vec3 direction) const {
  const float all = importance(context);
  if (!(all > 0)) return 0;
  float sum = mean() > 0 ? kPiFloat * mean() * table_.pdf(turned(direction, -rotation_sine_, rotation_cosine_)) : 0;
  for (const Disc& disc : discs_) {
    if (!disc.contains(direction)) continue;
    sum += importance(disc, context) / (2 * kPiFloat * static_cast<float>(disc.height));
  }
  return sum / all;
}

}  // namespace fathom::runtime
