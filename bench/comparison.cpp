#include "bench/comparison.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "runtime/measure/stopwatch.h"
#include "vm/interpret/evaluate.h"

namespace fathom::bench {
namespace {

constexpr std::string_view kNote = "; ";  // separates the unit from the note in a label

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double seconds_of(const std::function<void()>& run, bool wall) {
  const auto now = wall ? wall_seconds : runtime::thread_seconds;
  const double start = now();
  run();
  return now() - start;
}

void time_rounds(benchmark::State& state, const Comparison& row) {
  std::optional<runtime::PinnedThread> pinned;
  if (!row.wall) pinned.emplace();
  row.ours();
  row.theirs();
  std::vector<double> ours, theirs;
  for ([[maybe_unused]] auto round : state) {
    ours.push_back(seconds_of(row.ours, row.wall));
    theirs.push_back(seconds_of(row.theirs, row.wall) * row.theirs_times);
    state.SetIterationTime(ours.back());
  }
  const runtime::Spread ratio = runtime::ratio(ours, theirs);
  state.SetLabel(row.note ? row.unit + std::string(kNote) + row.note() : row.unit);
  state.counters["ours"] = runtime::spread(ours).median * row.per_unit;
  state.counters["theirs"] = runtime::spread(theirs).median * row.per_unit;
  state.counters["ratio"] = ratio.median;
  state.counters["ratio_least"] = ratio.least;
  state.counters["ratio_most"] = ratio.most;
  state.counters["bar_most"] = row.most;
  if (row.least > 0) state.counters["bar_least"] = row.least;
}

// Prints one line per benchmark.
class Table : public benchmark::BenchmarkReporter {
 public:
  explicit Table(std::string header) : header_(std::move(header)) {}

  bool ReportContext(const Context&) override {
    fmt::print("{}; {} lanes\n", header_, vm::isa_name());
    fmt::print("{:<44} {:>10} {:>10} {:<12} {:>7} {:<16} {:<8}\n", "", "ours", "theirs", "", "ratio", "(least..most)",
               "bar");
    return true;
  }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Iteration && !run.error_occurred) print(run);
      if (run.error_occurred) fmt::print("{}: {}\n", run.benchmark_name(), run.error_message);
    }
    std::fflush(stdout);
  }

 private:
  static void print(const Run& run) {
    const auto value = [&](const char* name) {
      const auto found = run.counters.find(name);
      return found == run.counters.end() ? 0.0 : found->second.value;
    };
    const std::string name = run.run_name.function_name;
    const std::size_t cut = run.report_label.find(kNote);
    const std::string unit = run.report_label.substr(0, cut);
    const double most = value("bar_most"), least = value("bar_least");
    const bool compared = run.counters.count("ratio") > 0;
    const double judged = value(compared ? "ratio" : "ours");
    const char* const verdict = std::isinf(most) ? "" : judged <= most && judged >= least ? "holds" : "missed";
    const std::string bar = std::isinf(most) ? ""
                            : least > 0      ? fmt::format("{:.4g}..{:.4g}", least, most)
                                             : fmt::format("<= {:.4g}", most);
    if (compared) {
      fmt::print("{:<44} {:>10.4g} {:>10.4g} {:<12} {:>7.3f} ({:.3f}..{:.3f})   {:<10} {}\n", name, value("ours"),
                 value("theirs"), unit, judged, value("ratio_least"), value("ratio_most"), bar, verdict);
    } else {
      fmt::print("{:<44} {:>10.4g} {:>10} {:<12} {:>7} {:<16} {:<10} {}\n", name, judged, "", unit, "", "", bar,
                 verdict);
    }
    if (cut != std::string::npos) fmt::print("    {}\n", run.report_label.substr(cut + kNote.size()));
  }

  std::string header_;
};

}  // namespace

void add(Comparison comparison) {
  const auto row = std::make_shared<const Comparison>(std::move(comparison));
  benchmark::RegisterBenchmark(row->name.c_str(), [row](benchmark::State& state) { time_rounds(state, *row); })
      ->Iterations(row->rounds)
      ->UseManualTime();
}

void add_number(std::string name, const char* unit, double most, std::function<double()> measure) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    for ([[maybe_unused]] auto once : state) state.counters["ours"] = measure();
    state.SetLabel(unit);
    state.counters["bar_most"] = most;
  })->Iterations(1);
}

int run_benches(int argc, char** argv, const std::string& header) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Table table(header);
  benchmark::RunSpecifiedBenchmarks(&table);
  return 0;
}

}  // namespace fathom::bench
