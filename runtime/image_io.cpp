#include "runtime/image_io.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stb_image_write.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "vm/check.h"

namespace fathom::runtime {
namespace {

constexpr int kJpegQuality = 95;  // of 100

struct Ending {
  std::string_view ending;
  ImageFormat format;
};
constexpr Ending kEndings[] = {
    {"png", ImageFormat::Png}, {"jpg", ImageFormat::Jpeg}, {"jpeg", ImageFormat::Jpeg}, {"bmp", ImageFormat::Bmp}};

std::string reason() { return std::strerror(errno); }

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// What follows the name's last dot, in small letters; empty when there is no dot.
std::string ending_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || path.find('/', dot) != std::string::npos) return "";
  std::string ending = path.substr(dot + 1);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

void append_bytes(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(context);
  const auto* first = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

bool write_all(int file, const std::vector<std::uint8_t>& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

// A new file gets the permissions any other program would give it, not mkstemp's.
void grant_usual_access(int file) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  (void)!::fchmod(file, 0666 & ~mask);
}

}  // namespace

std::optional<ImageFormat> image_format_of(const std::string& path) {
  const std::string ending = ending_of(path);
  for (const Ending& known : kEndings) {
    if (ending == known.ending) return known.format;
  }
  return std::nullopt;
}

bool is_float_map(const std::string& path) { return ending_of(path) == "pfm"; }

std::optional<std::string> check_image_path(const std::string& path) {
  if (!image_format_of(path)) {
    return fmt::format("cannot tell the format of `{}`: its name must end in .png, .jpg, .jpeg or .bmp", path);
  }
  return check_file_path(path);
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

std::vector<std::uint8_t> encode_image(const Picture& picture, ImageFormat format) {
  std::vector<std::uint8_t> bytes;
  const int w = picture.width, h = picture.height;
  const void* data = picture.rgb.data();
  int done = 0;
  switch (format) {
    case ImageFormat::Png:
      done = stbi_write_png_to_func(append_bytes, &bytes, w, h, 3, data, 3 * w);
      break;
    case ImageFormat::Jpeg:
      done = stbi_write_jpg_to_func(append_bytes, &bytes, w, h, 3, data, kJpegQuality);
      break;
    case ImageFormat::Bmp:
      done = stbi_write_bmp_to_func(append_bytes, &bytes, w, h, 3, data);
      break;
  }
  if (done == 0) bytes.clear();
  return bytes;
}

std::optional<std::string> write_image(const Picture& picture, const std::string& path) {
  if (std::optional<std::string> problem = check_image_path(path)) return problem;
  const std::vector<std::uint8_t> bytes = encode_image(picture, *image_format_of(path));
  if (bytes.empty()) return fmt::format("cannot encode `{}`: too large for its format", path);
  return write_file(bytes, path);
}

std::optional<std::string> write_float_map(std::span<const float> values, int width, int height,
                                           const std::string& path) {
  const std::size_t row = static_cast<std::size_t>(width);
  CHECK(values.size() == row * static_cast<std::size_t>(height), "a map of another size than its values");
  const std::string header = fmt::format("Pf\n{} {}\n-1.0\n", width, height);  // below zero: little endian
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  for (std::size_t y = static_cast<std::size_t>(height); y-- > 0;) {
    for (const float value : values.subspan(y * row, row)) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
  }
  return write_file(bytes, path);
}

std::optional<std::string> write_file(const std::vector<std::uint8_t>& bytes, const std::string& path) {
  // Renaming over a device or a folder would destroy it.
  struct stat existing {};
  if (::stat(path.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode)) {
    return fmt::format("cannot write `{}`: it is not a regular file", path);
  }
  std::string beside = path + ".XXXXXX";
  const int file = ::mkstemp(beside.data());
  if (file < 0) return fmt::format("cannot write `{}`: {}", path, reason());
  grant_usual_access(file);
  bool done = write_all(file, bytes) && ::fsync(file) == 0;
  std::string why = done ? "" : reason();
  if (::close(file) != 0 && done) {
    done = false;
    why = reason();
  }
  if (done && ::rename(beside.c_str(), path.c_str()) != 0) {
    done = false;
    why = reason();
  }
  if (done) return std::nullopt;
  ::unlink(beside.c_str());
  return fmt::format("cannot write `{}`: {}", path, why);
}

}  // namespace fathom::runtime
