// Backgrounds that the renderer samples by tables: a sky without its sun, and an image in which all pixels differ.
#pragma once

#include <memory>

#include "runtime/light/environment.h"
#include "runtime/light/environment_map.h"
#include "runtime/sampling/sampler.h"

namespace fathom::test {

inline std::shared_ptr<runtime::EnvironmentMap> random_map(int width, int height) {
  runtime::EnvironmentImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    runtime::Sampler s(9, static_cast<std::uint32_t>(i), 0, 0);
    const float bright = i % 17 == 3 ? 5.0f : 0.5f;
    image.pixels.emplace_back(bright * s.next(), bright * s.next(), bright * s.next());
  }
  return std::make_shared<runtime::EnvironmentMap>(image);
}

inline constexpr const char* kSky = R"("background": {"type": "sky", "elevation": 35, "azimuth": 50, "turbidity": 4,
    "sun_disc": false})";
// Environment map whose file is never read: tests use random_map() instead.
inline constexpr const char* kPicture = R"("background": {"type": "image", "file": ")" FATHOM_SOURCE_DIR
                                        R"(/tests/data/one-pixel.hdr", "rotate": 40, "strength": 2})";

// A direction with the light from there, and the density of its samples.
struct Seen {
  glm::vec3 direction, radiance;
  float pdf;
};

inline Seen seen(const runtime::DirectionRows& rows, std::size_t i) {
  return {rows.direction_of(i), rows.radiance(i), rows.density(i)};
}

// Look in one direction. The density is per solid angle: of a table's samples, or of an environment's.
inline Seen look(const runtime::Environment& environment, glm::vec3 direction) {
  runtime::DirectionRows rows;
  rows.set_direction(0, direction);
  environment.look_up(1, rows);
  return seen(rows, 0);
}
inline Seen look(const runtime::PiecewiseConstantSphere& table, glm::vec3 direction, float turn = 0) {
  runtime::DirectionRows rows;
  rows.set_direction(0, direction);
  table.look_up(1, turn, rows);
  return seen(rows, 0);
}
inline float pdf_of(const runtime::Environment& environment, const runtime::LightSampleContext& context,
                    glm::vec3 direction) {
  return environment.pdf(context, direction, look(environment, direction).pdf);
}

// Samples one direction.
inline Seen sample_of(const runtime::PiecewiseConstantSphere& table, glm::vec2 u, float turn = 0) {
  runtime::DirectionRows rows;
  alignas(64) float x[runtime::DirectionRows::kCapacity] = {u.x}, y[runtime::DirectionRows::kCapacity] = {u.y};
  table.sample(1, x, y, turn, rows);
  return seen(rows, 0);
}
inline Seen sample_of(const runtime::Environment& environment, const runtime::LightSampleContext& context,
                      float choice, glm::vec2 u) {
  runtime::EnvironmentSamples samples;
  samples.context[0] = &context;
  samples.choice[0] = choice;
  samples.u[0] = u.x;
  samples.v[0] = u.y;
  environment.sample(1, samples);
  Seen sample = seen(samples.rows, 0);
  sample.pdf = environment.pdf(context, sample.direction, sample.pdf);
  return sample;
}

}  // namespace fathom::test
