#include "runtime/image_png.h"

#include <png.h>
#include <zlib.h>

#include <array>
#include <csetjmp>
#include <cstring>

namespace fathom::runtime {
namespace {

void append(png_structp png, png_bytep data, std::size_t size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}

void ignore(png_structp) {}
void be_quiet(png_structp, png_const_charp) {}

// libpng's way out of an error: a jump over frames of C, and of ours none that have anything to destroy.
bool write_header(png_structp png, png_infop about, int width, int height, int bits, bool srgb) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, about, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  if (srgb) png_set_sRGB(png, about, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, about);
  return true;
}

bool write_row(png_structp png, png_const_bytep row) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_write_row(png, row);
  return true;
}

bool write_end(png_structp png) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_write_end(png, nullptr);
  return true;
}

// Frees libpng's things whatever happens.
class Writer {
 public:
  explicit Writer(std::vector<std::uint8_t>& bytes)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, be_quiet)),
        about_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (about_ != nullptr) png_set_write_fn(png_, &bytes, append, ignore);
  }
  ~Writer() {
    if (png_ != nullptr) png_destroy_write_struct(&png_, &about_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  bool good() const { return about_ != nullptr; }
  png_structp png() const { return png_; }
  png_infop about() const { return about_; }

 private:
  png_structp png_;
  png_infop about_;
};

std::uint32_t big_endian(const std::uint8_t* at) {
  return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 | at[3];
}

// A stream of zlib's that is unpacked and thrown away.
class Unpacked {
 public:
  Unpacked() { good_ = inflateInit(&stream_) == Z_OK; }
  ~Unpacked() { inflateEnd(&stream_); }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  double size() const { return size_; }
  void take(std::span<const std::uint8_t> packed, double most) {
    stream_.next_in = const_cast<std::uint8_t*>(packed.data());  // zlib only reads it
    stream_.avail_in = static_cast<uInt>(packed.size());
    std::array<std::uint8_t, 1 << 15> thrown_away;
    while (good_ && size_ <= most && (stream_.avail_in > 0 || stream_.avail_out == 0)) {
      stream_.next_out = thrown_away.data(), stream_.avail_out = static_cast<uInt>(thrown_away.size());
      good_ = inflate(&stream_, Z_NO_FLUSH) == Z_OK;
      size_ += static_cast<double>(thrown_away.size() - stream_.avail_out);
    }
  }

 private:
  z_stream stream_{};
  bool good_;
  double size_ = 0;
};

}  // namespace

bool png_unpacks_beyond(std::span<const std::uint8_t> bytes, double most) {
  constexpr std::size_t kSignature = 8, kAround = 12;  // of a chunk: length, name, checksum
  constexpr double kMostRatio = 1032;                  // of zlib, as its documentation says
  if (static_cast<double>(bytes.size()) * kMostRatio <= most) return false;
  Unpacked unpacked;
  for (std::size_t at = kSignature; bytes.size() >= kAround && at <= bytes.size() - kAround;) {
    const std::size_t length = big_endian(&bytes[at]);
    if (length > bytes.size() - at - kAround) break;
    if (std::memcmp(&bytes[at + 4], "IDAT", 4) == 0) unpacked.take(bytes.subspan(at + 8, length), most);
    at += kAround + length;
  }
  return unpacked.size() > most;
}

std::vector<std::uint8_t> encode_png(int width, int height, int bits, bool srgb, const PngRow& row) {
  std::vector<std::uint8_t> bytes;
  Writer writer(bytes);
  if (!writer.good() || !write_header(writer.png(), writer.about(), width, height, bits, srgb)) return {};
  std::vector<std::uint8_t> line(static_cast<std::size_t>(width) * 3 * static_cast<std::size_t>(bits / 8));
  for (int y = 0; y < height; ++y) {
    row(y, line);
    if (!write_row(writer.png(), line.data())) return {};
  }
  if (!write_end(writer.png())) return {};
  return bytes;
}

}  // namespace fathom::runtime
