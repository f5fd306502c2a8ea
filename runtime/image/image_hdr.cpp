#include "runtime/image/image_hdr.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "runtime/image/color_space.h"

namespace fathom::runtime {
namespace {

using RgbePixel = std::array<std::uint8_t, 4>;  // mantissas and the exponent
using Bytes = std::vector<std::uint8_t>;

// Lengths of scan lines that have runs per component.
constexpr std::size_t kMinRunLine = 8, kMaxRunLine = 0x7fff;

struct HdrHeader {
  bool xyz = false;
  glm::dvec3 factor{1};  // by which the light was multiplied
  Chromaticities primaries;
  // Scan lines: their number and length. They are rows or, if `columns`, columns.
  std::size_t lines = 0, length = 0;
  bool columns = false;
  bool from_right = false, from_bottom = false;
};

// Returns as many numbers as the text consists of, or nullopt when it is anything else.
template <std::size_t Count>
std::optional<std::array<double, Count>> numbers_in(std::string_view text) {
  std::array<double, Count> numbers;
  for (double& number : numbers) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  if (text.find_first_not_of(" \t") != text.npos) return std::nullopt;
  return numbers;
}

class HdrReader {
 public:
  HdrReader(const Bytes& bytes, double memory) : bytes_(bytes), memory_(memory) {}

  std::variant<FloatImage, std::string> read() {
    if (!read_header() || !is_allowed()) return problem_;
    pixels_.reserve(header_.lines * header_.length);
    for (std::size_t line = 0; line < header_.lines; ++line) {
      if (!read_line()) return problem_.empty() ? "it ends too early" : problem_;
    }
    return to_image();
  }

 private:
  bool fail(std::string why) {
    problem_ = std::move(why);
    return false;
  }

  // Returns the next line without its end, which is a line feed, perhaps after a carriage return.
  std::optional<std::string_view> next_line() {
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    const std::size_t end = text.find('\n', at_);
    if (end == text.npos) return std::nullopt;
    std::string_view line = text.substr(at_, end - at_);
    at_ = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  bool read_header() {
    auto line = next_line();
    if (!line || !line->starts_with("#?")) return fail("it has no Radiance header");
    for (line = next_line(); line && !line->empty(); line = next_line()) {
      if (!read_variable(*line)) return false;
    }
    if (!line || !(line = next_line())) return fail("its header does not end");
    return read_resolution(*line);
  }

  // Reads NAME=VALUE. Other lines, as those of the commands that made the picture, say nothing about its light.
  bool read_variable(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == line.npos) return true;
    const std::string_view name = line.substr(0, equals), value = line.substr(equals + 1);
    if (name == "FORMAT") return read_format(value);
    if (name == "EXPOSURE") {
      const auto factor = numbers_in<1>(value);
      return take_factor(line, factor ? std::optional(glm::dvec3((*factor)[0])) : std::nullopt);
    }
    if (name == "COLORCORR") {
      const auto factor = numbers_in<3>(value);
      return take_factor(line,
                         factor ? std::optional(glm::dvec3((*factor)[0], (*factor)[1], (*factor)[2])) : std::nullopt);
    }
    if (name == "PRIMARIES") {
      const auto xy = numbers_in<8>(value);
      if (!xy) return fail(fmt::format("its line `{}` does not hold eight numbers", line));
      const auto& v = *xy;
      header_.primaries = {{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}, {v[6], v[7]}};
    }
    if (name == "GAMMA" && numbers_in<1>(value) != std::array{1.0}) {
      return fail(fmt::format("its line `{}` is not supported: its numbers are no light", line));
    }
    return true;
  }

  bool read_format(std::string_view value) {
    const std::size_t first = value.find_first_not_of(" \t"), last = value.find_last_not_of(" \t");
    const std::string_view format = first == value.npos ? "" : value.substr(first, last - first + 1);
    header_.xyz = format == "32-bit_rle_xyze";
    return header_.xyz || format == "32-bit_rle_rgbe" ||
           fail(fmt::format("its FORMAT `{}` is not supported; 32-bit_rle_rgbe and 32-bit_rle_xyze are", format));
  }

  bool take_factor(std::string_view line, const std::optional<glm::dvec3>& factor) {
    constexpr double kMost = 1e30;
    if (factor) header_.factor *= *factor;
    const glm::dvec3 all = header_.factor;
    return (factor && std::min({all.x, all.y, all.z}) > 1 / kMost && std::max({all.x, all.y, all.z}) < kMost) ||
           fail(fmt::format("its line `{}` holds no factors of light", line));
  }

  // Reads a resolution: "-Y 8 +X 16" has 8 rows from the top, each from the left.
  bool read_resolution(std::string_view line) {
    std::array<std::string_view, 4> words;
    std::string_view rest = line;
    for (std::string_view& word : words) {
      rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
      word = rest.substr(0, rest.find(' '));
      rest.remove_prefix(word.size());
    }
    const auto is_axis = [](std::string_view word, char axis) {
      return word.size() == 2 && (word[0] == '+' || word[0] == '-') && word[1] == axis;
    };
    const auto is_size = [](std::string_view word, std::size_t& size) {
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), size);
      return error == std::errc() && end == word.data() + word.size();
    };
    header_.columns = is_axis(words[0], 'X');
    const char first = header_.columns ? 'X' : 'Y', second = header_.columns ? 'Y' : 'X';
    if (!is_axis(words[0], first) || !is_axis(words[2], second) || !is_size(words[1], header_.lines) ||
        !is_size(words[3], header_.length) || rest.find_first_not_of(' ') != rest.npos) {
      return fail(fmt::format("its line of the size, `{}`, is not supported: there are eight as `-Y 8 +X 16`", line));
    }
    header_.from_bottom = words[header_.columns ? 2 : 0][0] == '+';
    header_.from_right = words[header_.columns ? 0 : 2][0] == '-';
    return true;
  }

  bool is_allowed() {
    const double lines = static_cast<double>(header_.lines), length = static_cast<double>(header_.length);
    if (header_.lines == 0 || header_.length == 0) return fail("it has no pixels");
    if (lines * length > static_cast<double>(kMaxPixels)) return fail("it is too large");
    const double needed =
        static_cast<double>(bytes_.size()) + lines * length * (sizeof(RgbePixel) + 3 * sizeof(float));
    if (needed > memory_) return fail(too_much_memory(needed, memory_));
    // A line has at least one pixel and, if it has more, one repetition.
    const double least = lines * (header_.length > 1 ? 8 : 4), has = static_cast<double>(bytes_.size() - at_);
    return least <= has || fail(too_few_bytes(static_cast<int>(header_.columns ? lines : length),
                                              static_cast<int>(header_.columns ? length : lines), least, has));
  }

  bool take(std::uint8_t& byte) {
    if (at_ >= bytes_.size()) return false;
    byte = bytes_[at_++];
    return true;
  }

  bool read_line() {
    const std::size_t length = header_.length;
    if (length < kMinRunLine || length > kMaxRunLine || bytes_.size() - at_ < 4) return read_pixels();
    const std::uint8_t* head = bytes_.data() + at_;
    if (head[0] != 2 || head[1] != 2 || head[2] > 127) return read_pixels();
    if (head[2] * std::size_t{256} + head[3] != length)
      return fail("a scan line has another length than the picture");
    at_ += 4;
    pixels_.resize(pixels_.size() + length);
    for (std::size_t component = 0; component < 4; ++component) {
      if (!read_component(component)) return false;
    }
    return true;
  }

  // Reads a component of the last line: runs of one byte, and bytes as they are.
  bool read_component(std::size_t component) {
    RgbePixel* const line = pixels_.data() + (pixels_.size() - header_.length);
    for (std::size_t done = 0; done < header_.length;) {
      std::uint8_t code = 0, value = 0;
      if (!take(code)) return false;
      const bool run = code > 128;
      const std::size_t count = run ? code - 128u : code;
      if (count == 0 || count > header_.length - done) return fail("a run is longer than its scan line");
      if (run && !take(value)) return false;
      for (const std::size_t end = done + count; done < end; ++done) {
        if (!run && !take(value)) return false;
        line[done][component] = value;
      }
    }
    return true;
  }

  // Reads whole pixels. The oldest encoding writes a pixel of 1, 1, 1, n for n repetitions of the pixel before. Each
  // such pixel after another has further 8 bits of one number.
  bool read_pixels() {
    std::size_t left = header_.length;
    for (int shift = 0; left > 0;) {
      RgbePixel pixel;
      for (std::uint8_t& byte : pixel) {
        if (!take(byte)) return false;
      }
      if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
        pixels_.push_back(pixel);
        --left, shift = 0;
        continue;
      }
      const std::uint64_t count = shift < 32 ? std::uint64_t{pixel[3]} << shift : left + 1;
      if (left == header_.length) return fail("a scan line begins with a run, and there is nothing to repeat");
      if (count > left) return fail("a run is longer than its scan line");
      pixels_.insert(pixels_.end(), count, RgbePixel(pixels_.back()));
      left -= count, shift += 8;
    }
    return true;
  }

  std::variant<FloatImage, std::string> to_image() const {
    const int lines = static_cast<int>(header_.lines), length = static_cast<int>(header_.length);
    FloatImage image;
    image.width = header_.columns ? lines : length;
    image.height = header_.columns ? length : lines;
    image.area = {0, 0, image.width, image.height};
    image.channels = {{"R"}, {"G"}, {"B"}};
    image.values.assign(3, std::vector<float>(image.area.pixels()));
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const int line = static_cast<int>(i / header_.length), place = static_cast<int>(i % header_.length);
      const int x = header_.columns ? line : place, y = header_.columns ? place : line;
      const std::size_t at = image.area.index(header_.from_right ? image.width - 1 - x : x,
                                              header_.from_bottom ? image.height - 1 - y : y);
      const RgbePixel& pixel = pixels_[i];
      // An exponent of 0 is black, whatever the mantissas.
      const double unit = pixel[3] == 0 ? 0 : std::ldexp(1.0, pixel[3] - 136);
      for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        image.values[channel][at] = static_cast<float>(pixel[channel] * unit / header_.factor[c]);
      }
    }
    const Chromaticities& primaries = header_.xyz ? kCieXyz : header_.primaries;
    const auto matrix = to_srgb(primaries);
    if (!matrix) return fmt::format("its PRIMARIES make no sense: {}", to_text(primaries));
    convert_colors(*matrix, image.values[0], image.values[1], image.values[2]);
    return image;
  }

  const Bytes& bytes_;
  const double memory_;
  std::size_t at_ = 0;
  HdrHeader header_;
  std::vector<RgbePixel> pixels_;  // in the file's order
  std::string problem_;
};

}  // namespace

std::variant<FloatImage, std::string> decode_hdr(const Bytes& bytes, double memory) {
  return HdrReader(bytes, memory).read();
}

}  // namespace fathom::runtime
