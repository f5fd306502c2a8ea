#include "runtime/image_exr.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>
#include <openexr.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "runtime/atomic_file.h"

namespace fathom::runtime {
namespace {

constexpr int kNoThreads = 0;  // beside the caller's

// OpenEXR's view of the file that is written. What goes wrong is kept there and said by commit().
class FileSink : public Imf::OStream {
 public:
  FileSink(AtomicFile& file, const std::string& path) : OStream(path.c_str()), file_(file) {}
  void write(const char bytes[], int count) override {
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes);
    if (!file_.write({first, static_cast<std::size_t>(count)})) throw std::runtime_error("not written");
  }
  std::uint64_t tellp() override { return file_.position(); }
  void seekp(std::uint64_t position) override {
    if (!file_.seek(position)) throw std::runtime_error("not written");
  }

 private:
  AtomicFile& file_;
};

class BytesSource : public Imf::IStream {
 public:
  explicit BytesSource(const std::vector<std::uint8_t>& bytes) : IStream("picture"), bytes_(bytes) {}
  bool read(char out[], int count) override {
    const auto size = static_cast<std::uint64_t>(count);
    if (at_ > bytes_.size() || size > bytes_.size() - at_) throw std::runtime_error("the file ends too early");
    std::memcpy(out, bytes_.data() + at_, size);
    at_ += size;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = position; }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::uint64_t at_ = 0;
};

std::int64_t length_of(std::int64_t first, std::int64_t last) { return last - first + 1; }

double pixels_of(const exr_attr_box2i_t& window) {
  return static_cast<double>(length_of(window.min.x, window.max.x)) *
         static_cast<double>(length_of(window.min.y, window.max.y));
}

// Why a file may not be opened by the C++ classes below, if for any reason: they set aside what an attribute says
// that it has, and the buffers for lines as wide as the header says, before they read any of it, gigabytes for a file
// of a hundred bytes. So the library's own core looks at the file first.
class HeaderCheck {
 public:
  explicit HeaderCheck(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  // Of a picture that would take more than `memory` bytes, too.
  std::optional<std::string> find_problem(double memory) {
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    how.user_data = this;
    how.read_fn = read;
    how.size_fn = [](exr_const_context_t, void* self) {
      return static_cast<std::int64_t>(static_cast<HeaderCheck*>(self)->bytes_.size());
    };
    how.error_handler_fn = keep_message;
    how.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
    exr_context_t context = nullptr;
    const exr_result_t result = exr_start_read(&context, "picture", &how);
    std::optional<std::string> problem;
    if (result != EXR_ERR_SUCCESS) {
      problem = message_.empty() ? exr_get_default_error_message(result) : message_;
    } else {
      problem = excess_of(context, memory);
    }
    if (context != nullptr) exr_finish(&context);
    return problem;
  }

 private:
  // What decoding takes beside the numbers: some copies of a chunk, packed and unpacked, and of tiles a row of them.
  static constexpr double kChunks = 8;

  static std::optional<std::string> excess_of(exr_const_context_t context, double memory) {
    constexpr int kPart = 0;  // the one that is read
    exr_attr_box2i_t data{}, display{};
    const exr_attr_chlist_t* channels = nullptr;
    std::uint64_t chunk = 0;
    if (exr_get_data_window(context, kPart, &data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(context, kPart, &display) != EXR_ERR_SUCCESS ||
        exr_get_channels(context, kPart, &channels) != EXR_ERR_SUCCESS ||
        exr_get_chunk_unpacked_size(context, kPart, &chunk) != EXR_ERR_SUCCESS) {
      return "its header makes no sense";
    }
    const double values = pixels_of(data) * channels->num_channels;
    constexpr double kMost = kMostPixels;
    if (pixels_of(data) > kMost || pixels_of(display) > kMost || values > static_cast<double>(kMostValues)) {
      return "it is too large";
    }
    std::uint32_t tile_width = 0, tile_height = 0;  // both stay 0 where there are lines
    exr_tile_level_mode_t level{};
    exr_tile_round_mode_t round{};
    exr_get_tile_descriptor(context, kPart, &tile_width, &tile_height, &level, &round);
    const double row_of_tiles =
        static_cast<double>(length_of(data.min.x, data.max.x)) * tile_height * channels->num_channels;
    const double needed = sizeof(float) * (values + row_of_tiles) + kChunks * static_cast<double>(chunk);
    if (needed > memory) return too_much_memory(needed, memory);
    return std::nullopt;
  }

  static std::int64_t read(exr_const_context_t, void* self, void* out, std::uint64_t size, std::uint64_t offset,
                           exr_stream_error_func_ptr_t) {
    const std::vector<std::uint8_t>& bytes = static_cast<HeaderCheck*>(self)->bytes_;
    const std::uint64_t count = offset < bytes.size() ? std::min<std::uint64_t>(size, bytes.size() - offset) : 0;
    if (count > 0) std::memcpy(out, bytes.data() + offset, count);
    return static_cast<std::int64_t>(count);
  }

  static void keep_message(exr_const_context_t context, exr_result_t, const char* text) {
    void* self = nullptr;
    if (exr_get_user_data(context, &self) == EXR_ERR_SUCCESS && self != nullptr) {
      static_cast<HeaderCheck*>(self)->message_ = text;
    }
  }

  const std::vector<std::uint8_t>& bytes_;
  std::string message_;
};

Imath::Box2i window_of(const PixelRect& area) { return {{area.x0, area.y0}, {area.x1 - 1, area.y1 - 1}}; }

struct AttributeWriter {
  Imf::Header& header;
  const std::string& name;

  void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
  void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
  void operator()(const std::string& value) const { header.insert(name, Imf::StringAttribute(value)); }
  void operator()(const std::vector<std::string>& value) const {
    header.insert(name, Imf::StringVectorAttribute(value));
  }
  void operator()(const Matrix4& value) const {
    Imath::M44f matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = value[static_cast<std::size_t>(i)];
    header.insert(name, Imf::M44fAttribute(matrix));
  }
};

Imf::Header header_of(const ImageShape& image) {
  Imf::Header header(window_of({0, 0, image.width, image.height}), window_of(image.area));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const ChannelName& channel : image.channels) {
    header.channels().insert(channel.name, Imf::Channel(channel.whole ? Imf::UINT : Imf::FLOAT));
  }
  for (const auto& [name, value] : image.attributes) std::visit(AttributeWriter{header, name}, value);
  return header;
}

// A slice whose rows begin at `row`, one after another `stride` bytes apart; the same one again and again for 0.
Imf::Slice slice_of(Imf::PixelType type, void* row, const PixelRect& area, std::size_t stride) {
  constexpr std::size_t kSize = 4;
  // OpenEXR wants the address that the picture's pixel (0, 0) would have.
  const auto base =
      reinterpret_cast<std::uintptr_t>(row) -
      static_cast<std::uintptr_t>(static_cast<std::int64_t>(area.x0) * static_cast<std::int64_t>(kSize) +
                                  static_cast<std::int64_t>(area.y0) * static_cast<std::int64_t>(stride));
  return Imf::Slice(type, reinterpret_cast<char*>(base), kSize, stride);
}

// Values from outside UINT's range to its ends, NaN to 0.
std::uint32_t to_whole(float value) {
  if (!(value > 0)) return 0;
  return value < 0x1p32f ? static_cast<std::uint32_t>(value) : ~0u;
}

void write_rows(const ImageRows& image, Imf::OutputFile& file) {
  const std::size_t width = static_cast<std::size_t>(image.area.width()), count = image.channels.size();
  std::vector<std::vector<float>> floats(count, std::vector<float>(width));
  std::vector<std::vector<std::uint32_t>> wholes(count);
  std::vector<std::span<float>> rows(floats.begin(), floats.end());
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < count; ++c) {
    const bool whole = image.channels[c].whole;
    if (whole) wholes[c].resize(width);
    void* row = whole ? static_cast<void*>(wholes[c].data()) : floats[c].data();
    buffer.insert(image.channels[c].name, slice_of(whole ? Imf::UINT : Imf::FLOAT, row, image.area, 0));
  }
  file.setFrameBuffer(buffer);
  for (int y = image.area.y0; y < image.area.y1; ++y) {
    image.fill(y, rows);
    for (std::size_t c = 0; c < count; ++c) {
      std::transform(floats[c].begin(), floats[c].begin() + static_cast<std::ptrdiff_t>(wholes[c].size()),
                     wholes[c].begin(), to_whole);
    }
    file.writePixels(1);
  }
}

Attributes attributes_of(const Imf::Header& header) {
  Attributes attributes;
  for (auto it = header.begin(); it != header.end(); ++it) {
    const Imf::Attribute& attribute = it.attribute();
    if (const auto* number = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
      attributes[it.name()] = number->value();
    } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
      attributes[it.name()] = real->value();
    } else if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
      attributes[it.name()] = text->value();
    } else if (const auto* texts = dynamic_cast<const Imf::StringVectorAttribute*>(&attribute)) {
      attributes[it.name()] = texts->value();
    } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
      Matrix4 rows;
      for (int i = 0; i < 16; ++i) rows[static_cast<std::size_t>(i)] = matrix->value()[i / 4][i % 4];
      attributes[it.name()] = rows;
    }
  }
  return attributes;
}

// The picture, its numbers still 0; its size is known to be allowed.
FloatImage read_header(const Imf::Header& header) {
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  FloatImage image;
  image.width = display.max.x - display.min.x + 1;
  image.height = display.max.y - display.min.y + 1;
  image.area = {data.min.x - display.min.x, data.min.y - display.min.y, data.max.x - display.min.x + 1,
                data.max.y - display.min.y + 1};
  image.attributes = attributes_of(header);
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      throw std::runtime_error("a channel is subsampled");
    image.channels.push_back({it.name(), it.channel().type == Imf::UINT});
    image.values.emplace_back(image.area.pixels());
  }
  return image;
}

}  // namespace

std::optional<std::string> write_exr(const ImageRows& image, const std::string& path) {
  AtomicFile target(path);
  try {
    FileSink sink(target, path);
    Imf::OutputFile file(sink, header_of(image), kNoThreads);
    write_rows(image, file);
  } catch (const std::exception& error) {
    if (target.problem()) return target.problem();
    return fmt::format("cannot write `{}`: {}", path, error.what());
  }
  return target.commit();
}

std::variant<FloatImage, std::string> decode_exr(const std::vector<std::uint8_t>& bytes, double memory) {
  if (auto problem = HeaderCheck(bytes).find_problem(memory - static_cast<double>(bytes.size()))) return *problem;
  try {
    BytesSource source(bytes);
    Imf::InputFile file(source, kNoThreads);
    FloatImage image = read_header(file.header());
    const Imath::Box2i data = file.header().dataWindow();
    const PixelRect place{data.min.x, data.min.y, data.max.x + 1, data.max.y + 1};
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
      const std::size_t stride = sizeof(float) * static_cast<std::size_t>(place.width());
      buffer.insert(image.channels[c].name, slice_of(Imf::FLOAT, image.values[c].data(), place, stride));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(data.min.y, data.max.y);
    return image;
  } catch (const std::exception& error) {
    return std::string(error.what());
  }
}

}  // namespace fathom::runtime
