// Files that appear as a whole: links, permissions, long names, and leftovers of other programs.
#include "runtime/base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::atomic_file_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::uint8_t> kBytes = {1, 2, 3};

mode_t mode_of(const std::string& path) {
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  return status.st_mode & 07777;
}

TEST_CASE("atomic files: what is replaced leaves its permissions, what is new has the usual ones", "[base]") {
  const test::TemporaryFolder folder;
  const mode_t mask = ::umask(022);
  CHECK_FALSE(write_file(kBytes, folder.file("new")));
  ::umask(mask);
  CHECK(mode_of(folder.file("new")) == 0644);
  fs::permissions(folder.file("new"), fs::perms{0600});
  CHECK_FALSE(write_file(kBytes, folder.file("new")));
  CHECK(mode_of(folder.file("new")) == 0600);
}

// Regression: the program checked the old checkpoint before syncing the new one. In the seconds between, another
// run's checkpoint could be replaced.
TEST_CASE("atomic files: whether the target may be replaced is asked last", "[base]") {
  const test::TemporaryFolder folder;
  AtomicFile file(folder.file("target"));
  REQUIRE(file.write(kBytes));
  const auto another = [&] {
    CHECK(folder.files() == 1);  // the file already has a temporary name next to the target
    std::ofstream(folder.file("target")) << "another's";
    return false;
  };
  REQUIRE(file.commit(another));
  CHECK(fs::file_size(folder.file("target")) == 9);
  CHECK(folder.files() == 1);
}

TEST_CASE("atomic files: of a link the target is written", "[base]") {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "far");
  std::ofstream(folder.file("far/target")) << "before";
  fs::create_symlink("far/target", folder.path() / "link");
  CHECK_FALSE(check_file_path(folder.file("link")));
  CHECK_FALSE(write_file(kBytes, folder.file("link")));
  CHECK(fs::is_symlink(folder.path() / "link"));
  CHECK(fs::file_size(folder.path() / "far/target") == 3);
  fs::create_symlink("nowhere", folder.path() / "loose");
  REQUIRE(check_file_path(folder.file("loose")));
  CHECK(check_file_path(folder.file("loose"))->find("leads nowhere") != std::string::npos);
  CHECK(write_file(kBytes, folder.file("loose"))->find("leads nowhere") != std::string::npos);
}

TEST_CASE("atomic files: a name as long as names can be is written, a longer one is refused before", "[base]") {
  const test::TemporaryFolder folder;
  const std::string longest(255, 'n');
  CHECK_FALSE(check_file_path(folder.file(longest)));
  CHECK_FALSE(write_file(kBytes, folder.file(longest)));
  CHECK(fs::file_size(folder.path() / longest) == 3);
  REQUIRE(check_file_path(folder.file(longest + "n")));
  CHECK(check_file_path(folder.file(longest + "n"))->find("too long") != std::string::npos);
  CHECK(write_file(kBytes, folder.file(longest + "n")));
  CHECK(check_file_path("/dev/null"));
  CHECK(folder.files() == 1);
}

TEST_CASE("atomic files: missing folders are made when the file is written, not before", "[base]") {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("a/b/c");
  CHECK_FALSE(check_file_path(file));
  CHECK(folder.files() == 0);
  CHECK_FALSE(write_file(kBytes, file));
  CHECK(fs::file_size(file) == 3);
  CHECK(check_file_path(folder.file("a/b/c/d")));
  CHECK(write_file(kBytes, folder.file("a/b/c/d/e")));
}

TEST_CASE("atomic files: what a killed program left is removed, what another is writing is not", "[base]") {
  const test::TemporaryFolder folder;
  const char* const kMine[] = {".fathom-mine", ".fathom-", ".fathom-2024", ".fathom-2024-01-05"};
  for (const char* name : kMine) std::ofstream(folder.file(name)) << "x";
  for (const char* name : {".fathom-1-0", ".fathom-99999999-7"}) std::ofstream(folder.file(name)) << "x";
  const int busy = ::open(folder.file(".fathom-1-0").c_str(), O_RDWR | O_CLOEXEC);
  REQUIRE(::flock(busy, LOCK_EX) == 0);
  CHECK_FALSE(check_file_path(folder.file("a")));
  CHECK(fs::exists(folder.path() / ".fathom-1-0"));
  CHECK_FALSE(fs::exists(folder.path() / ".fathom-99999999-7"));
  for (const char* name : kMine) CHECK(fs::exists(folder.path() / name));
  ::close(busy);
  CHECK_FALSE(check_file_path(folder.file("a")));
  CHECK_FALSE(fs::exists(folder.path() / ".fathom-1-0"));
}

TEST_CASE("atomic files: a stamp tells whether it is still the same file", "[base]") {
  const test::TemporaryFolder folder;
  CHECK_FALSE(stamp_of(folder.file("a")));
  CHECK_FALSE(write_file(kBytes, folder.file("a")));
  const auto first = stamp_of(folder.file("a"));
  REQUIRE(first);
  CHECK(stamp_of(folder.file("a")) == first);
  CHECK_FALSE(write_file(kBytes, folder.file("a")));
  CHECK(stamp_of(folder.file("a")) != first);
  AtomicFile file(folder.file("a"));
  file.write(kBytes);
  CHECK_FALSE(file.commit());
  CHECK(file.stamp());
  CHECK(file.stamp() == stamp_of(folder.file("a")));
}

}  // namespace
}  // namespace fathom::runtime::atomic_file_test
