// Results of `fathom chart`: plain numbers that runtime/measure/ computes and runtime/chart/ draws.
//
// Fractions of rays are in ppm, lengths in scene units, angles in radians. A quantity that could not be measured is
// NaN, which charts and tables show as missing and never as 0.
// Tested by: tests/runtime/chart/chart_csv_test.cpp
#pragma once

#include <cstdint>
#include <string>

namespace fathom::runtime {

inline constexpr const char* kDefaultMethod = "tiered";
inline constexpr const char* kDefaultSampler = "blue";
inline constexpr const char* kDefaultLights = "mis";

// One method that intersects the rays of one class with one scene.
struct RayMeasurement {
  std::string scene;
  std::string method;     // kDefaultMethod or another method's name
  std::string precision;  // "f32" or "f64"
  double eps = 0;         // hit tolerance, scene units; 0: the method has none
  double relax = 0;       // multiplier of the step; 0: automatic, 1: plain sphere tracing
  int steps_max = 0;      // limit of steps per ray; 0: none
  std::string ray_class;  // "camera", "bounce" or "grazing"
  std::uint64_t rays = 0;
  double ns_med = 0, ns_min = 0, ns_max = 0;        // nanoseconds per ray on one thread, over the rounds
  double evals_mean = 0, evals_p99 = 0;             // field evaluations per ray
  double false_hit_ppm = 0;                         // rays reported as hits that miss
  double false_miss_ppm = 0;                        // rays reported as misses that hit
  double exhausted_ppm = 0;                         // rays that ran out of steps
  double near_miss_ppm = 0;                         // misses too near the surface to exclude a touch; not failures
  double gross_ppm = 0;                             // hits far from the true hit
  double terr_p50 = 0, terr_p99 = 0, terr_max = 0;  // |t - t_ref| of the hits, scene units
  double nerr_p50 = 0, nerr_p99 = 0, nerr_max = 0;  // angle between the normals, radians
  bool reference = false;                           // the reference itself: its errors are 0 by definition
};

// Images of one scene at one number of samples per pixel, each image with its own seed. relMSE = mean((I - R)^2 /
// (R^2 + c)), where R is the reference and c is 0.01 times the square of R's mean.
struct ImageMeasurement {
  std::string scene;
  std::string method;
  std::string precision;
  double eps = 0;  // scene units; 0: the method has none
  std::string sampler = kDefaultSampler;
  // Light sampling: "nee", "bsdf" or "mis"
  std::string lights = kDefaultLights;
  int spp = 0;
  int seeds = 0;                                             // number of images
  double seconds_med = 0, seconds_min = 0, seconds_max = 0;  // per image
  double relmse_med = 0, relmse_p05 = 0, relmse_p95 = 0;     // over the seeds
  double relmse_trimmed_med = 0;                             // without the worst 0.1 % of the pixels
  // relMSE of the mean over the seeds: the bias plus the noise that the mean still has
  double floor = 0;
};

// A power law through the points of one method: relMSE = factor * seconds^slope.
struct ImageCurve {
  std::string scene;
  std::string method;
  std::string precision;
  double eps = 0;
  std::string sampler, lights;
  double slope = 0;   // -1 for independent, unbiased samples; NaN for fewer than two points
  double factor = 0;  // relMSE after one second
};

// Origin of the numbers.
struct Provenance {
  std::string commit, cpu, compiler, isa, date, command;
  int rounds = 0;  // each time is the median of this many rounds
};

// Returns the provenance in one line, for the foot of a chart.
inline std::string source_of(const Provenance& provenance) {
  std::string line;
  for (const std::string* part :
       {&provenance.commit, &provenance.cpu, &provenance.isa, &provenance.compiler, &provenance.date}) {
    if (!part->empty()) line += (line.empty() ? "" : " · ") + *part;
  }
  return line;
}

}  // namespace fathom::runtime
