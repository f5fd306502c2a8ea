#include "runtime/image/image_read.h"

#include <fmt/format.h>
#include <stb_image.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

#include "compiler/scene/srgb.h"
#include "runtime/image/image_exr.h"
#include "runtime/image/image_hdr.h"
#include "runtime/image/image_io.h"
#include "runtime/image/image_jpeg.h"
#include "runtime/image/image_png.h"

namespace fathom::runtime {
namespace {

using Bytes = std::vector<std::uint8_t>;
using DecodeResult = std::variant<FloatImage, std::string>;

// Returns an image of that size with the channels R, G, B and perhaps A.
FloatImage empty_image(int width, int height, bool alpha) {
  FloatImage image;
  image.width = width;
  image.height = height;
  image.area = {0, 0, width, height};
  for (const char* name : {"R", "G", "B", "A"}) {
    if (*name == 'A' && !alpha) continue;
    image.channels.push_back({name, false});
    image.values.emplace_back(image.area.pixels());
  }
  return image;
}

// Makes an image of samples [y][x][component] with 1 (grey), 2 (grey and alpha), 3 or 4 components. `light` converts
// colours, `share` converts alpha.
template <typename Sample, typename Light, typename Share>
FloatImage widened(const Sample* samples, int width, int height, int components, const Light& light,
                   const Share& share) {
  const bool alpha = components % 2 == 0, grey = components <= 2;
  FloatImage image = empty_image(width, height, alpha);
  const std::size_t step = static_cast<std::size_t>(components);
  for (std::size_t i = 0; i < image.area.pixels(); ++i) {
    const Sample* pixel = samples + i * step;
    for (std::size_t c = 0; c < 3; ++c) image.values[c][i] = light(pixel[grey ? 0 : c]);
    if (alpha) image.values[3][i] = share(pixel[step - 1]);
  }
  return image;
}

struct FreeStb {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};
template <typename Sample>
using StbPixels = std::unique_ptr<Sample, FreeStb>;

// Feeds a file's bytes to stb, which invents the rows after the end of its input. This source sets ran_out there.
struct StbSource {
  const Bytes& bytes;
  std::size_t at = 0;
  bool ran_out = false;

  static int read(void* user, char* data, int size) {
    auto& source = *static_cast<StbSource*>(user);
    const std::size_t count = std::min(static_cast<std::size_t>(size), source.bytes.size() - source.at);
    std::memcpy(data, source.bytes.data() + source.at, count);
    source.at += count;
    if (count > 0) return static_cast<int>(count);
    source.ran_out = true;
    std::memset(data, 0, static_cast<std::size_t>(size));
    return size;
  }
  static void skip(void* user, int count) {
    auto& source = *static_cast<StbSource*>(user);
    const auto to = static_cast<std::int64_t>(source.at) + count,
               end = static_cast<std::int64_t>(source.bytes.size());
    source.ran_out |= to > end;
    source.at = static_cast<std::size_t>(std::clamp<std::int64_t>(to, 0, end));
  }
  static int has_ended(void* user) { return static_cast<StbSource*>(user)->ran_out; }

  // Returns nullptr if the image could be decoded.
  const char* problem(const void* pixels) const {
    if (ran_out) return "it ends too early";
    if (pixels != nullptr) return nullptr;
    const char* reason = stbi_failure_reason();
    return reason != nullptr ? reason : "its content makes no sense";
  }
};
constexpr stbi_io_callbacks kFromSource{StbSource::read, StbSource::skip, StbSource::has_ended};

// Returns the reason why stb may not decode a BMP, judging by its header. stb takes two bytes per number, and the
// image made of them a float.
std::optional<std::string> bmp_problem(const Bytes& bytes, double memory) {
  int width = 0, height = 0, components = 0;
  // Reading from memory, stb sees the end.
  if (!stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &components)) {
    const char* reason = stbi_failure_reason();
    return reason != nullptr ? reason : "its content makes no sense";
  }
  if (width < 1 || height < 1) return "it has no pixels";
  if (std::int64_t{width} * height > kMaxPixels) return "it is too large";
  const double pixels = static_cast<double>(width) * height, has = static_cast<double>(bytes.size());
  const double needed = has + pixels * std::max(3, components) * 6;
  if (needed > memory) return too_much_memory(needed, memory);
  // The header, whose length is its first number, holds the bits per pixel of an uncompressed file.
  const std::size_t at = bytes.size() > 14 && bytes[14] == 12 ? 24 : 28;
  const double bits = at + 1 < bytes.size() ? bytes[at] + 256.0 * bytes[at + 1] : 1;
  const double least = pixels * std::max(1.0, bits) / 8;
  if (least > has) return too_few_bytes(width, height, least, has);
  return std::nullopt;
}

// True if a file's first bytes are the signature of a format.
bool begins_as(ImageFormat format, const Bytes& bytes) {
  constexpr struct {
    ImageFormat format;
    std::string_view bytes;
  } kSignatures[] = {
      {ImageFormat::Png, "\x89PNG\r\n\x1a\n"},
      {ImageFormat::Jpeg, "\xff\xd8\xff"},
      {ImageFormat::Bmp, "BM"},
      {ImageFormat::Exr, "\x76\x2f\x31\x01"},
      {ImageFormat::Pfm, "PF"},
      {ImageFormat::Pfm, "Pf"},
      {ImageFormat::Hdr, "#?"},
  };
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return std::any_of(std::begin(kSignatures), std::end(kSignatures),
                     [&](const auto& row) { return row.format == format && text.starts_with(row.bytes); });
}

// True if the first bytes are the format's signature. For a format that is shown, any such signature will do.
bool has_signature(ImageFormat format, const Bytes& bytes) {
  constexpr std::array kDisplayFormats = {ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Bmp};
  const auto begins = [&](ImageFormat other) { return begins_as(other, bytes); };
  const bool display = std::find(kDisplayFormats.begin(), kDisplayFormats.end(), format) != kDisplayFormats.end();
  return display ? std::any_of(kDisplayFormats.begin(), kDisplayFormats.end(), begins) : begins(format);
}

// Makes an image of integer samples [y][x][component], taken for sRGB signals.
template <typename Sample>
FloatImage from_signals(const Sample* samples, int width, int height, int components) {
  constexpr std::size_t kMost = std::numeric_limits<Sample>::max();
  std::vector<float> light(kMost + 1);
  for (std::size_t i = 0; i <= kMost; ++i) {
    light[i] = static_cast<float>(compiler::srgb_decode(static_cast<double>(i) / static_cast<double>(kMost)));
  }
  return widened(
      samples, width, height, components, [&](Sample sample) { return light[sample]; },
      [](Sample sample) { return static_cast<float>(sample) / static_cast<float>(kMost); });
}

DecodeResult decode_deep(const Bytes& bytes, double memory) {
  const auto read = decode_png(bytes, memory);
  if (const auto* problem = std::get_if<std::string>(&read)) return *problem;
  const auto& picture = std::get<PngImage>(read);
  return from_signals(picture.samples.data(), picture.width, picture.height, picture.components);
}

DecodeResult decode_lossy(const Bytes& bytes, double memory) {
  const auto read = decode_jpeg(bytes, memory);
  if (const auto* problem = std::get_if<std::string>(&read)) return *problem;
  const auto& picture = std::get<JpegImage>(read);
  return from_signals(picture.samples.data(), picture.width, picture.height, picture.components);
}

DecodeResult decode_display(const Bytes& bytes, double memory) {
  // Decodes PNG and JPEG by their signature, whatever the name says. stb allocates the size that a PNG's chunk states
  // before it reads the chunk, and invents the missing end of a JPEG.
  if (begins_as(ImageFormat::Png, bytes)) return decode_deep(bytes, memory);
  if (begins_as(ImageFormat::Jpeg, bytes)) return decode_lossy(bytes, memory);
  if (auto problem = bmp_problem(bytes, memory)) return std::move(*problem);
  int width = 0, height = 0, components = 0;
  StbSource source{bytes};
  const StbPixels<stbi_uc> pixels(stbi_load_from_callbacks(&kFromSource, &source, &width, &height, &components, 0));
  if (const char* problem = source.problem(pixels.get())) return problem;
  return from_signals(pixels.get(), width, height, components);
}

// Returns the next word of a header, which ends with one white character; empty at the end.
std::string_view next_word(std::string_view text, std::size_t& at) {
  const auto white = [&](std::size_t i) {
    return text[i] == ' ' || text[i] == '\n' || text[i] == '\t' || text[i] == '\r';
  };
  while (at < text.size() && white(at)) ++at;
  const std::size_t begin = at;
  while (at < text.size() && !white(at)) ++at;
  const std::string_view word = text.substr(begin, at - begin);
  if (at < text.size()) ++at;
  return word;
}

template <typename T>
std::optional<T> to(std::string_view word) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

// Source: see write_float_map(). The size of the header's last number is a factor of all numbers, and its sign says
// which byte is first.
DecodeResult decode_pfm(const Bytes& bytes, double memory) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::size_t at = 0;
  const std::string_view kind = next_word(text, at);
  const auto width = to<int>(next_word(text, at)), height = to<int>(next_word(text, at));
  const auto scale = to<float>(next_word(text, at));
  const bool grey = kind == "Pf";
  if ((!grey && kind != "PF") || !width || !height || *width < 1 || *height < 1 || !scale || *scale == 0 ||
      !std::isfinite(*scale)) {
    return "it has no header of a portable float map";
  }
  const int components = grey ? 1 : 3;
  if (std::int64_t{*width} * *height > kMaxPixels) return "it is too large";
  const std::size_t count =
      static_cast<std::size_t>(*width) * static_cast<std::size_t>(*height) * static_cast<std::size_t>(components);
  if (text.size() - at < count * 4) return "it ends too early";
  // In addition to the file: its numbers, and R, G and B of every pixel.
  const double pixels = static_cast<double>(*width) * *height;
  const double needed = static_cast<double>(bytes.size()) + sizeof(float) * (static_cast<double>(count) + 3 * pixels);
  if (needed > memory) return too_much_memory(needed, memory);
  std::vector<float> values(count);
  const float unit = std::abs(*scale);
  const std::size_t row = values.size() / static_cast<std::size_t>(*height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::uint32_t bits = 0;
    for (std::size_t byte = 0; byte < 4; ++byte) {
      bits |= std::uint32_t{bytes[at + 4 * i + byte]} << (8 * (*scale < 0 ? byte : 3 - byte));
    }
    const std::size_t y = static_cast<std::size_t>(*height) - 1 - i / row;
    values[y * row + i % row] = std::bit_cast<float>(bits) * unit;
  }
  const auto same = [](float value) { return value; };
  return widened(values.data(), *width, *height, components, same, same);
}

// Returns an image as large as the display window: black where there are no data, and without data outside.
DecodeResult shown(FloatImage image, double memory) {
  const PixelRect window{0, 0, image.width, image.height}, area = image.area;
  if (area == window) return image;
  // A crop of a large picture is a small file, and a few bytes of a header must not take all memory.
  constexpr std::size_t kSmall = std::size_t{1} << 22, kMostTimes = 1024;
  if (window.pixels() > std::max(kSmall, kMostTimes * area.pixels())) {
    return fmt::format("its display window of {} by {} pixels is more than {} times its data window of {} by {}",
                       window.width(), window.height(), kMostTimes, area.width(), area.height());
  }
  const double count = static_cast<double>(image.channels.size());
  const double needed =
      sizeof(float) * (count * static_cast<double>(area.pixels()) + count * static_cast<double>(window.pixels()));
  if (needed > memory) return too_much_memory(needed, memory);
  const int left = std::max(0, area.x0), right = std::min(window.x1, area.x1);
  for (std::vector<float>& values : image.values) {
    std::vector<float> all(window.pixels());
    for (int y = std::max(0, area.y0); y < std::min(window.y1, area.y1) && left < right; ++y) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(area.index(left, y));
      std::copy(from, from + (right - left), all.begin() + static_cast<std::ptrdiff_t>(window.index(left, y)));
    }
    values = std::move(all);
  }
  image.area = window;
  return image;
}

DecodeResult decode_shown_exr(const Bytes& bytes, double memory) {
  DecodeResult read = decode_exr(bytes, memory);
  FloatImage* const image = std::get_if<FloatImage>(&read);
  return image == nullptr ? std::move(read) : shown(std::move(*image), memory - static_cast<double>(bytes.size()));
}

// Returns false on failure, with errno set. A file without the signature of its format is read no further than its
// first piece. A file longer than `most` bytes is cut off there, because a device may have no end.
bool read_bytes(const std::string& path, ImageFormat format, double most, Bytes& bytes) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) return false;
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  for (std::size_t count = kPiece; count == kPiece && static_cast<double>(bytes.size()) <= most;) {
    const std::size_t size = bytes.size();
    bytes.resize(size + kPiece);
    count = std::fread(bytes.data() + size, 1, kPiece, file.get());
    bytes.resize(size + count);
    if (size == 0 && !has_signature(format, bytes)) break;
  }
  return std::ferror(file.get()) == 0;
}

DecodeResult decode(ImageFormat format, const Bytes& bytes, double memory) {
  if (!has_signature(format, bytes)) return "it does not begin as such a file does";
  if (static_cast<double>(bytes.size()) > memory) return "it is longer than the memory that is allowed";
  switch (format) {
    case ImageFormat::Exr:
      return decode_shown_exr(bytes, memory);
    case ImageFormat::Pfm:
      return decode_pfm(bytes, memory);
    case ImageFormat::Hdr:
      return decode_hdr(bytes, memory);
    default:
      return decode_display(bytes, memory);
  }
}

}  // namespace

std::variant<FloatImage, ImageReadError> read_image(const std::string& path, const ReadLimits& limits) {
  const ImageFormatInfo* format = image_format_of(path);
  if (format == nullptr) {
    return ImageReadError{
        fmt::format("cannot tell the format of `{}`: its name must end in one of {}", path, image_endings())};
  }
  Bytes bytes;
  if (!read_bytes(path, format->format, limits.memory, bytes)) {
    return ImageReadError{fmt::format("cannot read `{}`: {}", path, std::strerror(errno)), true};
  }
  if (bytes.size() > std::numeric_limits<int>::max() && format->format != ImageFormat::Exr) {
    return ImageReadError{fmt::format("cannot read `{}`: it is too large", path)};
  }
  DecodeResult decoded = decode(format->format, bytes, limits.memory);
  if (auto* image = std::get_if<FloatImage>(&decoded)) return std::move(*image);
  return ImageReadError{fmt::format("`{}` is no {} picture that can be read: {}", path, format->ending,
                                    std::get<std::string>(decoded))};
}

}  // namespace fathom::runtime
