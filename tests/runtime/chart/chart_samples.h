// Measurements to draw: rows of early prototypes for rays, and an exact power law with a floor for images.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "runtime/chart/measurements.h"

namespace fathom::test {

inline const runtime::Provenance kProvenance{
    "0123abc", "Xeon, 2 cores", "g++ 12.2", "avx512", "2026-11-21", "fathom chart composite.json -o out", 9};

struct SampleMethod {
  const char* method;
  const char* precision;
  double eps, relax;
  int steps;
  double us[2], evals[2], error, wrong[2], exhausted[2];  // of camera and bounce rays; ppm
};

inline std::vector<runtime::RayMeasurement> sample_rays() {
  const SampleMethod methods[] = {
      {"sphere tracing", "f32", 1e-3, 1, 0, {.82, 1.05}, {23.0, 29.3}, 1.7e-2, {1140, 3580}, {0, 900}},
      {"sphere tracing", "f32", 1e-5, 1, 0, {1.12, 1.19}, {31.6, 33.4}, 1.7e-4, {20, 0}, {0, 1000}},
      {"sphere tracing", "f32", 1e-6, 1, 0, {1.25, 1.26}, {35.8, 35.5}, 1.7e-5, {0, 0}, {0, 1100}},
      {"sphere tracing", "f32", 1e-3, 1, 64, {.76, .95}, {20.9, 26.3}, 1.1e-2, {1040, 360}, {52400, 57040}},
      {"sphere tracing", "f32", 1e-5, 0, 0, {1.10, 1.06}, {22.4, 21.9}, 1.6e-4, {20, 0}, {0, 440}},
      {"tiered", "f32", 0, 0, 0, {1.14, 1.03}, {25.2, 21.6}, 2.5e-6, {0, 0}, {0, 0}},
      {"sphere tracing", "f64", 1e-9, 1, 0, {1.85, 1.60}, {48.6, 42.5}, 9.3e-9, {0, 0}, {0, 40}},
      {"interval", "f64", 0, 0, 0, {54.7, 26.1}, {87.9, 47.6}, 7.5e-9, {0, 0}, {100, 20}},
      {"reference", "f64", 0, 0, 0, {2.57, 1.84}, {53.7, 38.3}, 0, {0, 0}, {0, 0}},
  };
  std::vector<runtime::RayMeasurement> rows;
  const char* classes[] = {"camera", "bounce", "grazing"};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t of = c == 0 ? 0 : 1;
    const double harder = c == 2 ? 2.5 : 1;  // grazing rays were not measured: factor on the bounce rays' numbers
    for (const SampleMethod& m : methods) {
      runtime::RayMeasurement row;
      row.scene = "composite";
      row.method = m.method;
      row.precision = m.precision;
      row.eps = m.eps;
      row.relax = m.relax;
      row.steps_max = m.steps;
      row.ray_class = classes[c];
      row.rays = 50000;
      row.ns_med = 1000 * m.us[of] * (m.eps > 0 ? harder : 1 + 0.3 * (harder - 1));
      row.ns_min = 0.97 * row.ns_med;
      row.ns_max = 1.08 * row.ns_med;
      row.evals_mean = m.evals[of] * (m.eps > 0 ? harder : 1 + 0.3 * (harder - 1));
      row.evals_p99 = 4 * row.evals_mean;
      row.false_hit_ppm = m.wrong[of] * harder;
      row.exhausted_ppm = m.exhausted[of];
      row.terr_p50 = 0.1 * m.error;
      row.terr_p99 = m.error * harder;
      row.terr_max = 30 * m.error;
      row.nerr_p50 = m.error;
      row.nerr_p99 = 3 * m.error;
      row.nerr_max = 90 * m.error;
      row.reference = row.method == "reference";
      rows.push_back(row);
    }
  }
  return rows;
}

// relMSE = noise / spp + floor, with a cost proportional to the samples.
inline std::vector<runtime::ImageMeasurement> sample_images() {
  struct Curve {
    const char* method;
    const char* precision;
    double eps, seconds_per_sample, noise, floor;
  };
  const Curve curves[] = {{"tiered", "f32", 0, 0.021, 0.4, 3e-6},
                          {"sphere tracing", "f32", 1e-3, 0.019, 0.4, 2.1e-3},
                          {"sphere tracing", "f32", 1e-5, 0.024, 0.4, 2.2e-5},
                          {"reference", "f64", 0, 0.31, 0.4, 1e-6}};
  std::vector<runtime::ImageMeasurement> rows;
  for (const Curve& c : curves) {
    for (int spp = 4; spp <= 1024; spp *= 4) {
      const double seconds = c.seconds_per_sample * spp, relmse = c.noise / spp + c.floor;
      rows.push_back({"composite", c.method, c.precision, c.eps, "blue", "mis", spp, 16, seconds, 0.96 * seconds,
                      1.07 * seconds, relmse, 0.8 * relmse, 1.4 * relmse, 0.5 * relmse, c.floor});
    }
  }
  return rows;
}

}  // namespace fathom::test
