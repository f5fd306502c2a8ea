// What does interpretation cost? Time per point of the block machine against the same scene as C++ with the same
// lanes and the same floating-point flags: as `fathom emit` writes it, and for two scenes written by hand.
//
//     build/release/bench_dispatch [rounds]
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "bench/clouds.h"
#include "bench/emitted.h"
#include "bench/hand_written.h"
#include "runtime/measure/stopwatch.h"

namespace {

using namespace fathom;

constexpr std::size_t kPoints = 4096;
constexpr int kRepeats = 20;

void measure(const char* name, const std::string& path, const char* way, bench::Field compiled,
             const bench::Cloud& cloud, int rounds) {
  const compiler::CompiledScene scene = bench::compile_file(path);
  vm::Workspace workspace;
  std::vector<float> interpreted(kPoints), ahead(kPoints);
  const auto seconds = runtime::time_interleaved({[&] {
                                                    for (int i = 0; i < kRepeats; ++i) {
                                                      vm::evaluate_distance(scene.distance, cloud.points(), kPoints,
                                                                            interpreted.data(), workspace);
                                                    }
                                                  },
                                                  [&] {
                                                    for (int i = 0; i < kRepeats; ++i)
                                                      compiled(cloud.points(), kPoints, ahead.data());
                                                  }},
                                                 rounds);
  float largest = 0;
  for (std::size_t i = 0; i < kPoints; ++i) largest = std::max(largest, std::fabs(interpreted[i] - ahead[i]));
  const double per_point = 1e9 / (kPoints * kRepeats);
  const runtime::Spread vm_time = runtime::spread(seconds[0]), ahead_time = runtime::spread(seconds[1]),
                        ratio = runtime::ratio(seconds[0], seconds[1]);
  fmt::print(
      "{:<12} {:4} ops  machine {:6.2f}  {} {:6.2f}  ratio {:.2f} ({:.2f}..{:.2f})  largest difference {:.1e}\n",
      name, scene.distance.instructions(), vm_time.median * per_point, way, ahead_time.median * per_point,
      ratio.median, ratio.least, ratio.most, largest);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 51;
  runtime::pin_thread();
  const bench::Cloud cloud = bench::make_cloud(kPoints);
  fmt::print("{} lanes' instruction set, {} points, {} rounds; ns per point (median), ratio median (least..most)\n",
             vm::isa_name(), kPoints, rounds);
  const auto against = [&](const char* way, const char* name, const char* path, bench::Field field) {
    measure(name, path, way, field, cloud, rounds);
  };
  against("emitted", "primitives", "scenes/bench/a-primitives.json", bench::primitives_emitted);
  against("by hand", "primitives", "scenes/bench/a-primitives.json", bench::primitives_by_hand);
  against("emitted", "csg", "scenes/bench/b-csg.json", bench::csg_emitted);
  against("by hand", "csg", "scenes/bench/b-csg.json", bench::csg_by_hand);
  against("emitted", "mandelbulb", "scenes/bench/c-mandelbulb.json", bench::mandelbulb_emitted);
  against("emitted", "gyroid", "scenes/bench/e-gyroid.json", bench::gyroid_emitted);
  against("emitted", "1000 objects", "scenes/bench/d1000.json", bench::thousand_emitted);
}
