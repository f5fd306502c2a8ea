// Detects changes of files by their time of modification and size, which every system and file system can tell. A
// program may save a file in steps, and the first step often empties the file. A change therefore counts once nothing
// more has happened from one poll to the next.
// Tested by: tests/runtime/base/file_watch_test.cpp, tests/runtime/cli/cli_watch_test.cpp
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom::runtime {

// Time between polls, for callers that wait.
inline constexpr std::chrono::milliseconds kWatchInterval{200};

class FileWatch {
 public:
  explicit FileWatch(const std::vector<std::string>& paths);

  // Watches one more file, which may be missing for good. Does nothing when the file is watched already.
  void add(const std::string& path);

  // Polls the files. True if some file has changed, if only for a while, since a change settled last (the first
  // time, since the beginning). A missing file, as while an editor saves, has not changed until it is back.
  bool changed();
  // Polls the files. True if there is such a change, no needed file is missing, and no file has changed since the
  // poll before. The next change then counts from the files as they are now.
  bool settled();

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size;
    bool operator==(const Stamp&) const = default;
  };
  struct WatchedFile {
    std::string path;
    std::optional<Stamp> last_stamp;
    bool is_needed;  // nothing settles while it is missing
  };
  // Result of a poll: `other` when some file has changed since the poll before, `missing` when a needed file is
  // missing.
  struct PollResult {
    bool other = false, missing = false;
  };
  static std::optional<Stamp> stamp_of(const std::string& path);
  PollResult poll();

  std::vector<WatchedFile> files_;
  bool changed_ = false;
};

}  // namespace fathom::runtime
