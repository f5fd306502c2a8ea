// The moments at which a shutter sees the scene, and the seeds of frames.
#include "runtime/sampling/shutter.h"
#include "tests/support/catch.h"

#include <cmath>
#include <set>

namespace fathom::shutter_test {
namespace {

using namespace fathom::runtime;

TEST_CASE("shutter: frame 0 has the seed itself, and no two frames the same", "[sampling]") {
  CHECK(frame_seed(7, 0) == 7);
  std::set<std::uint64_t> seeds;
  for (const std::uint64_t seed : {0ull, 1ull, 2ull, 1ull << 63}) {
    for (int frame = 0; frame < 2000; ++frame) CHECK(seeds.insert(frame_seed(seed, frame)).second);
  }
}

TEST_CASE("shutter: runs are even, cover all samples, and see moments within their share of the time", "[sampling]") {
  for (const int spp : {1, 2, 3, 4, 16, 31, 100, 4096}) {
    for (const int times : {1, 2, 3, 16, 1 << 20}) {
      INFO(spp << " samples, " << times << " times");
      const std::vector<ShutterInterval> runs = shutter_intervals(spp, times, 5, 9);
      CHECK(runs.size() == static_cast<std::size_t>(std::max(1, std::min(times, spp / 2))));
      std::uint32_t end = 0;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const ShutterInterval& run = runs[i];
        CHECK(run.samples.first == end);
        end = run.samples.last;
        CHECK(run.samples.first % 2 == 0);
        if (i + 1 < runs.size()) CHECK(run.samples.last % 2 == 0);
        CHECK(run.time * spp >= run.samples.first);
        CHECK(run.time * spp <= run.samples.last);
        CHECK((run.time >= 0 && run.time < 1));
      }
      CHECK(end == static_cast<std::uint32_t>(spp));
    }
  }
}

TEST_CASE("shutter: runs are as long as each other where they can be", "[sampling]") {
  for (const ShutterInterval& run : shutter_intervals(64, 16, 0, 0)) CHECK(run.samples.size() == 4);
  for (const ShutterInterval& run : shutter_intervals(100, 16, 0, 0))
    CHECK((run.samples.size() == 6 || run.samples.size() == 8));
}

// The mean of n uniform numbers in [0,1) has the standard deviation 1/sqrt(12 n). A deviation of five times this
// occurs once in 1.7 million.
TEST_CASE("shutter: moments are even in their share, and differ by seed, frame and run", "[sampling]") {
  std::set<double> times;
  double sum = 0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (int frame = 0; frame < 100; ++frame) {
      for (const ShutterInterval& run : shutter_intervals(16, 4, seed, frame)) {
        CHECK(times.insert(run.time).second);
        const double within = (run.time * 16 - run.samples.first) / run.samples.size();
        sum += within;
        ++count;
      }
    }
  }
  CHECK(sum / count == Approx(0.5).margin(5 / std::sqrt(12.0 * count)));
}

}  // namespace
}  // namespace fathom::shutter_test
