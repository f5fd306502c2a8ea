// What the benches have in common: comparisons, timed so that their ratios hold on a machine whose speed drifts, and
// the table they are printed as.
//
// A row is a Google Benchmark with manual time, and has its filters, repetitions and JSON (--benchmark_filter=REGEX,
// --benchmark_out=FILE). An iteration is a round: it times "ours", then "theirs", in thread CPU time on one pinned
// processor, or on the wall where threads are the question. The row shows the median of each and of the rounds'
// ratios ours/theirs, with the least and the most.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

namespace fathom::bench {

struct Comparison {
  std::string name;        // question/scene
  const char* unit;        // of what is printed
  double per_unit;         // seconds times this are in that unit
  double most, least = 0;  // what the ratio should be at most, and at least
  int rounds;
  std::function<void()> ours, theirs;
  std::function<std::string()> note = {};  // printed below the row
  bool wall = false;                       // time on the wall, and threads go where they like
  double theirs_times = 1;                 // how often theirs would have to run to do what ours does
};

void add(Comparison comparison);

// A number that is compared with nothing but what it should be at most.
void add_number(std::string name, const char* unit, double most, std::function<double()> measure);

// Runs all rows that were added and prints them; what main() returns. `header` says what the numbers are.
int run_benches(int argc, char** argv, const std::string& header);

}  // namespace fathom::bench
