// Measures the time of a slice of a text model with thousands of lines: 1024x1024 pixels over [-1, 1]^2 on one
// processor. The rows are compiling the model, the signs at the pixels' centres (runtime/slice/quadtree.cpp), the
// values there, and compiling and signs together.
//
//     build/release/bench_slices
#include "bench/clouds.h"
#include "bench/comparison.h"
#include "runtime/measure/stopwatch.h"
#include "runtime/slice/slice.h"

namespace {

using namespace fathom;

constexpr int kSize = 1024, kRounds = 41;

double milliseconds(const std::function<void()>& work) {
  const runtime::PinnedThread pinned;
  return 1e3 * runtime::spread(runtime::time_interleaved({work}, kRounds)[0]).median;
}

std::vector<float> slice(const compiler::CompiledScene& scene, runtime::SliceValues wanted) {
  const runtime::Slice square{runtime::Axis::Z, 0, glm::dvec2(-1), glm::dvec2(1), kSize, kSize};
  return runtime::evaluate_slice(scene.distance, square, 1, wanted);
}

// Max milliseconds; 0: no bar.
struct Bars {
  double signs, whole;
};

void add_model(const std::string& path, Bars bars) {
  const auto bar = [](double most) { return most > 0 ? most : std::numeric_limits<double>::infinity(); };
  const auto rows = [=](const char* what, double most, auto work) {
    bench::add_number(path + ", " + what, "ms", bar(most), [work] { return milliseconds(work); });
  };
  const auto scene = std::make_shared<const compiler::CompiledScene>(bench::compile_file(path));
  rows("compiled", 0, [=] { bench::compile_file(path); });
  rows("signs", bars.signs, [=] { slice(*scene, runtime::SliceValues::Sign); });
  rows("values", 0, [=] { slice(*scene, runtime::SliceValues::Exact); });
  rows("compiled, then signs", bars.whole, [=] { slice(bench::compile_file(path), runtime::SliceValues::Sign); });
}

}  // namespace

int main(int argc, char** argv) {
  add_model("tests/data/prospero.vm", {15, 60});
  add_model("tests/data/hi.vm", {0, 0});
  return bench::run_benches(argc, argv,
                            fmt::format("{} lanes' instruction set, medians of {} rounds", vm::isa_name(), kRounds));
}
