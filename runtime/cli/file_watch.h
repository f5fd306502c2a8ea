// Whether files have changed, by their time of modification and size: what every system and file system can tell.
// Tested by: tests/runtime/cli_watch_test.cpp
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom::cli {

// How often who waits should ask.
inline constexpr std::chrono::milliseconds kWatchInterval{200};

class FileWatch {
 public:
  explicit FileWatch(const std::vector<std::string>& paths);

  // Whether one of the files is another than at the last call (the first time, than at the beginning). One that is
  // away for a moment, as while an editor saves, has not changed until it is back.
  bool changed();

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size;
    bool operator==(const Stamp&) const = default;
  };
  struct Watched {
    std::string path;
    std::optional<Stamp> seen;
  };
  static std::optional<Stamp> stamp_of(const std::string& path);

  std::vector<Watched> files_;
};

}  // namespace fathom::cli
