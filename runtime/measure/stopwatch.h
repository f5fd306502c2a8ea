// Timing for charts and benches. Variants of one measurement are interleaved round by round on one pinned thread, in
// thread CPU time, so that ratios inside a table hold while the machine's speed drifts.
#pragma once

#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace fathom::runtime {

// Pins the calling thread to the processor it runs on.
inline void pin_thread() {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(sched_getcpu()), &set);
  pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

// Pins the calling thread for the lifetime of the object.
class PinnedThread {
 public:
  PinnedThread() {
    pthread_getaffinity_np(pthread_self(), sizeof before_, &before_);
    pin_thread();
  }
  ~PinnedThread() { pthread_setaffinity_np(pthread_self(), sizeof before_, &before_); }
  PinnedThread(const PinnedThread&) = delete;
  PinnedThread& operator=(const PinnedThread&) = delete;

 private:
  cpu_set_t before_;
};

inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Spread {
  double median, least, most;
};

inline Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.front(), values.back()};
}

// Returns the seconds of each variant in each round. [variant][round]
inline std::vector<std::vector<double>> time_interleaved(const std::vector<std::function<void()>>& variants,
                                                         int rounds) {
  std::vector<std::vector<double>> seconds(variants.size());
  for (const auto& variant : variants) variant();  // warm-up
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const double start = thread_seconds();
      variants[i]();
      seconds[i].push_back(thread_seconds() - start);
    }
  }
  return seconds;
}

// Returns the spread of the ratios a/b of the same round.
inline Spread ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return spread(ratios);
}

}  // namespace fathom::runtime
