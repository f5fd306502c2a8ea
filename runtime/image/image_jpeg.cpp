#include "runtime/image/image_jpeg.h"

#include <array>
#include <csetjmp>
#include <cstdio>

#include "runtime/image/float_image.h"

// jerror.h and jpeglib.h need <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

namespace fathom::runtime {
namespace {

constexpr const char* kTooEarly = "it ends too early";
// A block of 8 by 8 samples takes at least one bit per code: a code for its mean and one for its end. In a
// progressive file one code ends many blocks, so a block needs only the code for its mean.
constexpr double kSamplesInBlock = 64, kBitsOfBlock = 2, kBitsOfProgressiveBlock = 1;
constexpr double kBytesOfCoefficients = kSamplesInBlock * sizeof(JCOEF);
// Each scan visits all blocks, and may consist of only a few bytes. Encoders write about ten scans.
constexpr int kMaxScans = 100;

// True if libjpeg, after this warning, goes on without a part of the image.
bool loses_samples(int warning) {
  return warning == JWRN_HIT_MARKER || warning == JWRN_JPEG_EOF || warning == JWRN_HUFF_BAD_CODE ||
         warning == JWRN_MUST_RESYNC;
}

class JpegReader {
 public:
  JpegReader(std::span<const std::uint8_t> bytes, double memory) : bytes_(bytes), memory_(memory) {
    jpeg_.err = jpeg_std_error(&errors_);
    errors_.error_exit = [](j_common_ptr jpeg) { self(jpeg).leave(); };
    errors_.emit_message = [](j_common_ptr jpeg, int level) {
      if (level < 0 && loses_samples(jpeg->err->msg_code)) self(jpeg).leave();
    };
    jpeg_.client_data = this;
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  std::variant<JpegImage, std::string> read() {
    if (!begin() || !is_allowed()) return std::move(problem_);
    image_.samples.resize(row() * static_cast<std::size_t>(image_.height));
    if (!decode()) return std::move(problem_);
    return std::move(image_);
  }

 private:
  static JpegReader& self(j_common_ptr jpeg) { return *static_cast<JpegReader*>(jpeg->client_data); }

  bool fail(std::string why) {
    if (problem_.empty()) problem_ = std::move(why);
    return false;
  }

  // libjpeg's way out of an error: a jump over C frames, and over none of our frames that has anything to destroy.
  [[noreturn]] void leave() {
    if (errors_.msg_code == JWRN_HIT_MARKER || errors_.msg_code == JWRN_JPEG_EOF) {
      problem_ = kTooEarly;
    } else {
      std::array<char, JMSG_LENGTH_MAX> text{};
      errors_.format_message(reinterpret_cast<j_common_ptr>(&jpeg_), text.data());
      problem_ = text.data();
    }
    std::longjmp(out_, 1);
  }

  bool begin() {
    if (setjmp(out_) != 0) return false;
    jpeg_create_decompress(&jpeg_);
    jpeg_mem_src(&jpeg_, bytes_.data(), bytes_.size());
    jpeg_read_header(&jpeg_, TRUE);
    return true;
  }

  double blocks() const {
    double count = 0;
    for (const jpeg_component_info& each : std::span(jpeg_.comp_info, static_cast<std::size_t>(jpeg_.num_components)))
      count += static_cast<double>(each.width_in_blocks) * each.height_in_blocks;
    return count;
  }

  // Checks the header's values, before memory is allocated for them.
  bool is_allowed() {
    const bool grey = jpeg_.jpeg_color_space == JCS_GRAYSCALE;
    if (jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK) {
      return fail("its colours are those of inks (CMYK), which are not read; save it as RGB");
    }
    if (!grey && jpeg_.num_components != 3) return fail("it has neither one channel nor three");
    if (jpeg_.arith_code) return fail("it has arithmetic coding, which is not read; save it with Huffman coding");
    image_.width = static_cast<int>(jpeg_.image_width);
    image_.height = static_cast<int>(jpeg_.image_height);
    image_.components = grey ? 1 : 3;
    const double pixels = static_cast<double>(image_.width) * image_.height;
    if (pixels > static_cast<double>(kMaxPixels)) return fail("it is too large");
    const double coefficients = jpeg_has_multiple_scans(&jpeg_) ? blocks() * kBytesOfCoefficients : 0;
    const double file_size = static_cast<double>(bytes_.size());
    const double needed = file_size + pixels * (image_.components + 3 * sizeof(float)) + coefficients;
    if (needed > memory_) return fail(too_much_memory(needed, memory_));
    const double least = blocks() * (jpeg_.progressive_mode ? kBitsOfProgressiveBlock : kBitsOfBlock) / 8;
    return least <= file_size || fail(too_few_bytes(image_.width, image_.height, least, file_size));
  }

  std::size_t row() const {
    return static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.components);
  }

  bool decode() { return setjmp(out_) == 0 && decode_rows(); }

  // Not inlined: longjmp() may clobber variables of the function that calls setjmp().
  [[gnu::noinline]] bool decode_rows() {
    jpeg_.out_color_space = image_.components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_.dct_method = JDCT_ISLOW;  // the same bits with and without SIMD
    jpeg_.do_block_smoothing = FALSE;
    jpeg_.buffered_image = jpeg_has_multiple_scans(&jpeg_);
    const bool buffered = jpeg_.buffered_image != FALSE;
    jpeg_start_decompress(&jpeg_);
    if (buffered && (!read_scans() || !jpeg_start_output(&jpeg_, jpeg_.input_scan_number))) return false;
    while (jpeg_.output_scanline < jpeg_.output_height) {
      JSAMPROW samples = image_.samples.data() + jpeg_.output_scanline * row();
      if (jpeg_read_scanlines(&jpeg_, &samples, 1) == 0) return fail(kTooEarly);
    }
    if (buffered && !jpeg_finish_output(&jpeg_)) return fail(kTooEarly);
    return jpeg_finish_decompress(&jpeg_) != FALSE || fail("its content makes no sense");
  }

  // Reads all scans of a file that stores its components, or their bits, one after the other. A component would be
  // grey without a scan that begins with its mean.
  bool read_scans() {
    std::array<bool, MAX_COMPONENTS> has_mean{};
    int scans = 0;
    for (int got = JPEG_REACHED_SOS; got != JPEG_REACHED_EOI; got = jpeg_consume_input(&jpeg_)) {
      if (got != JPEG_REACHED_SOS) continue;
      if (++scans > kMaxScans) return fail("it has more than 100 scans, as no program writes");
      for (int i = 0; i < jpeg_.comps_in_scan && jpeg_.Ss == 0; ++i) {
        has_mean[static_cast<std::size_t>(jpeg_.cur_comp_info[i]->component_index)] = true;
      }
    }
    for (int i = 0; i < jpeg_.num_components; ++i) {
      if (!has_mean[static_cast<std::size_t>(i)]) return fail(kTooEarly);
    }
    return true;
  }

  const std::span<const std::uint8_t> bytes_;
  const double memory_;
  jpeg_decompress_struct jpeg_{};
  jpeg_error_mgr errors_{};
  std::jmp_buf out_{};
  JpegImage image_;
  std::string problem_;
};

}  // namespace

std::variant<JpegImage, std::string> decode_jpeg(std::span<const std::uint8_t> bytes, double memory) {
  return JpegReader(bytes, memory).read();
}

}  // namespace fathom::runtime
