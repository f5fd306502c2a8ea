#include "vm/program/parallel_for.h"

#include <memory>
#include <mutex>
#include <set>

#include "tests/support/catch.h"

namespace fathom {

TEST_CASE("parallel_for takes every index once", "[program]") {
  for (const int threads : {-1, 0, 1, 2, 7}) {
    for (const std::size_t count : {0, 1, 5, 1000}) {
      CAPTURE(threads, count);
      std::vector<std::atomic<int>> calls(count);
      parallel_for(
          threads, count, [] { return 0; }, [&](int, std::size_t i) { ++calls[i]; });
      CHECK(std::ranges::all_of(calls, [](const std::atomic<int>& n) { return n == 1; }));
    }
  }
}

TEST_CASE("parallel_for makes scratch once per thread, on that thread", "[program]") {
  struct Scratch {
    std::thread::id owner = std::this_thread::get_id();
    std::unique_ptr<int> cannot_be_copied;
  };
  std::mutex mutex;
  std::multiset<std::thread::id> owners;
  std::atomic<int> strangers = 0;
  const auto make_scratch = [&] {
    const std::lock_guard lock(mutex);
    return Scratch{*owners.insert(std::this_thread::get_id()), nullptr};
  };
  parallel_for(4, 100, make_scratch,
               [&](Scratch& scratch, std::size_t) { strangers += scratch.owner != std::this_thread::get_id(); });
  CHECK(strangers == 0);
  CHECK(owners.size() == 4);
  CHECK(owners.count(std::this_thread::get_id()) == 1);
}

TEST_CASE("parallel_for starts no more threads than there are indices", "[program]") {
  std::atomic<int> made = 0;
  parallel_for(
      16, 3, [&] { return ++made; }, [](int, std::size_t) {});
  CHECK(made == 3);
}

TEST_CASE("parallel_for on one thread goes in order", "[program]") {
  std::vector<std::size_t> order;
  parallel_for(
      1, 4, [] { return 0; }, [&](int, std::size_t i) { order.push_back(i); });
  CHECK(order == std::vector<std::size_t>{0, 1, 2, 3});
}

}  // namespace fathom
