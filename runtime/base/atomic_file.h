// Files that appear whole or not at all: the bytes go to a temporary file in the target's folder, which is synced and
// renamed. If the file system can, the temporary file has no name until it is whole. A program that is killed then
// leaves nothing behind, except between naming and renaming. The next check_file_path() in that folder removes the
// file that was left there, `.fathom-PID-N`.
//
// Folders that are missing on the way to the target are made.
//
// Writing to a link writes the link's target. A replaced file leaves its permissions to the new one.
//
//     AtomicFile file(path);
//     file.write(bytes);
//     if (auto problem = file.commit()) ...
//
// Without commit() the target stays as it was. Tested by: tests/runtime/base/atomic_file_test.cpp
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fathom::runtime {

// Identifies a file and its last change. A file put under the same name later has another stamp.
struct FileStamp {
  std::uint64_t device = 0, file = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  // time of the last change

  bool operator==(const FileStamp&) const = default;
};
std::optional<FileStamp> stamp_of(const std::string& path);  // nothing where there is no file

class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  // Writes into `memory` instead of a file. Messages call it `name`.
  AtomicFile(std::string name, std::vector<std::uint8_t>& memory) : path_(std::move(name)), memory_(&memory) {}
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Each returns false after the first failure.
  bool write(std::span<const std::uint8_t> bytes);
  bool seek(std::uint64_t position);  // from the file's beginning
  std::uint64_t position() const { return position_; }
  const std::optional<std::string>& problem() const { return problem_; }  // the first failure, for messages
  const std::string& name() const { return path_; }                       // for messages

  // Returns the reason when the file could not be written. Calls `may_replace` last, when only renaming is left to
  // do.
  [[nodiscard]] std::optional<std::string> commit(const std::function<bool()>& may_replace = {});
  // Returns the stamp of the file that commit() put there, whatever lies there now.
  const std::optional<FileStamp>& stamp() const { return stamp_; }

 private:
  bool fail(std::string_view why);  // returns false
  bool open_temporary();
  bool link_temporary();
  bool copy_temporary();

  std::string path_;    // for messages
  std::string target_;  // path_ with links followed
  std::string temporary_;  // name of the temporary file; empty while it has none
  int file_ = -1;
  std::vector<std::uint8_t>* memory_ = nullptr;  // instead of a file
  std::uint64_t position_ = 0;
  std::optional<std::string> problem_;
  std::optional<FileStamp> stamp_;
};

// Tests if a file can be written under this name, by creating and removing another file in its folder, or in the
// nearest folder above that exists. Returns the reason if not. Callers ask before the work that makes the file.
std::optional<std::string> check_file_path(const std::string& path);

// Writes the bytes to a file. Returns the reason when that fails, and then the target is as it was.
[[nodiscard]] std::optional<std::string> write_file(const std::vector<std::uint8_t>& bytes, const std::string& path);

}  // namespace fathom::runtime
