// Files that appear whole or not at all: written beside their target, synced, and renamed. Where the file system can,
// what is written has no name until it is whole, so a program that is killed leaves nothing behind but for one that
// is killed between naming and renaming. What it left there, `.fathom-PID-N`, goes when the next one asks whether it
// can write in that folder.
//
// A link's target is what is written; a file that is replaced leaves its permissions to the new one.
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

// Which file lies under a name, and since when: one that was put there later differs.
struct FileStamp {
  std::uint64_t device = 0, file = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  // when it was written last

  bool operator==(const FileStamp&) const = default;
};
std::optional<FileStamp> stamp_of(const std::string& path);  // nothing where there is no file

class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  // No file: what is written is put into `memory`. Messages call it `name`.
  AtomicFile(std::string name, std::vector<std::uint8_t>& memory) : path_(std::move(name)), memory_(&memory) {}
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Each is false after the first failure.
  bool write(std::span<const std::uint8_t> bytes);
  bool seek(std::uint64_t position);  // from the file's beginning
  std::uint64_t position() const { return position_; }
  const std::optional<std::string>& problem() const { return problem_; }  // the first failure, for people
  const std::string& name() const { return path_; }                       // for people

  // The reason when the file could not be written. `may_replace` is asked last, once renaming is all that is left to
  // do.
  [[nodiscard]] std::optional<std::string> commit(const std::function<bool()>& may_replace = {});
  // Of what commit() put there, whatever lies there now.
  const std::optional<FileStamp>& stamp() const { return stamp_; }

 private:
  bool give_up(std::string_view why);  // false
  bool open_beside();
  bool name_beside();
  bool copy_beside();

  std::string path_;    // for people
  std::string target_;  // the same with links followed
  std::string beside_;  // the name of what is written; empty: it has none yet
  int file_ = -1;
  std::vector<std::uint8_t>* memory_ = nullptr;  // in place of a file
  std::uint64_t position_ = 0;
  std::optional<std::string> problem_;
  std::optional<FileStamp> stamp_;
};

// Whether a file can be written under this name, as far as can be known by trying: another beside it is created and
// removed. The reason when not; to be asked before the work that makes it.
std::optional<std::string> check_file_path(const std::string& path);

// The bytes as a file; the reason when it cannot be done, and then the target is as it was.
[[nodiscard]] std::optional<std::string> write_file(const std::vector<std::uint8_t>& bytes, const std::string& path);

}  // namespace fathom::runtime
