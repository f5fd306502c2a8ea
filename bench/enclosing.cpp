// Measures the cost of enclosing a program over boxes: time per instruction for sixteen boxes, next to the time for
// sixteen points of a full block. Boxes of two sizes, since choices that a box has decided still cost the same.
//
//     build/release/bench_enclosing [rounds]
#include <fmt/format.h>

#include <cstdlib>

#include "bench/clouds.h"
#include "runtime/measure/stopwatch.h"
#include "vm/range/enclose.h"

namespace {

using namespace fathom;

constexpr std::size_t kPoints = 4096;

// Cubes around the first points of the cloud.
struct Cubes {
  float lo[3][vm::kEnclosedBoxes], hi[3][vm::kEnclosedBoxes];

  Cubes(const bench::Cloud& cloud, float half) {
    const float* middle[] = {cloud.x.data(), cloud.y.data(), cloud.z.data()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
        lo[axis][i] = middle[axis][i] - half, hi[axis][i] = middle[axis][i] + half;
      }
    }
  }
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

void measure(const char* path, const bench::Cloud& cloud, int rounds) {
  const vm::VerifiedProgram program = bench::compile_file(path).distance;
  const int repeats = std::max(1, 200000 / static_cast<int>(program.instructions()));
  vm::Workspace workspace;
  std::vector<vm::ChoiceBounds> choices;
  std::vector<float> distance(kPoints);
  alignas(64) float lo[vm::kEnclosedBoxes], hi[vm::kEnclosedBoxes];
  const auto run = [&](const Cubes& cubes) {
    for (int i = 0; i < repeats; ++i) vm::enclose(program, cubes.view(), lo, hi, choices, workspace);
  };
  const Cubes large(cloud, 1.0f), small(cloud, 0.01f);
  const int passes = std::max(1, repeats / 256);
  const auto seconds = runtime::time_interleaved({[&] { run(large); }, [&] { run(small); },
                                                  [&] {
                                                    for (int i = 0; i < passes; ++i) {
                                                      vm::evaluate_distance(program, cloud.points(), kPoints,
                                                                            distance.data(), workspace);
                                                    }
                                                  }},
                                                 rounds);
  const double instructions = program.instructions();
  const auto each = [&](std::size_t which, double runs) {
    return 1e9 * runtime::spread(seconds[which]).median / (runs * instructions);
  };
  const double points = passes * kPoints / static_cast<double>(vm::kEnclosedBoxes);
  fmt::print("{:<32} {:6} ops {:8.2f} {:8.2f} {:8.2f}\n", path, program.instructions(), each(0, repeats),
             each(1, repeats), each(2, points));
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 21;
  runtime::pin_thread();
  const bench::Cloud cloud = bench::make_cloud(kPoints);
  fmt::print("{} lanes' instruction set, {} rounds; medians of ns per instruction\n{:>54} {:>8} {:>8}\n",
             vm::isa_name(), rounds, "2-boxes", ".02-box", "points");
  for (const char* path :
       {"scenes/bench/a-primitives.json", "scenes/bench/b-csg.json", "scenes/bench/c-mandelbulb.json",
        "scenes/bench/d1000.json", "scenes/bench/e-gyroid.json", "tests/data/prospero.vm"}) {
    measure(path, cloud, rounds);
  }
}
