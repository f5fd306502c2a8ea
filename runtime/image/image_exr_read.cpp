// Reads OpenEXR files by the library's C core, chunk by chunk. The library's C++ classes, which image_exr.cpp uses
// for writing, allocate the sizes given in a header before they look at the file, gigabytes for a file of some
// hundred bytes. If a chunk's data end early, these classes return uninitialised memory. Tested by:
// tests/runtime/image/image_exr_read_test.cpp, image_exr_test.cpp, image_read_test.cpp
#include <half.h>
#include <openexr.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <set>
#include <span>

#include "runtime/image/image_exr.h"
#include "runtime/image/image_exr_color.h"

namespace fathom::runtime {
namespace {

// Memory for decoding, in addition to the image, in chunks: packed and unpacked copies of one chunk.
constexpr double kChunks = 8;
constexpr const char* kBadExr = "its header makes no sense";

std::int64_t length_of(std::int64_t first, std::int64_t last) { return last - first + 1; }
std::int64_t width_of(const exr_attr_box2i_t& window) { return length_of(window.min.x, window.max.x); }
std::int64_t height_of(const exr_attr_box2i_t& window) { return length_of(window.min.y, window.max.y); }

double pixels_of(const exr_attr_box2i_t& window) {
  return static_cast<double>(width_of(window)) * static_cast<double>(height_of(window));
}

// Returns how many bytes each compression makes of one at best. This is a limit, not the usual ratio.
double max_unpacked(exr_compression_t compression) {
  switch (compression) {
    case EXR_COMPRESSION_NONE:
      return 1;
    case EXR_COMPRESSION_RLE:
      return 64;  // a run of 128 in two bytes
    case EXR_COMPRESSION_B44:
    case EXR_COMPRESSION_B44A:
      return 11;  // 16 halves in 14 bytes, flat blocks in three
    case EXR_COMPRESSION_PXR24:
      return kMaxDeflated * 4 / 3;  // the fourth byte of floats was dropped before
    default:
      return kMaxDeflated;  // ZIP; PIZ has at most 410, runs of 256 halves in ten bits
  }
}

Chromaticities primaries_of(const exr_attr_chromaticities_t& xy) {
  return {{xy.red_x, xy.red_y}, {xy.green_x, xy.green_y}, {xy.blue_x, xy.blue_y}, {xy.white_x, xy.white_y}};
}

std::string text_of(const exr_attr_string_t& text) { return {text.str, static_cast<std::size_t>(text.length)}; }

// Returns nothing for kinds that Attribute does not have.
std::optional<Attribute> value_of(const exr_attribute_t& attribute) {
  switch (attribute.type) {
    case EXR_ATTR_INT:
      return attribute.i;
    case EXR_ATTR_ENVMAP:
      return int{attribute.uc};
    case EXR_ATTR_FLOAT:
      return attribute.f;
    case EXR_ATTR_STRING:
      return text_of(*attribute.string);
    case EXR_ATTR_STRING_VECTOR: {
      const std::span texts(attribute.stringvector->strings,
                            static_cast<std::size_t>(attribute.stringvector->n_strings));
      std::vector<std::string> list(texts.size());
      std::transform(texts.begin(), texts.end(), list.begin(), text_of);
      return list;
    }
    case EXR_ATTR_M44F: {
      Matrix4 rows;
      std::copy_n(attribute.m44f->m, rows.size(), rows.begin());
      return rows;
    }
    default:
      return std::nullopt;
  }
}

// Takes the place of the library's step of a decoding pipeline, which leaves out rows without chroma (OpenEXR 3.1.5).
// Converts the numbers of a chunk of scan lines, some of which have channels that others do not have.
exr_result_t unpack_subsampled(exr_decode_pipeline_t* pipeline) {
  const auto* from = static_cast<const std::uint8_t*>(pipeline->unpacked_buffer);
  const bool is_packed = pipeline->unpacked_buffer == pipeline->packed_buffer;
  const std::uint8_t* const end = from + (is_packed ? pipeline->chunk.packed_size : pipeline->chunk.unpacked_size);
  for (std::int32_t y = 0; y < pipeline->chunk.height; ++y) {
    for (const exr_coding_channel_info_t& channel :
         std::span(pipeline->channels, static_cast<std::size_t>(pipeline->channel_count))) {
      if ((pipeline->chunk.start_y + y) % channel.y_samples != 0) continue;
      const std::ptrdiff_t size = channel.bytes_per_element;
      if (end - from < size * channel.width) return EXR_ERR_CORRUPT_CHUNK;
      std::uint8_t* to = channel.decode_to_ptr + std::ptrdiff_t{y / channel.y_samples} * channel.user_line_stride;
      for (std::int32_t x = 0; x < channel.width; ++x, from += size, to += channel.user_pixel_stride) {
        std::uint32_t bits = 0;
        for (std::ptrdiff_t byte = 0; byte < size; ++byte) bits |= std::uint32_t{from[byte]} << (8 * byte);
        if (channel.data_type == EXR_PIXEL_HALF) {
          half number;
          number.setBits(static_cast<std::uint16_t>(bits));
          bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
        }
        std::memcpy(to, &bits, sizeof bits);
      }
    }
  }
  return EXR_ERR_SUCCESS;
}

class ExrReader {
 public:
  ExrReader(const std::vector<std::uint8_t>& bytes, double memory) : bytes_(bytes), memory_(memory) {}
  ~ExrReader() {
    if (context_ != nullptr) exr_finish(&context_);
  }
  ExrReader(const ExrReader&) = delete;
  ExrReader& operator=(const ExrReader&) = delete;

  std::variant<FloatImage, std::string> read() {
    if (open() && choose_part() && is_allowed() && has_chunks() && take_header() && read_chunks()) {
      whole_to_float();
      auto problem = decode_colors(image_, primaries_, subsampled_);
      if (!problem) return std::move(image_);
      return *std::move(problem);
    }
    return problem_.empty() ? kBadExr : problem_;
  }

 private:
  bool fail(std::string_view why) {
    if (problem_.empty()) problem_ = why;
    return false;
  }

  // When a call fails, the library has usually reported the reason to keep_message() before.
  bool good(exr_result_t result) { return result == EXR_ERR_SUCCESS || fail(exr_get_default_error_message(result)); }

  bool open() {
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    how.user_data = this;
    how.read_fn = read_bytes;
    how.size_fn = [](exr_const_context_t, void* self) {
      return static_cast<std::int64_t>(static_cast<ExrReader*>(self)->bytes_.size());
    };
    how.error_handler_fn = keep_message;
    how.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
    return good(exr_start_read(&context_, "picture", &how));
  }

  // Chooses the first part of flat pixels with colours, or else the first part.
  bool choose_part() {
    int count = 0;
    if (!good(exr_get_count(context_, &count))) return false;
    for (part_ = 0; part_ < count; ++part_) {
      if (!good(exr_get_storage(context_, part_, &storage_)) ||
          !good(exr_get_channels(context_, part_, &channels_))) {
        return false;
      }
      if (is_flat() && !color_layers(channel_names()).empty()) break;
    }
    if (part_ == count) part_ = 0;
    exr_compression_t compression{};
    if (!good(exr_get_storage(context_, part_, &storage_)) || !good(exr_get_channels(context_, part_, &channels_)) ||
        !good(exr_get_compression(context_, part_, &compression))) {
      return false;
    }
    if (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB) {
      return fail("it is compressed by DWA, which is not read; ZIP and PIZ lose nothing");
    }
    max_unpacked_ = max_unpacked(compression);
    return is_flat() || fail("its pixels are deep: each has many samples");
  }

  std::vector<ChannelName> channel_names() const {
    std::vector<ChannelName> names;
    for (const exr_attr_chlist_entry_t& channel : channels()) {
      names.push_back({text_of(channel.name), channel.pixel_type == EXR_PIXEL_UINT});
    }
    return names;
  }

  bool is_tiled() const { return storage_ == EXR_STORAGE_TILED; }
  bool is_flat() const { return is_tiled() || storage_ == EXR_STORAGE_SCANLINE; }
  std::span<const exr_attr_chlist_entry_t> channels() const {
    return {channels_->entries, static_cast<std::size_t>(channels_->num_channels)};
  }

  bool is_allowed() {
    std::uint64_t chunk = 0;
    if (!good(exr_get_data_window(context_, part_, &data_)) ||
        !good(exr_get_display_window(context_, part_, &display_)) ||
        !good(exr_get_chunk_unpacked_size(context_, part_, &chunk))) {
      return false;
    }
    for (const exr_attr_box2i_t& window : {data_, display_}) {
      if (width_of(window) < 1 || height_of(window) < 1) return fail(kBadExr);
      if (pixels_of(window) > static_cast<double>(kMaxPixels)) return fail("it is too large");
    }
    const std::int64_t right = std::int64_t{data_.min.x} - display_.min.x,
                       down = std::int64_t{data_.min.y} - display_.min.y;
    if (std::max(std::abs(right), std::abs(down)) > kMaxPixels) return fail("it is too large");
    if (!is_sampling_allowed()) return false;
    const double values = pixels_of(data_) * values_per_pixel();
    if (values > static_cast<double>(kMaxValues)) return fail("it is too large");
    const double needed = sizeof(float) * values + kChunks * static_cast<double>(chunk);
    if (needed > memory_) return fail(too_much_memory(needed, memory_));
    const double least = pixels_of(data_) * bytes_per_pixel() / max_unpacked_,
                 has = static_cast<double>(bytes_.size());
    return least <= has ||
           fail(too_few_bytes(static_cast<int>(width_of(data_)), static_cast<int>(height_of(data_)), least, has));
  }

  // Returns every how many columns and rows a channel has a value: 1, or 2 for chroma.
  static int sampling(const exr_attr_chlist_entry_t& channel) { return channel.x_sampling; }

  bool is_sampling_allowed() {
    for (const exr_attr_chlist_entry_t& channel : channels()) {
      const int x = channel.x_sampling, y = channel.y_sampling;
      if (x == 1 && y == 1) continue;
      const std::string name = text_of(channel.name);
      const bool chroma = name_in_layer(name) == "RY" || name_in_layer(name) == "BY";
      if (!chroma || x != 2 || y != 2 || is_tiled()) {
        return fail(
            fmt::format("its channel `{}` is subsampled by {} and {}, which is not supported; RY and BY of scan "
                        "lines by 2 and 2 are",
                        name, x, y));
      }
      if (data_.min.x % 2 != 0 || data_.min.y % 2 != 0 || width_of(data_) % 2 != 0 || height_of(data_) % 2 != 0) {
        return fail(fmt::format("its channel `{}` is subsampled by 2, and its data window is not even", name));
      }
    }
    return true;
  }

  // Numbers in memory at the same time. Luminance becomes three colours, by way of the library's type.
  double values_per_pixel() const {
    return channels_->num_channels + 4.0 * static_cast<double>(color_layers(channel_names(), true).size());
  }

  // Size of an unpacked pixel, in the file's own types.
  double bytes_per_pixel() const {
    double bytes = 0;
    for (const exr_attr_chlist_entry_t& channel : channels()) {
      bytes += (channel.pixel_type == EXR_PIXEL_HALF ? 2.0 : 4.0) / (channel.x_sampling * channel.y_sampling);
    }
    return bytes;
  }

  // Checks that the chunk table fits the file, before memory is allocated for the chunks' contents.
  bool has_chunks() {
    chunk_width_ = static_cast<std::int32_t>(width_of(data_));
    exr_chunk_info_t first{};
    return good(is_tiled() ? exr_get_tile_sizes(context_, part_, 0, 0, &chunk_width_, &chunk_height_)
                           : exr_get_scanlines_per_chunk(context_, part_, &chunk_height_)) &&
           find_chunk(0, 0, first);
  }

  bool take_header() {
    image_.width = static_cast<int>(width_of(display_));
    image_.height = static_cast<int>(height_of(display_));
    const int x = data_.min.x - display_.min.x, y = data_.min.y - display_.min.y;
    image_.area = {x, y, x + static_cast<int>(width_of(data_)), y + static_cast<int>(height_of(data_))};
    image_.channels = channel_names();
    for (const exr_attr_chlist_entry_t& channel : channels()) {
      image_.values.emplace_back(image_.area.pixels());
      if (sampling(channel) == 2) subsampled_.insert(text_of(channel.name));
    }
    std::int32_t count = 0;
    if (!good(exr_get_attribute_count(context_, part_, &count))) return false;
    for (std::int32_t i = 0; i < count; ++i) {
      const exr_attribute_t* attribute = nullptr;
      if (!good(exr_get_attribute_by_index(context_, part_, EXR_ATTR_LIST_FILE_ORDER, i, &attribute))) return false;
      if (auto value = value_of(*attribute)) image_.attributes[attribute->name] = *std::move(value);
      if (attribute->type == EXR_ATTR_CHROMATICITIES) primaries_ = primaries_of(*attribute->chromaticities);
    }
    return true;
  }

  // Finds the chunk whose first value is at (x, y) of the data window. Mipmapped files: in the full-size level.
  bool find_chunk(std::int64_t x, std::int64_t y, exr_chunk_info_t& chunk) {
    return good(is_tiled()
                    ? exr_read_tile_chunk_info(context_, part_, static_cast<int>(x / chunk_width_),
                                               static_cast<int>(y / chunk_height_), 0, 0, &chunk)
                    : exr_read_scanline_chunk_info(context_, part_, static_cast<int>(data_.min.y + y), &chunk));
  }

  bool read_chunks() {
    for (std::int64_t y = 0; y < height_of(data_); y += chunk_height_) {
      for (std::int64_t x = 0; x < width_of(data_); x += chunk_width_) {
        exr_chunk_info_t chunk{};
        if (!find_chunk(x, y, chunk) || !decode(chunk, x, y)) return false;
      }
    }
    return true;
  }

  // Decodes a chunk into the image. The chunk's first value is at (x, y) of the data window.
  bool decode(const exr_chunk_info_t& chunk, std::int64_t x, std::int64_t y) {
    if (x + chunk.width > width_of(data_) || y + chunk.height > height_of(data_)) return fail(kBadExr);
    exr_decode_pipeline_t pipeline = {};
    bool decoded = good(exr_decoding_initialize(context_, part_, &chunk, &pipeline));
    const std::size_t at = static_cast<std::size_t>(y * width_of(data_) + x);
    for (std::size_t c = 0; decoded && c < image_.channels.size(); ++c) {
      exr_coding_channel_info_t& channel = pipeline.channels[c];
      // Chroma is spread to the pixels that have it.
      const std::int32_t step = sampling(channels()[c]), row = static_cast<std::int32_t>(width_of(data_));
      channel.decode_to_ptr = reinterpret_cast<std::uint8_t*>(&image_.values[c][at]);
      channel.user_data_type = image_.channels[c].whole ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
      channel.user_bytes_per_element = sizeof(float);
      channel.user_pixel_stride = static_cast<std::int32_t>(sizeof(float)) * step;
      channel.user_line_stride = static_cast<std::int32_t>(sizeof(float)) * step * row;
    }
    decoded = decoded && good(exr_decoding_choose_default_routines(context_, part_, &pipeline));
    if (!subsampled_.empty()) pipeline.unpack_and_convert_fn = unpack_subsampled;
    decoded = decoded && good(exr_decoding_run(context_, part_, &pipeline));
    exr_decoding_destroy(context_, &pipeline);
    return decoded;
  }

  // Converts whole numbers, which the library has stored bit by bit in place of floats.
  void whole_to_float() {
    for (std::size_t c = 0; c < image_.channels.size(); ++c) {
      if (!image_.channels[c].whole) continue;
      for (float& value : image_.values[c]) value = static_cast<float>(std::bit_cast<std::uint32_t>(value));
    }
  }

  static std::int64_t read_bytes(exr_const_context_t, void* self, void* out, std::uint64_t size, std::uint64_t offset,
                                 exr_stream_error_func_ptr_t) {
    const std::vector<std::uint8_t>& bytes = static_cast<ExrReader*>(self)->bytes_;
    const std::uint64_t count = offset < bytes.size() ? std::min<std::uint64_t>(size, bytes.size() - offset) : 0;
    if (count > 0) std::memcpy(out, bytes.data() + offset, count);
    return static_cast<std::int64_t>(count);
  }

  static void keep_message(exr_const_context_t context, exr_result_t, const char* text) {
    void* self = nullptr;
    if (exr_get_user_data(context, &self) == EXR_ERR_SUCCESS && self != nullptr) {
      static_cast<ExrReader*>(self)->fail(text);
    }
  }

  const std::vector<std::uint8_t>& bytes_;
  const double memory_;
  exr_context_t context_ = nullptr;
  int part_ = 0;
  exr_storage_t storage_{};
  double max_unpacked_ = 1;
  std::int32_t chunk_width_ = 0, chunk_height_ = 0;  // pixels; chunks at the edges may be smaller
  exr_attr_box2i_t data_{}, display_{};
  const exr_attr_chlist_t* channels_ = nullptr;
  Chromaticities primaries_;
  std::set<std::string> subsampled_;  // channels with a value for 2 x 2 pixels
  FloatImage image_;
  std::string problem_;
};

}  // namespace

std::variant<FloatImage, std::string> decode_exr(const std::vector<std::uint8_t>& bytes, double memory) {
  return ExrReader(bytes, memory - static_cast<double>(bytes.size())).read();
}

}  // namespace fathom::runtime
