#include "runtime/base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace fathom::runtime {
namespace {

constexpr const char* kOpenFiles = "/proc/self/fd";
constexpr std::string_view kBeside = ".fathom-";  // short, because the target's name may have the maximum length

std::string reason() { return std::strerror(errno); }

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// Returns the permissions that a new file gets from any other program, not only its owner's.
mode_t usual_access() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

// Follows links to the file itself. Returns nothing when a link leads nowhere.
std::optional<std::string> target_of(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  return error ? std::nullopt : std::optional(target.string());
}

// Calls make(name) with names in the folder until it succeeds, or fails for another reason than an existing file.
template <class Make>
std::string find_name(const std::string& folder, const Make& make) {
  for (int i = 0; i < 1000; ++i) {
    std::string name = fmt::format("{}/{}{}-{}", folder, kBeside, ::getpid(), i);
    if (make(name)) return name;
    if (errno != EEXIST) break;
  }
  return "";
}

// Creates a file of that name and locks it while it is open, so that no program takes it for left behind. Returns -1
// with errno on failure.
int create_locked(const std::string& name) {
  const int file = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return -1;
  struct stat status {};
  // Without locks no file is ever taken for left behind.
  if (::flock(file, LOCK_EX) != 0 || ::fstat(file, &status) != 0 || status.st_nlink > 0) return file;
  ::close(file);  // another program took it for left behind before the lock
  errno = EEXIST;
  return -1;
}

// True if the name is one of find_name().
bool is_temporary(std::string_view name) {
  if (!name.starts_with(kBeside)) return false;
  name.remove_prefix(kBeside.size());
  const std::size_t dash = name.find('-');
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dash != std::string_view::npos && is_number(name.substr(0, dash)) && is_number(name.substr(dash + 1));
}

// True if the name still is the open file's. The program that held the lock may have renamed its file since, and
// begun another of that name.
bool is_name_of(const char* name, int file) {
  struct stat open {};
  struct stat named {};
  return ::fstat(file, &open) == 0 && ::lstat(name, &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

void remove_left_behind(const std::string& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (!is_temporary(at->path().filename().string())) continue;
    const int file = ::open(at->path().c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    const char* name = at->path().c_str();
    if (::flock(file, LOCK_EX | LOCK_NB) == 0 && is_name_of(name, file)) ::unlink(name);
    ::close(file);
  }
}

FileStamp to_stamp(const struct stat& status) {
  return {status.st_dev, status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

constexpr const char* kNowhere = "it is a link that leads nowhere";
constexpr const char* kIrregular = "it is not a regular file";

// Makes the new name survive a loss of power. The file exists either way, so a failure to sync is ignored.
void sync_folder(const std::string& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

}  // namespace

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  const auto target = target_of(path_);
  if (!target) {
    fail(kNowhere);
    return;
  }
  target_ = *target;
  struct stat existing {};
  const bool replaces = ::stat(target_.c_str(), &existing) == 0;
  // Renaming over a device or a folder would destroy it.
  if (replaces && !S_ISREG(existing.st_mode)) {
    fail(kIrregular);
  } else if (open_temporary()) {
    (void)!::fchmod(file_, replaces ? existing.st_mode & 0777 : usual_access());
  } else {
    fail(reason());
  }
}

bool AtomicFile::open_temporary() {
  const std::string folder = folder_of(target_);
  std::error_code ignored;  // opening fails then, and says why
  std::filesystem::create_directories(folder, ignored);
#ifdef O_TMPFILE
  if (::access(kOpenFiles, X_OK) == 0) file_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file_ >= 0) {
    (void)!::flock(file_, LOCK_EX);
    return true;
  }
#endif
  temporary_ = find_name(folder, [&](const std::string& name) { return (file_ = create_locked(name)) >= 0; });
  return file_ >= 0;
}

// Gives the file a name, which renaming needs.
bool AtomicFile::link_temporary() {
  if (!temporary_.empty()) return true;
  const std::string file = fmt::format("{}/{}", kOpenFiles, file_);
  temporary_ = find_name(folder_of(target_), [&](const std::string& name) {
    return ::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  });
  return !temporary_.empty() || copy_temporary();
}

// Copies the file to one with a name, where the system can make a file without a name but not name it later: some
// network and layered file systems.
bool AtomicFile::copy_temporary() {
  const int from = file_;
  struct stat status {};
  int to = -1;
  temporary_ =
      find_name(folder_of(target_), [&](const std::string& name) { return (to = create_locked(name)) >= 0; });
  if (to < 0) return false;
  file_ = to;
  bool good =
      ::fstat(from, &status) == 0 && ::fchmod(to, status.st_mode & 0777) == 0 && ::lseek(from, 0, SEEK_SET) == 0;
  std::vector<std::uint8_t> bytes(1 << 20);
  ssize_t count = 0;
  while (good && (count = ::read(from, bytes.data(), bytes.size())) > 0) {
    good = write({bytes.data(), static_cast<std::size_t>(count)});
  }
  good = good && count == 0 && ::fsync(to) == 0;
  const int why = errno;
  ::close(from);
  errno = why;
  return good;
}

AtomicFile::~AtomicFile() {
  if (file_ < 0) return;
  ::close(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

bool AtomicFile::fail(std::string_view why) {
  if (!problem_) problem_ = fmt::format("cannot write `{}`: {}", path_, why);
  return false;
}

bool AtomicFile::write(std::span<const std::uint8_t> bytes) {
  if (memory_ != nullptr) {
    const std::size_t end = static_cast<std::size_t>(position_) + bytes.size();
    if (memory_->size() < end) memory_->resize(end);
    std::copy(bytes.begin(), bytes.end(), memory_->begin() + static_cast<std::ptrdiff_t>(position_));
    position_ = end;
    return true;
  }
  while (!problem_ && !bytes.empty()) {
    const ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return fail(reason());
    position_ += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return !problem_;
}

bool AtomicFile::seek(std::uint64_t position) {
  if (problem_) return false;
  if (memory_ == nullptr && ::lseek(file_, static_cast<off_t>(position), SEEK_SET) < 0) return fail(reason());
  position_ = position;
  return true;
}

std::optional<std::string> AtomicFile::commit(const std::function<bool()>& may_replace) {
  if (problem_ || memory_ != nullptr) return problem_;
  if (::fsync(file_) != 0 || !link_temporary()) {
    fail(reason());
  } else if (may_replace && !may_replace()) {
    fail("another file has been put there");
  } else if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail(reason());
  }
  if (problem_ && !temporary_.empty()) ::unlink(temporary_.c_str());
  struct stat status {};
  if (::fstat(file_, &status) == 0) stamp_ = to_stamp(status);
  ::close(std::exchange(file_, -1));  // not before: the lock shows that the name is in use
  if (!problem_) sync_folder(folder_of(target_));
  return problem_;
}

std::optional<std::string> check_file_path(const std::string& path) {
  const auto target = target_of(path);
  if (!target) return fmt::format("cannot write `{}`: {}", path, kNowhere);
  struct stat status;
  if (::stat(target->c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return fmt::format("`{}` is a folder", path);
    if (!S_ISREG(status.st_mode)) return fmt::format("cannot write `{}`: {}", path, kIrregular);
  } else if (errno == ENAMETOOLONG) {
    return fmt::format("cannot write `{}`: {}", path, reason());
  }
  std::string folder = folder_of(*target);
  while (::stat(folder.c_str(), &status) != 0 && errno == ENOENT && folder_of(folder) != folder) {
    folder = folder_of(folder);
  }
  remove_left_behind(folder);
  int file = -1;
  const std::string name =
      find_name(folder, [&](const std::string& each) { return (file = create_locked(each)) >= 0; });
  if (file < 0) return fmt::format("cannot write to the folder `{}`: {}", folder, reason());
  ::unlink(name.c_str());
  ::close(file);
  return std::nullopt;
}

std::optional<FileStamp> stamp_of(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return to_stamp(status);
}

std::optional<std::string> write_file(const std::vector<std::uint8_t>& bytes, const std::string& path) {
  AtomicFile file(path);
  file.write(bytes);
  return file.commit();
}

}  // namespace fathom::runtime
