#include "runtime/image/image_png.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <new>

#include "runtime/image/float_image.h"

namespace fathom::runtime {
namespace {

void append(png_structp png, png_bytep data, std::size_t size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}

void ignore(png_structp) {}
void ignore_warning(png_structp, png_const_charp) {}

// libpng's way out of an error: a jump over C frames, and over none of our frames that has anything to destroy.
bool write_header(png_structp png, png_infop info, int width, int height, int bits, bool srgb) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  if (srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
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

// Owns libpng's structures.
class PngWriter {
 public:
  explicit PngWriter(std::vector<std::uint8_t>& bytes)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, ignore_warning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (info_ != nullptr) png_set_write_fn(png_, &bytes, append, ignore);
  }
  ~PngWriter() {
    if (png_ != nullptr) png_destroy_write_struct(&png_, &info_);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  bool good() const { return info_ != nullptr; }
  png_structp png() const { return png_; }
  png_infop info() const { return info_; }

 private:
  png_structp png_;
  png_infop info_;
};

// Reads a file progressively, up to the end of its image. libpng's other interface also unpacks the data that follow,
// a thousand bytes for each byte of the file.
class PngReader {
 public:
  PngReader(double file_size, double memory)
      : file_size_(file_size),
        memory_(memory),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, keep_problem, ignore_warning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (info_ == nullptr) return;
    png_set_progressive_read_fn(png_, this, begin, put_row, end);
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // except those that change samples
  }
  ~PngReader() {
    if (png_ != nullptr) png_destroy_read_struct(&png_, &info_, nullptr);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  std::variant<PngImage, std::string> read(std::span<const std::uint8_t> bytes) {
    if (info_ == nullptr) return "libpng cannot begin";
    // libpng only reads the bytes, but wants them not const.
    if (!process(const_cast<std::uint8_t*>(bytes.data()), bytes.size())) return std::move(problem_);
    if (!ended_) return "it ends too early";
    return std::move(image_);
  }

 private:
  static PngReader& self(png_structp png) { return *static_cast<PngReader*>(png_get_progressive_ptr(png)); }

  [[noreturn]] static void keep_problem(png_structp png, png_const_charp text) {
    static_cast<PngReader*>(png_get_error_ptr(png))->problem_ = text;
    png_longjmp(png, 1);
  }

  bool process(std::uint8_t* bytes, std::size_t size) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_process_data(png_, info_, bytes, size);
    return true;
  }

  // Called after the header has been read.
  static void begin(png_structp png, png_infop info) {
    self(png).row_bytes_ = static_cast<double>(png_get_rowbytes(png, info));  // of the file's own samples
    png_set_expand_16(png);
    if (std::endian::native == std::endian::little) png_set_swap(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    PngImage& picture = self(png).image_;
    picture.width = static_cast<int>(png_get_image_width(png, info));
    picture.height = static_cast<int>(png_get_image_height(png, info));
    picture.components = png_get_channels(png, info);
    if (!self(png).reserve()) png_error(png, self(png).problem_.c_str());
  }

  // Must not throw, because the callers are C frames.
  bool reserve() noexcept try {
    const double pixels = static_cast<double>(image_.width) * image_.height, samples = pixels * image_.components;
    if (pixels > static_cast<double>(kMaxPixels)) {
      problem_ = "it is too large";
      return false;
    }
    // In addition to the file: its samples, and the floats of R, G, B and perhaps A that will be made of the samples.
    const double floats = pixels * (image_.components % 2 == 0 ? 4 : 3);
    const double needed = file_size_ + samples * sizeof(std::uint16_t) + floats * sizeof(float);
    if (needed > memory_) {
      problem_ = too_much_memory(needed, memory_);
      return false;
    }
    const double least = image_.height * (1 + row_bytes_) / kMaxDeflated;
    if (least > file_size_) {
      problem_ = too_few_bytes(image_.width, image_.height, least, file_size_);
      return false;
    }
    image_.samples.resize(static_cast<std::size_t>(samples));
    return true;
  } catch (const std::bad_alloc&) {
    problem_ = "it needs more memory than there is";
    return false;
  }

  static void put_row(png_structp png, png_bytep bytes, png_uint_32 y, int) {
    PngImage& picture = self(png).image_;
    const std::size_t row = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.components);
    png_progressive_combine_row(png, reinterpret_cast<png_bytep>(&picture.samples[y * row]), bytes);
  }

  // Called after the last chunk has been read. libpng only warns if the image's data end, or make no sense, before
  // the last row.
  static void end(png_structp png, png_infop info) {
    self(png).ended_ = png_get_interlace_type(png, info) == PNG_INTERLACE_NONE
                           ? png_get_current_row_number(png) >= png_get_image_height(png, info)
                           : png_get_current_pass_number(png) >= PNG_INTERLACE_ADAM7_PASSES;
  }

  const double file_size_, memory_;
  double row_bytes_ = 0;
  png_structp png_;
  png_infop info_;
  PngImage image_;
  std::string problem_;
  bool ended_ = false;
};

}  // namespace

std::variant<PngImage, std::string> decode_png(std::span<const std::uint8_t> bytes, double memory) {
  return PngReader(static_cast<double>(bytes.size()), memory).read(bytes);
}

std::vector<std::uint8_t> encode_png(int width, int height, int bits, bool srgb, const PngRow& row) {
  std::vector<std::uint8_t> bytes;
  PngWriter writer(bytes);
  if (!writer.good() || !write_header(writer.png(), writer.info(), width, height, bits, srgb)) return {};
  std::vector<std::uint8_t> line(static_cast<std::size_t>(width) * 3 * static_cast<std::size_t>(bits / 8));
  for (int y = 0; y < height; ++y) {
    row(y, line);
    if (!write_row(writer.png(), line.data())) return {};
  }
  if (!write_end(writer.png())) return {};
  return bytes;
}

}  // namespace fathom::runtime
