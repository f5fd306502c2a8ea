#include "runtime/base/machine.h"

#include <sched.h>

#include <fstream>
#include <string>
#include <thread>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime {
namespace {

void put(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

}  // namespace

TEST_CASE("machine: the quota of a control group and of those above it counts", "[base]") {
  const test::TemporaryFolder folder;
  const auto root = folder.path() / "groups", process = folder.path() / "self";
  const ControlGroups groups(process, root);
  CHECK_FALSE(groups.processors());
  put(process / "cgroup", "0::/farm/job/7\n");
  CHECK_FALSE(groups.processors());
  put(root / "farm/job/7/cpu.max", "max 100000\n");
  put(root / "farm/job/7/memory.max", "max\n");
  CHECK_FALSE(groups.processors());
  CHECK_FALSE(groups.memory());
  put(root / "farm/job/cpu.max", "250000 100000\n");
  put(root / "farm/cpu.max", "400000 100000\n");
  put(root / "farm/memory.max", "4294967296\n");
  CHECK(groups.processors() == 2.5);
  CHECK(groups.memory() == 4294967296.0);
}

TEST_CASE("machine: control groups of version 1, and a container that sees the outer path", "[base]") {
  const test::TemporaryFolder folder;
  const auto root = folder.path() / "groups", process = folder.path() / "self";
  const ControlGroups groups(process, root);
  put(process / "cgroup", "9:cpuset:/x\n4:cpu,cpuacct:/docker/1234\n3:memory:/docker/1234\n0::/\nrubbish\n");
  put(root / "cpu/cpu.cfs_quota_us", "150000\n");
  put(root / "cpu/cpu.cfs_period_us", "50000\n");
  put(root / "memory/memory.limit_in_bytes", "1073741824\n");
  CHECK(groups.processors() == 3);
  CHECK(groups.memory() == 1073741824.0);
  put(root / "cpu/cpu.cfs_quota_us", "-1\n");
  CHECK_FALSE(groups.processors());
}

// hardware_concurrency() counted all processors under taskset and in a queue's job.
TEST_CASE("machine: the processors are those of the thread's affinity mask", "[base]") {
  int seen = 0;
  std::thread([&] {
    cpu_set_t all, one;
    if (::sched_getaffinity(0, sizeof all, &all) != 0) return;
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i) {
      if (CPU_ISSET(i, &all)) CPU_SET(i, &one);
    }
    if (::sched_setaffinity(0, sizeof one, &one) == 0) seen = usable_processors();
  }).join();
  CHECK(seen == 1);
  CHECK(usable_processors() >= 1);
  CHECK(usable_memory() > 0);
}

}  // namespace fathom::runtime
