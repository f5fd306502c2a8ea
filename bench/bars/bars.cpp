// Checks the acceptance bars of hits, normals and the machine. Each bar is measured against an independent truth:
// closed forms in long double, an interval solver with the scene written by hand, other instruction sets. Exit status
// 1 when a bar is missed.
//
//     build/release/bench_bars           two minutes
//     build/release/bench_bars --full    as many rays, normals and samples as the bars ask for: ten minutes
#include "bench/bars/bars.h"

#include <limits>

#include "runtime/measure/stopwatch.h"

namespace fathom::bench {

double permille(const std::vector<double>& sorted, std::size_t k) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  return sorted[std::min(sorted.size() - 1, sorted.size() * k / 1000)];
}

}  // namespace fathom::bench

int main(int argc, char** argv) {
  using namespace fathom;
  const bool full = argc == 2 && std::string_view(argv[1]) == "--full";
  if (argc > 1 && !full) {
    fmt::print(stderr, "bench_bars: does not know `{}`; the only option is --full\n", argv[argc - 1]);
    return 2;
  }
  runtime::pin_thread();
  const bench::Counts counts = full ? bench::kFull : bench::Counts{};
  bench::BarTable table;
  for (const auto bars : {bench::hit_bars, bench::composite_bars, bench::normal_bars, bench::random_normal_bars,
                          bench::machine_bars, bench::range_bars}) {
    bars(table, counts);
  }
  fmt::print("{} in {:.0f} s\n", table.missed() ? fmt::format("{} missed", table.missed()) : "all hold",
             runtime::thread_seconds());
  return table.missed() ? 1 : 0;
}
