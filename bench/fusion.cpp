// Measures what fused instructions save: time per point of scenes' programs as compiled, and without the pass `fuse`.
//
//     build/release/bench_fusion [rounds]
#include <fmt/format.h>

#include <bit>
#include <cstdlib>

#include "bench/clouds.h"
#include "runtime/measure/stopwatch.h"

namespace {

using namespace fathom;

constexpr std::size_t kPoints = 4096;

void measure(const char* path, const bench::Cloud& cloud, int rounds) {
  compiler::CompileOptions without_fuse;
  const auto names = compiler::pass_names();
  without_fuse.stop_after = std::string(names[names.size() - 2]);
  const vm::VerifiedProgram plain = bench::compile_file(path, without_fuse).distance;
  const vm::VerifiedProgram fused = bench::compile_file(path).distance;
  vm::Workspace workspace;
  std::vector<float> a(kPoints), b(kPoints);
  const int repeats = std::max(1, 4000 / static_cast<int>(plain.instructions()));
  const auto run = [&](const vm::VerifiedProgram& program, std::vector<float>& out) {
    for (int i = 0; i < repeats; ++i) {
      vm::evaluate_distance(program, cloud.points(), kPoints, out.data(), workspace);
    }
  };
  const auto seconds = runtime::time_interleaved({[&] { run(fused, b); }, [&] { run(plain, a); }}, rounds);
  std::size_t different = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    different += std::bit_cast<std::uint32_t>(a[i]) != std::bit_cast<std::uint32_t>(b[i]);
  }
  const double per_point = 1e9 / (kPoints * static_cast<double>(repeats));
  const runtime::Spread ratio = runtime::ratio(seconds[0], seconds[1]);
  fmt::print("{:<32} {:6} -> {:5} ops {:9.2f} -> {:8.2f} ns  ratio {:.3f} ({:.2f}..{:.2f})  values that differ {}\n",
             path, plain.instructions(), fused.instructions(), runtime::spread(seconds[1]).median * per_point,
             runtime::spread(seconds[0]).median * per_point, ratio.median, ratio.least, ratio.most, different);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 51;
  runtime::pin_thread();
  const bench::Cloud cloud = bench::make_cloud(kPoints);
  fmt::print("{} lanes' instruction set, {} points, {} rounds; medians, ratio fused / plain (least..most)\n",
             vm::isa_name(), kPoints, rounds);
  for (const char* path : {"scenes/bench/a-primitives.json", "scenes/bench/b-csg.json", "scenes/bench/d1000.json",
                           "scenes/bench/e-gyroid.json", "tests/data/hi.vm", "tests/data/prospero.vm"}) {
    measure(path, cloud, rounds);
  }
}
