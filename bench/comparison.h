// Comparisons for the benches, and the table that shows them. Times of both sides are interleaved, so that their
// ratio holds on a machine whose speed drifts.
//
// A row is a Google Benchmark with manual time, and has its filters, repetitions and JSON (--benchmark_filter=REGEX,
// --benchmark_out=FILE). An iteration is a round: it times "ours", then "theirs", in thread CPU time on one pinned
// processor, or in wall time where threads are compared. The row shows the median of each side and of the rounds'
// ratios ours/theirs, with the smallest and the largest ratio.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

namespace fathom::bench {

struct Comparison {
  std::string name;        // question/scene
  const char* unit;        // of the printed numbers
  double per_unit;         // factor from seconds to `unit`
  double most, least = 0;  // max and min of the ratio ours/theirs
  int rounds;
  std::function<void()> ours, theirs;
  std::function<std::string()> note = {};  // printed below the row
  bool wall = false;                       // true: wall time, and threads are not pinned
  double theirs_times = 1;                 // factor for theirs' time when theirs does only a part of the work of ours
};

void add(Comparison comparison);

// Adds a row with one number and its upper bound `most`, without a comparison.
void add_number(std::string name, const char* unit, double most, std::function<double()> measure);

// Runs and prints all added rows. Returns the exit status for main(). `header` says what the numbers are.
int run_benches(int argc, char** argv, const std::string& header);

}  // namespace fathom::bench
