#include "runtime/base/file_watch.h"

#include <algorithm>
#include <system_error>

namespace fathom::runtime {

FileWatch::FileWatch(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) files_.push_back({path, stamp_of(path), true});
}

void FileWatch::add(const std::string& path) {
  if (std::ranges::find(files_, path, &WatchedFile::path) == files_.end())
    files_.push_back({path, stamp_of(path), false});
}

std::optional<FileWatch::Stamp> FileWatch::stamp_of(const std::string& path) {
  std::error_code no_time, no_size;
  const Stamp stamp{std::filesystem::last_write_time(path, no_time), std::filesystem::file_size(path, no_size)};
  if (no_time || no_size) return std::nullopt;
  return stamp;
}

FileWatch::PollResult FileWatch::poll() {
  PollResult result;
  for (WatchedFile& file : files_) {
    const std::optional<Stamp> now = stamp_of(file.path);
    result.missing |= !now && file.is_needed;
    if ((!now && file.is_needed) || now == file.last_stamp) continue;
    file.last_stamp = now;
    result.other = true;
  }
  changed_ |= result.other;
  return result;
}

bool FileWatch::changed() {
  poll();
  return changed_;
}

bool FileWatch::settled() {
  const PollResult now = poll();
  if (!changed_ || now.other || now.missing) return false;
  changed_ = false;
  return true;
}

}  // namespace fathom::runtime
