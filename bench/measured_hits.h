// Marched rays compared with the truth.
#pragma once

#include <string_view>
#include <vector>

#include "compiler/compile.h"
#include "runtime/march/march.h"

namespace fathom::bench {

// Compiles a scene that consists of `objects`, JSON. Ends the program when the scene has errors.
compiler::CompiledScene compile_objects(std::string_view objects);

// Results of rays whose true distances are known.
struct Judgement {
  std::size_t rays = 0, false_hits = 0, false_misses = 0;
  std::size_t gross = 0;       // hits that are off by more than kGross
  std::vector<double> errors;  // |t - true t| of all true hits, gross ones included, scene units, sorted
  runtime::MarchCounters counters;

  std::size_t wrong() const { return false_hits + false_misses; }
  double evaluations() const { return static_cast<double>(counters.evaluations) / static_cast<double>(rays); }
};

inline constexpr double kGross = 0.02;  // scene units

// `truth(i)`: the i-th ray's true distance, negative for a miss.
template <class TruthOf>
Judgement judge(const runtime::MarchResult& result, const TruthOf& truth) {
  Judgement judged;
  judged.rays = result.ray_hits.size();
  judged.counters = result.counters;
  for (std::size_t i = 0; i < judged.rays; ++i) {
    const auto expected = truth(i);
    const bool hit = result.ray_hits[i].status == runtime::RayHit::Status::Hit;
    judged.false_hits += hit && expected < 0;
    judged.false_misses += !hit && expected >= 0;
    if (!hit || expected < 0) continue;
    const auto error = result.ray_hits[i].t - expected;
    judged.errors.push_back(static_cast<double>(error < 0 ? -error : error));
    judged.gross += judged.errors.back() > kGross;
  }
  std::sort(judged.errors.begin(), judged.errors.end());
  return judged;
}

}  // namespace fathom::bench
