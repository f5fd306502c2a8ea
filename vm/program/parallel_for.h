// parallel_for: calls a function once for every index of a range, on several threads.
//
//     parallel_for(threads, rows, [] { return vm::Workspace(); },
//                  [&](vm::Workspace& workspace, std::size_t row) { ... });
// Tested by: tests/vm/program/parallel_for_test.cpp
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace fathom {

// Calls work(scratch, i) for each i < count, and returns when all calls have returned. The calling thread is one of
// up to `threads`, which take the indices in ascending order. Each thread calls make_scratch() once, for itself.
template <class MakeScratch, class Work>
void parallel_for(int threads, std::size_t count, const MakeScratch& make_scratch, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    auto scratch = make_scratch();
    for (std::size_t i = next++; i < count; i = next++) work(scratch, i);
  };
  std::vector<std::thread> others;
  const std::size_t used = std::min(static_cast<std::size_t>(std::max(1, threads)), count);
  for (std::size_t i = 1; i < used; ++i) others.emplace_back(run);
  run();
  for (std::thread& other : others) other.join();
}

}  // namespace fathom
