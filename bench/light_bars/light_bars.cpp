// Checks the acceptance bars of light. Exit status 1 when a bar is missed.
//
//     build/release/bench_light_bars           a few minutes on two cores
//     build/release/bench_light_bars --full    half the errors, many more cases and images
//     build/release/bench_light_bars B20 B21   only these bars
#include "bench/light_bars/light_bars.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>

#include "tests/support/sampling_error.h"

namespace fathom::bench {

compiler::CompiledScene compile_scene(const std::string& json) {
  compiler::Diagnostics diagnostics;
  const compiler::Source source("bars", "{\"version\": 1, " + json + "}");
  auto scene = compiler::compile(source, diagnostics);
  if (!scene) {
    fmt::print(stderr, "{}", diagnostics.print(source, compiler::ErrorFormat::Text));
    std::exit(2);
  }
  return *std::move(scene);
}

void slope_bars(BarTable& table, const LightCounts& counts) {
  using namespace runtime;
  constexpr std::array<int, 9> kPowersOfTwo = {16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
  struct Row {
    SamplerKind kind;
    double most, least;
  };
  for (std::size_t f = 0; f < test::square_integrands().size(); ++f) {
    const double most = f == 0 ? -1.2 : -0.7;
    for (const Row& row : {Row{SamplerKind::Independent, -0.45, -0.55}, Row{SamplerKind::Sobol, most, -9},
                           Row{SamplerKind::Blue, most, -9}}) {
      const auto& integrand = test::square_integrands()[f];
      const double slope =
          test::error_slope(test::sampling_errors(row.kind, integrand, kPowersOfTwo, counts.slope_repeats, -1));
      const bool two_sided = row.least > -9;
      table.row("B22",
                fmt::format("{}, {}: exponent of the error's fall, 16 to 4096 samples",
                            compiler::kSamplerNames[static_cast<std::size_t>(row.kind)], integrand.name),
                two_sided ? "-0.50 +- 0.05" : fmt::format("<= {:.2f}", row.most), fmt::format("{:.3f}", slope),
                slope <= row.most && slope >= row.least);
    }
  }
}

}  // namespace fathom::bench

int main(int argc, char** argv) {
  using namespace fathom;
  constexpr std::pair<std::string_view, void (*)(bench::BarTable&, const bench::LightCounts&)> kBars[] = {
      {"B17", bench::furnace_bars},
      {"B18", bench::material_bars},
      {"B20", bench::density_bars},
      {"B21", bench::picture_bars},
      {"B22", bench::slope_bars}};
  bool full = false;
  std::vector<std::string_view> names;
  for (const std::string_view word : std::vector<std::string_view>(argv + 1, argv + argc)) {
    if (word == "--full") {
      full = true;
    } else if (std::any_of(std::begin(kBars), std::end(kBars), [&](const auto& bar) { return bar.first == word; })) {
      names.push_back(word);
    } else {
      fmt::print(stderr,
                 "bench_light_bars: does not know `{}`; there are --full, B17, B18 (and B19), B20, B21, B22\n", word);
      return 2;
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const bench::LightCounts counts = full ? bench::kFullLight : bench::LightCounts{};
  bench::BarTable table;
  for (const auto& [name, bars] : kBars) {
    if (names.empty() || std::find(names.begin(), names.end(), name) != names.end()) bars(table, counts);
  }
  fmt::print("{} in {:.0f} s\n", table.missed() ? fmt::format("{} missed", table.missed()) : "all hold",
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return table.missed() ? 1 : 0;
}
