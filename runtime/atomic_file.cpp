#include "runtime/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace fathom::runtime {
namespace {

constexpr const char* kOpenFiles = "/proc/self/fd";

std::string reason() { return std::strerror(errno); }

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// A new file gets the permissions any other program would give it, not mkstemp's.
void grant_usual_access(int file) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  (void)!::fchmod(file, 0666 & ~mask);
}

// So that the new name outlives a loss of power. The file is there either way: what cannot be synced is no failure.
void sync_folder(const std::string& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  // Renaming over a device or a folder would destroy it.
  struct stat existing {};
  if (::stat(path_.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode)) {
    give_up("it is not a regular file");
    return;
  }
  if (open_beside()) {
    grant_usual_access(file_);
  } else {
    give_up(reason());
  }
}

bool AtomicFile::open_beside() {
#ifdef O_TMPFILE
  if (::access(kOpenFiles, X_OK) == 0)
    file_ = ::open(folder_of(path_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (file_ >= 0) return true;
#endif
  beside_ = path_ + ".XXXXXX";
  file_ = ::mkstemp(beside_.data());
  if (file_ < 0) beside_.clear();
  return file_ >= 0;
}

// Renaming needs a name to rename; whoever has taken this one was killed, or is another program.
bool AtomicFile::name_beside() {
  if (!beside_.empty()) return true;
  const std::string file = fmt::format("{}/{}", kOpenFiles, file_);
  for (int i = 0; i < 1000; ++i) {
    std::string name = fmt::format("{}.{}-{}", path_, ::getpid(), i);
    if (::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      beside_ = std::move(name);
      return true;
    }
    if (errno != EEXIST) return false;
  }
  return false;
}

AtomicFile::~AtomicFile() {
  if (file_ < 0) return;
  ::close(file_);
  if (!beside_.empty()) ::unlink(beside_.c_str());
}

bool AtomicFile::give_up(std::string_view why) {
  if (!problem_) problem_ = fmt::format("cannot write `{}`: {}", path_, why);
  return false;
}

bool AtomicFile::write(std::span<const std::uint8_t> bytes) {
  while (!problem_ && !bytes.empty()) {
    const ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return give_up(reason());
    position_ += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return !problem_;
}

bool AtomicFile::seek(std::uint64_t position) {
  if (problem_) return false;
  if (::lseek(file_, static_cast<off_t>(position), SEEK_SET) < 0) return give_up(reason());
  position_ = position;
  return true;
}

std::optional<std::string> AtomicFile::commit() {
  if (problem_) return problem_;
  if (::fsync(file_) != 0 || !name_beside()) give_up(reason());
  if (::close(std::exchange(file_, -1)) != 0) give_up(reason());
  if (!problem_ && ::rename(beside_.c_str(), path_.c_str()) != 0) give_up(reason());
  if (problem_ && !beside_.empty()) ::unlink(beside_.c_str());
  if (!problem_) sync_folder(folder_of(path_));
  return problem_;
}

std::optional<std::string> check_file_path(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode)) return fmt::format("`{}` is a folder", path);
  const std::string folder = folder_of(path);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    return fmt::format("cannot write to the folder `{}`: {}", folder, reason());
  }
  return std::nullopt;
}

std::optional<std::string> write_file(const std::vector<std::uint8_t>& bytes, const std::string& path) {
  AtomicFile file(path);
  file.write(bytes);
  return file.commit();
}

}  // namespace fathom::runtime
