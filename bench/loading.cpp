// Compares reading a compiled file with compiling the text that it was made from.
//
//     build/release/bench_loading [scene ...]     tests/data/prospero.vm and a scene of 10,000 objects without
//     arguments
//
// Each row has medians of kRounds interleaved rounds on one pinned thread, with the smallest and largest ratio. Both
// begin with the bytes of the file in memory. Exit status 1 if the first ratio is below kBar.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/artefact/compiled_file.h"
#include "compiler/compile.h"
#include "runtime/measure/stopwatch.h"

namespace fathom::bench {
namespace {

constexpr int kRounds = 15;
constexpr double kBar = 10;

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::optional<double> measure(const std::string& path) {
  const compiler::Source source(path, text_of(path));
  const auto compile = [&] {
    compiler::Diagnostics diagnostics;
    return compiler::compile(source, diagnostics);
  };
  const auto scene = compile();
  if (!scene) {
    fmt::print(stderr, "{}: cannot be compiled\n", path);
    return std::nullopt;
  }
  const std::vector<std::uint8_t> bytes = compiler::write_file(*scene);
  const auto times = runtime::time_interleaved(
      {[&] { compile(); }, [&] { static_cast<void>(compiler::read_stored(bytes, path)); }}, kRounds);
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    const auto i = static_cast<std::size_t>(round);
    ratios.push_back(times[0][i] / times[1][i]);
  }
  const runtime::Spread compiling = runtime::spread(times[0]), reading = runtime::spread(times[1]);
  const runtime::Spread ratio = runtime::spread(ratios);
  fmt::print("{:<22} {:>10.2f} {:>10.2f}   {:>6.1f} ({:.1f} to {:.1f})\n",
             std::filesystem::path(path).filename().string(), 1e3 * compiling.median, 1e3 * reading.median,
             ratio.median, ratio.least, ratio.most);
  return ratio.median;
}

int run(int argc, char** argv) {
  std::vector<std::string> paths(argv + 1, argv + argc);
  if (paths.empty()) {
    paths = {FATHOM_SOURCE_DIR "/tests/data/prospero.vm", FATHOM_SOURCE_DIR "/scenes/gallery/ten-thousand.fathom"};
  }
  const runtime::PinnedThread pinned;
  fmt::print("{:<22} {:>10} {:>10}   compile / load, median (min to max) of {} rounds\n", "scene", "compile, ms",
             "load, ms", kRounds);
  bool holds = true;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::optional<double> ratio = measure(paths[i]);
    holds &= ratio.has_value() && (i > 0 || *ratio >= kBar);
  }
  return holds ? 0 : 1;
}

}  // namespace
}  // namespace fathom::bench

int main(int argc, char** argv) { return fathom::bench::run(argc, argv); }
