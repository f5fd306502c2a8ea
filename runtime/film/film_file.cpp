#include "runtime/film/film_file.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "runtime/base/tiles.h"
#include "runtime/film/film_header_bytes.h"
#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"

namespace fathom::runtime {
namespace {

constexpr std::size_t kPreamble = 4 + 8;  // bytes after the magic: format, size of the head
// Max memory for a head, relative to its size in the file: its bytes and the objects made of them. An attribute with
// the shortest name and value has 12 bytes in the file and a node of 144 bytes in memory.
constexpr double kHeadGrowth = 16;

void write_digest(std::span<const std::uint8_t> bytes, AtomicFile& file) {
  const vm::Digest digest = vm::digest(bytes);
  vm::ByteWriter out;
  out.u64(digest.low);
  out.u64(digest.high);
  file.write(out.bytes());
}

// Reads a file from front to back, with a checksum after each part.
class Input {
 public:
  explicit Input(const std::string& path) : path_(path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
      read_error_ = {fmt::format("cannot read `{}`: {}", path, error ? error.message() : "it is not a regular file"),
                     true, false};
      return;
    }
    left_ = std::filesystem::file_size(path, error);
    file_.open(path, std::ios::binary);
    if (error || !file_) read_error_ = {fmt::format("cannot read `{}`: {}", path, std::strerror(errno)), true, false};
  }

  const std::optional<FilmReadError>& read_error() const { return read_error_; }
  std::uint64_t left() const { return left_; }

  // Returns the next bytes; none if the file has fewer or cannot be read.
  std::span<const std::uint8_t> take(std::uint64_t count) {
    if (read_error_) return {};
    if (count > left_) return refuse("it ends too early");
    bytes_.resize(count);
    if (!file_.read(reinterpret_cast<char*>(bytes_.data()), static_cast<std::streamsize>(count))) {
      read_error_ = {fmt::format("cannot read `{}`: {}", path_, std::strerror(errno)), true, false};
      return {};
    }
    left_ -= count;
    return bytes_;
  }
  // Like take(), but also reads the checksum that follows the bytes, and refuses the file if the two do not match.
  std::span<const std::uint8_t> take_checked(std::uint64_t count) {
    if (count > left_) return refuse("it ends too early");
    const std::span<const std::uint8_t> all = take(count + kDigestSize);
    if (all.empty()) return {};
    vm::ByteReader digest(all.subspan(count));
    const vm::Digest found = vm::digest(all.first(count));
    const std::uint64_t low = digest.u64(), high = digest.u64();
    if (found.low != low || found.high != high) return refuse("it is damaged: a checksum does not fit");
    return all.first(count);
  }
  std::span<const std::uint8_t> refuse(std::string_view why, bool not_a_film = false) {
    if (!read_error_)
      read_error_ = {fmt::format("`{}` is no film that can be used: {}", path_, why), false, not_a_film};
    return {};
  }

 private:
  const std::string& path_;
  std::ifstream file_;
  std::uint64_t left_ = 0;
  std::optional<FilmReadError> read_error_;
  std::vector<std::uint8_t> bytes_;
};

bool is_allowed(double needed, const ReadLimits& limits, Input& in) {
  if (needed > limits.memory) in.refuse(too_much_memory(needed, limits.memory));
  return needed <= limits.memory;
}

std::optional<FilmFile> read_head_of(Input& in, const ReadLimits& limits) {
  const std::span<const std::uint8_t> magic = in.take(std::min<std::uint64_t>(in.left(), kFilmMagic.size()));
  if (!std::equal(magic.begin(), magic.end(), kFilmMagic.begin(), kFilmMagic.end())) {
    in.refuse("it does not begin as one", true);
    return std::nullopt;
  }
  vm::ByteReader preamble(in.take(kPreamble));
  if (in.read_error()) return std::nullopt;
  if (const std::uint32_t format = preamble.u32(); format != kFilmFormat) {
    in.refuse(fmt::format("it is of format {}, and this program reads {}", format, kFilmFormat));
    return std::nullopt;
  }
  const std::uint64_t size = preamble.u64();
  if (size > in.left()) {
    in.refuse("it ends too early");
    return std::nullopt;
  }
  if (!is_allowed(kHeadGrowth * static_cast<double>(size), limits, in)) return std::nullopt;
  vm::ByteReader bytes(in.take_checked(size));
  if (in.read_error()) return std::nullopt;
  FilmFile file;
  auto problem = read_shape(bytes, file);
  if (!problem && sums_size(file.shape) != in.left()) problem = "it is not as long as its head says";
  if (!problem) problem = read_covered(bytes, file);
  if (!problem) return file;
  in.refuse(*problem);
  return std::nullopt;
}

bool read_sums(const FilmShape& shape, Film& film, Input& in) {
  film = Film(shape.area, shape.layers);
  if (shape.stages > 1) film.add_stage();
  const std::uint64_t pixel = Film::file_bytes_per_pixel(shape.layers, shape.stages);
  const Tiles tiles(shape.area, kFilmTile);
  for (std::int64_t i = 0; i < tiles.count(); ++i) {
    const PixelRect tile = tiles.at(i);
    vm::ByteReader bytes(in.take_checked(tile.pixels() * pixel));
    if (in.read_error() || !film.read_sums(tile, bytes)) return false;
  }
  return true;
}

std::variant<FilmFile, FilmReadError> read(const std::string& path, const ReadLimits& limits, bool with_sums) {
  Input in(path);
  if (in.read_error()) return *in.read_error();
  std::optional<FilmFile> head = read_head_of(in, limits);
  if (!head) return *in.read_error();
  if (!with_sums) return *std::move(head);
  const bool read =
      is_allowed(static_cast<double>(in.left()), limits, in) && read_sums(head->shape, head->render.film, in);
  if (!read) return *in.read_error();
  return *std::move(head);
}

}  // namespace

std::vector<std::string> differences(const Identity& first, const Identity& second, std::string_view there,
                                     std::string_view here) {
  const auto value_in = [](const Identity& identity, const std::string& name) -> const std::string* {
    const auto found =
        std::find_if(identity.begin(), identity.end(), [&](const auto& row) { return row.first == name; });
    return found == identity.end() ? nullptr : &found->second;
  };
  std::vector<std::string> result;
  const auto differ = [&](const std::string& name, const std::string& one, const std::string& other) {
    result.push_back(fmt::format("{} is {} {} and {} {}", name, one, there, other, here));
  };
  for (const auto& [name, value] : first) {
    const std::string* other = value_in(second, name);
    if (!other || *other != value) differ(name, value, other ? *other : "unknown");
  }
  for (const auto& [name, value] : second) {
    if (!value_in(first, name)) differ(name, "unknown", value);
  }
  return result;
}

void write_film(const FilmHeader& header, const PartialRender& render, AtomicFile& file) {
  vm::ByteWriter head, preamble;
  write_head(header, render, head);
  preamble.raw({reinterpret_cast<const std::uint8_t*>(kFilmMagic.data()), kFilmMagic.size()});
  preamble.u32(kFilmFormat);
  preamble.u64(head.size());
  file.write(preamble.bytes());
  file.write(head.bytes());
  write_digest(head.bytes(), file);
  const Tiles tiles(render.film.area(), kFilmTile);
  for (std::int64_t i = 0; i < tiles.count() && !file.problem(); ++i) {
    vm::ByteWriter sums;
    render.film.write_sums(tiles.at(i), sums);
    file.write(sums.bytes());
    write_digest(sums.bytes(), file);
  }
}

std::optional<std::string> write_film(const FilmHeader& header, const PartialRender& render,
                                      const std::string& path) {
  AtomicFile file(path);
  write_film(header, render, file);
  return file.commit();
}

std::variant<FilmFile, FilmReadError> read_film(const std::string& path, const ReadLimits& limits) {
  return read(path, limits, true);
}

std::variant<FilmFile, FilmReadError> read_film_header(const std::string& path, const ReadLimits& limits) {
  return read(path, limits, false);
}

void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace fathom::runtime
