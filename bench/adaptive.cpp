// Compares adaptive sampling with the same number of samples for every pixel: relMSE at equal samples.
//
//     build/release/bench_adaptive [--spp N] [--threshold T] [scene.json ...]     kScenes when no scene is given
//
// Each row is the median over eight seeds of the ratio of relMSE, adaptive over uniform, both of the default sampler,
// against a reference of kReference times the samples with independent samples and another seed. A ratio below 1 is a
// gain. The uniform render has the average number of samples of the adaptive one, which is less than N only with a
// threshold. Exit status 1 when a median is above 1, or fewer than four are below kGain.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/scene_file.h"
#include "runtime/render.h"

namespace fathom::bench {
namespace {

using namespace runtime;

constexpr const char* kScenes[] = {FATHOM_SOURCE_DIR "/scenes/bench/glass-box.json",
                                   FATHOM_SOURCE_DIR "/scenes/cornell-box.json",
                                   FATHOM_SOURCE_DIR "/scenes/gallery/still-life.json",
                                   FATHOM_SOURCE_DIR "/scenes/gallery/interior.json",
                                   FATHOM_SOURCE_DIR "/scenes/gallery/elixir.json",
                                   FATHOM_SOURCE_DIR "/scenes/showcase.json"};
constexpr int kWidth = 96;       // pixels; the height keeps the scene's aspect
constexpr int kReference = 128;  // times the samples
constexpr int kSeeds = 8;
constexpr double kGain = 0.99;

// Mean over pixels and channels of the squared error over the squared truth plus 0.01.
double relmse(const Film& film, const Film& truth) {
  double sum = 0;
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const glm::dvec3 is = film.means(x, y).radiance, was = truth.means(x, y).radiance;
      for (int i = 0; i < 3; ++i) sum += (is[i] - was[i]) * (is[i] - was[i]) / (was[i] * was[i] + 0.01);
    }
  }
  return sum / (3.0 * static_cast<double>(film.area().pixels()));
}

struct Row {
  double uniform, adaptive, ratio, low, high, samples;
};

Row measure(const compiler::CompiledScene& scene, int spp, double threshold) {
  RenderOptions options;
  options.width = kWidth;
  options.height = std::max(1, kWidth * scene.film.height / scene.film.width);
  options.uniform = true;
  RenderOptions reference = options;
  reference.spp = kReference * spp;
  reference.sampler = compiler::SamplerKind::Independent;
  reference.seed = 0x5eed;
  const Film truth = render(scene, reference).film;
  std::vector<double> ratios, errors[2];
  double samples = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    RenderOptions adaptive = options;
    adaptive.uniform = false;
    adaptive.noise_threshold = threshold;
    adaptive.spp = spp;
    adaptive.seed = static_cast<std::uint64_t>(seed);
    const Film film = render(scene, adaptive).film;
    const double average = static_cast<double>(film.samples()) / static_cast<double>(film.area().pixels());
    samples += average / kSeeds;
    options.spp = static_cast<int>(std::lround(average));
    options.seed = adaptive.seed;
    errors[0].push_back(relmse(render(scene, options).film, truth));
    errors[1].push_back(relmse(film, truth));
    ratios.push_back(errors[1].back() / errors[0].back());
  }
  const auto median = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return (values[values.size() / 2 - 1] + values[values.size() / 2]) / 2;
  };
  const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
  return {median(errors[0]), median(errors[1]), median(ratios), *low, *high, samples};
}

int run(int argc, char** argv) {
  int spp = 32, losses = 0, gains = 0;
  double threshold = 0;
  std::vector<std::string> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--spp" && i + 1 < argc) {
      spp = std::max(kMinAdaptiveSpp, std::atoi(argv[++i]));
    } else if (argument == "--threshold" && i + 1 < argc) {
      threshold = std::atof(argv[++i]);
    } else {
      paths.push_back(argument);
    }
  }
  if (paths.empty()) paths.assign(std::begin(kScenes), std::end(kScenes));
  fmt::print("{:<22} {:>7} {:>10} {:>10}   ratio, median (min to max) of {} seeds\n", "scene", "samples", "uniform",
             "adaptive", kSeeds);
  for (const std::string& path : paths) {
    const Row row = measure(read_scene("bench_adaptive", path), spp, threshold);
    fmt::print("{:<22} {:>7.2f} {:>10.3e} {:>10.3e}   {:.3f} ({:.3f} to {:.3f})\n",
               path.substr(path.rfind('/') + 1), row.samples, row.uniform, row.adaptive, row.ratio, row.low, row.high);
    std::fflush(stdout);
    losses += row.ratio > 1;
    gains += row.ratio < kGain;
  }
  return losses > 0 || (paths.size() >= 6 && gains < 4) ? 1 : 0;
}

}  // namespace
}  // namespace fathom::bench

int main(int argc, char** argv) { return fathom::bench::run(argc, argv); }
