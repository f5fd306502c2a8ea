// Measures the gain from light sampling and from well-distributed samples: relMSE at equal time, and time to a relMSE
// of 1e-3.
//
//     build/release/bench_light_time [--spp N] [scene.json ...]     kScenes when no scene is given
//
// The time is what the default needs for kSpp samples per pixel, or for N. "before" is the path tracer without both:
// only hits find light, and samples are independent. Times are one thread's processor time. Both are compared, over
// eight seeds, with the mean of many independent samples of another seed. The images are a fifth of their intended
// width. In smaller images, most pixels would hold an edge, where neither method helps. In both, only hits find the
// light of a lamp through glass, or by way of a mirror and a rough surface. The gain is small where this light
// dominates the error. Trimmed: without the worst 0.1 % of the channels, which hold such light. Exit status 1 when a
// ratio is below 10.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "bench/scene_file.h"
#include "runtime/chart/fit.h"
#include "runtime/measure/measure_images.h"
#include "runtime/measure/stopwatch.h"
#include "runtime/render.h"

namespace fathom::bench {
namespace {

using namespace runtime;

// The lamp of scenes/cornell.json is a fifth of its ceiling instead of 4.4 %, and its two balls make caustics.
constexpr const char* kScenes[] = {FATHOM_SOURCE_DIR "/scenes/cornell-box.json",
                                   FATHOM_SOURCE_DIR "/scenes/gallery/still-life.json",
                                   FATHOM_SOURCE_DIR "/scenes/cornell.json"};

constexpr double kBar = 10;     // min ratio of relMSE, before over default
constexpr double kGoal = 1e-3;  // relMSE
constexpr int kPilotSpp = 8;    // samples per pixel to estimate a scene's speed
constexpr int kSpp = 32;        // samples per pixel of the default's longest image
constexpr int kReference = 48;  // times the samples of the longest image
constexpr ImageVariant kBefore{.sampler = compiler::SamplerKind::Independent, .light_sampling = LightSampling::Bsdf};
constexpr ImageVariant kDefault{};

// Returns seconds per image and sample per pixel.
double seconds_per_sample(const compiler::CompiledScene& scene, const ImageVariant& variant, const ImagePlan& plan) {
  const PixelValues nothing(static_cast<std::size_t>(3 * plan.width * plan.height));
  const ImagePoint points[] = {{variant, kPilotSpp}, {variant, 5 * kPilotSpp}};
  ImagePlan pilot = plan;
  pilot.seeds = 3;
  const auto rows = measure_points(scene, points, pilot, nothing, "");
  return (rows[1].seconds_med - rows[0].seconds_med) / (4 * kPilotSpp);
}

void print(const char* name, const ImageMeasurement& row, double goal) {
  fmt::print(
      "{:<10} {:>6} spp {:>7.3f} s   relMSE {:.2e} ({:.2e} to {:.2e})   trimmed {:.2e}   {:.0e} after {:.1f} s\n",
      name, row.spp, row.seconds_med, row.relmse_med, row.relmse_p05, row.relmse_p95, row.relmse_trimmed_med, kGoal,
      goal);
}

// Returns the ratio of relMSE at equal time.
double compare(const std::string& path, int default_spp) {
  const compiler::CompiledScene scene = read_scene("bench_light_time", path);
  ImagePlan plan{.width = 192, .height = 108, .seeds = 8};
  const double seconds = default_spp * seconds_per_sample(scene, kDefault, plan);
  std::vector<ImagePoint> points;
  for (const ImageVariant& variant : {kBefore, kDefault}) {
    const double spp = seconds / seconds_per_sample(scene, variant, plan);
    for (const double part : {1.0, 0.25, 0.0625}) {
      points.push_back({variant, std::max(2, static_cast<int>(std::lround(part * spp)))});
    }
  }
  plan.reference_variant = {.sampler = compiler::SamplerKind::Independent};
  plan.reference_spp = kReference * points[3].spp;
  const PixelValues reference = reference_image(scene, plan);
  const std::vector<ImageMeasurement> rows = measure_points(scene, points, plan, reference, path);
  const std::vector<ImageCurve> curves = fit_curves(rows);
  fmt::print("{}, {} x {}, {} seeds; reference {} spp\n", path, plan.width, plan.height, plan.seeds,
             plan.reference_spp);
  print("before", rows[0], seconds_to(curves[0], kGoal));
  print("default", rows[3], seconds_to(curves[1], kGoal));
  // Corrects for times that differ by a few hundredths: the error of independent samples is inverse to the time.
  const double times = rows[0].seconds_med / rows[3].seconds_med;
  const double ratio = times * rows[0].relmse_med / rows[3].relmse_med;
  fmt::print(
      "relMSE is {:.1f} times lower (trimmed {:.1f}), {:.0e} comes {:.1f} times sooner; slopes {:.2f}, {:.2f}; bar "
      ">= "
      "{}: {}\n\n",
      ratio, times * rows[0].relmse_trimmed_med / rows[3].relmse_trimmed_med, kGoal,
      seconds_to(curves[0], kGoal) / seconds_to(curves[1], kGoal), curves[0].slope, curves[1].slope, kBar,
      ratio >= kBar ? "holds" : "missed");
  std::fflush(stdout);
  return ratio;
}

}  // namespace
}  // namespace fathom::bench

int main(int argc, char** argv) {
  int spp = fathom::bench::kSpp;
  std::vector<std::string> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--spp" && i + 1 < argc && (spp = std::atoi(argv[++i])) > 0) continue;
    if (word.starts_with("-")) {
      fmt::print(stderr, "bench_light_time: usage: bench_light_time [--spp N] [scene.json ...], N above 0\n");
      return 2;
    }
    paths.push_back(word);
  }
  if (paths.empty()) paths.assign(std::begin(fathom::bench::kScenes), std::end(fathom::bench::kScenes));
  bool holds = true;
  for (const std::string& path : paths) holds &= fathom::bench::compare(path, spp) >= fathom::bench::kBar;
  return holds ? 0 : 1;
}
