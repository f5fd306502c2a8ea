// Whether files have changed, by their time of modification and size: what every system and file system can tell.
// Who saves a file may write it in steps, and the first step often is to empty it: a change counts once nothing more
// has happened from one look to the next.
// Tested by: tests/runtime/base/file_watch_test.cpp, tests/runtime/cli/cli_watch_test.cpp
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom::runtime {

// How long who waits should let pass before each look.
inline constexpr std::chrono::milliseconds kWatchInterval{200};

class FileWatch {
 public:
  explicit FileWatch(const std::vector<std::string>& paths);

  // Watches one more file, which may be away for good; nothing when it is watched.
  void add(const std::string& path);

  // A look: whether one of the files is another than when a change settled last (the first time, than at the
  // beginning), if only for a while. One that is away, as while an editor saves, has not changed until it is back.
  bool changed();
  // A look: whether there is such a change, every file is there, and none is another than at the look before. The
  // files as they are now are what the next change is from.
  bool settled();

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size;
    bool operator==(const Stamp&) const = default;
  };
  struct Watched {
    std::string path;
    std::optional<Stamp> seen;
    bool is_needed;  // nothing is settled while it is away
  };
  // What a look finds: whether files are others than at the look before, and whether one is away.
  struct Look {
    bool other = false, away = false;
  };
  static std::optional<Stamp> stamp_of(const std::string& path);
  Look look();

  std::vector<Watched> files_;
  bool changed_ = false;
};

}  // namespace fathom::runtime
