// Fuzz target for image files. The first byte selects the file name's extension, and all other bytes are the file. An
// image that is read has as many values as its size says. An environment map has finite, non-negative values.
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include <cmath>

#include "runtime/film/film_channels.h"
#include "runtime/film/film_layers.h"
#include "runtime/image/image_exr.h"
#include "runtime/image/image_io.h"
#include "runtime/light/environment_file.h"
#include "tests/fuzz/target.h"

namespace fathom::fuzz {
namespace {

constexpr runtime::ReadLimits kPictureLimits{256e6};
constexpr std::size_t kEndings = runtime::kImageFormats.size();

std::string name_with(std::string_view ending) { return fmt::format("picture.{}", ending); }

void check_environment(const std::string& path) {
  const auto read = runtime::read_environment(path, kPictureLimits);
  const auto* light = std::get_if<runtime::EnvironmentImage>(&read);
  if (light == nullptr) return;
  promise(light->pixels.size() == static_cast<std::size_t>(light->width) * static_cast<std::size_t>(light->height),
          "a background has as many pixels as its size says");
  for (const glm::vec3& pixel : light->pixels) {
    for (int i = 0; i < 3; ++i) promise(std::isfinite(pixel[i]) && pixel[i] >= 0, "light is finite and not negative");
  }
}

}  // namespace

void run_picture(Bytes input) {
  if (input.empty()) return;
  const std::string_view ending = runtime::kImageFormats[input[0] % kEndings].ending;
  const ScratchFile file(name_with(ending));
  write_file(file.path, input.subspan(1));
  const auto read = runtime::read_image(file.path, kPictureLimits);
  if (const auto* image = std::get_if<runtime::FloatImage>(&read)) {
    promise(image->values.size() == image->channels.size(), "every channel has values");
    for (const auto& channel : image->values) {
      promise(channel.size() == image->area.pixels(), "a channel has as many values as there are pixels");
    }
  } else {
    promise(!std::get<runtime::ImageReadError>(read).problem.empty(), "there is a reason");
  }
  if (ending == "hdr" || ending == "exr") check_environment(file.path);
}

namespace {

Input seed_of(std::string_view ending, const Input& file) {
  Input seed = file;
  for (std::size_t i = 0; i < kEndings; ++i) {
    if (runtime::kImageFormats[i].ending == ending) seed.insert(seed.begin(), static_cast<std::uint8_t>(i));
  }
  return seed;
}

// An OpenEXR file of luminance and chroma, or of colours, in other primaries and with windows that differ.
Input exr_of(Imf::RgbaChannels channels) {
  const ScratchFile file(name_with("exr"));
  Imf::Header header(Imath::Box2i({-1, 0}, {7, 5}), Imath::Box2i({0, 2}, {5, 7}));
  header.compression() = channels == Imf::WRITE_RGB ? Imf::NO_COMPRESSION : Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities({0.7f, 0.3f}, {0.2f, 0.7f}, {0.1f, 0.1f}, {0.3f, 0.3f}));
  const std::vector<Imf::Rgba> pixels(48,  // two rows more: the data begin in row 2
                                      Imf::Rgba(1, 0.5f, 2, 1));
  {
    Imf::RgbaOutputFile picture(file.path.c_str(), header, channels);
    picture.setFrameBuffer(pixels.data(), 1, 6);
    picture.writePixels(6);
  }
  return read_file(file.path);
}

// Radiance pictures of all encodings, with lines that change the light.
std::vector<Input> kinds_of_hdr() {
  const std::string head = "#?RADIANCE\nEXPOSURE=2\nCOLORCORR=1 2 3\nPRIMARIES=.6 .3 .3 .6 .1 .1 .3 .3\n",
                    pixel = "\x40\x80\x60\x81", repeat = "\1\1\1\7";
  return {to_input(head + "\n+X 2 -Y 2\n" + pixel + pixel + pixel + pixel),
          to_input(head + "FORMAT=32-bit_rle_xyze\r\n\r\n+Y 1 -X 8\r\n" + pixel + repeat),
          to_input(head + "\n-Y 1 +X 8\n" + std::string("\2\2\0\x08", 4) + "\x88\1\x88\2\x88\3\x88\x81")};
}

}  // namespace

std::vector<Input> seeds_of_picture() {
  runtime::Film film(5, 3);
  for (int i = 0; i < 15; ++i) {
    runtime::PathSample sample;
    sample.radiance = glm::vec3(static_cast<float>(i) / 7, 0.5f, 2.f / static_cast<float>(i + 1));
    film.add(i % 5, i / 5, sample);
  }
  const runtime::LayerValues layer = runtime::layer_of(film, runtime::Layer::Beauty);
  std::vector<Input> seeds;
  for (const Input& file : kinds_of_hdr()) seeds.push_back(seed_of("hdr", file));
  for (const Imf::RgbaChannels channels : {Imf::WRITE_RGB, Imf::WRITE_YC, Imf::WRITE_Y}) {
    seeds.push_back(seed_of("exr", exr_of(channels)));
  }
  for (std::size_t i = 0; i < kEndings; ++i) {
    for (const int bits : {8, 16}) {
      const runtime::ImageFormatInfo& format = runtime::kImageFormats[i];
      if (bits == 16 && !format.deep) continue;
      const ScratchFile file(name_with(format.ending));
      const bool exr = format.format == runtime::ImageFormat::Exr;
      const auto problem = exr ? runtime::write_exr(runtime::rows_of(film, 5, 3, glm::dvec3(0), {}), file.path)
                               : runtime::write_layer(layer, {{}, bits}, file.path);
      promise(!problem, "a seed is written");
      Input seed = read_file(file.path);
      seed.insert(seed.begin(), static_cast<std::uint8_t>(i));
      seeds.push_back(std::move(seed));
    }
  }
  return seeds;
}

}  // namespace fathom::fuzz
