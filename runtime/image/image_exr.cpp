#include "runtime/image/image_exr.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <stdexcept>

#include "runtime/base/atomic_file.h"

namespace fathom::runtime {
namespace {

constexpr int kNoThreads = 0;  // in addition to the caller's

// OpenEXR's view of the file that is written. The file keeps the first failure, and commit() returns it.
class FileSink : public Imf::OStream {
 public:
  explicit FileSink(AtomicFile& file) : OStream(file.name().c_str()), file_(file) {}
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

// Returns a slice whose rows begin at `row` and lie `stride` bytes apart. With a stride of 0 all rows are the same.
Imf::Slice slice_of(Imf::PixelType type, void* row, const PixelRect& area, std::size_t stride) {
  constexpr std::size_t kSize = 4;
  // OpenEXR wants the address that the image's pixel (0, 0) would have.
  const auto base =
      reinterpret_cast<std::uintptr_t>(row) -
      static_cast<std::uintptr_t>(static_cast<std::int64_t>(area.x0) * static_cast<std::int64_t>(kSize) +
                                  static_cast<std::int64_t>(area.y0) * static_cast<std::int64_t>(stride));
  return Imf::Slice(type, reinterpret_cast<char*>(base), kSize, stride);
}

// Clamps values to UINT's range; NaN becomes 0.
std::uint32_t to_whole_number(float value) {
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
                     wholes[c].begin(), to_whole_number);
    }
    file.writePixels(1);
  }
}

}  // namespace

std::optional<std::string> write_exr(const ImageRows& image, const std::string& path) {
  AtomicFile target(path);
  return write_exr(image, target);
}

std::optional<std::string> write_exr(const ImageRows& image, AtomicFile& target) {
  try {
    FileSink sink(target);
    Imf::OutputFile file(sink, header_of(image), kNoThreads);
    write_rows(image, file);
  } catch (const std::exception& error) {
    if (target.problem()) return target.problem();
    return fmt::format("cannot write `{}`: {}", target.name(), error.what());
  }
  return target.commit();
}

}  // namespace fathom::runtime
