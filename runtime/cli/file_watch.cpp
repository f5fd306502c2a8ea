#include "runtime/cli/file_watch.h"

#include <system_error>

namespace fathom::cli {

FileWatch::FileWatch(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) files_.push_back({path, stamp_of(path)});
}

std::optional<FileWatch::Stamp> FileWatch::stamp_of(const std::string& path) {
  std::error_code no_time, no_size;
  const Stamp stamp{std::filesystem::last_write_time(path, no_time), std::filesystem::file_size(path, no_size)};
  if (no_time || no_size) return std::nullopt;
  return stamp;
}

bool FileWatch::changed() {
  bool any = false;
  for (Watched& file : files_) {
    const std::optional<Stamp> now = stamp_of(file.path);
    if (!now || now == file.seen) continue;
    file.seen = now;
    any = true;
  }
  return any;
}

}  // namespace fathom::cli
