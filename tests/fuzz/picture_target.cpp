// Pictures from elsewhere: the first byte says which ending the file's name has, the others are the file. A picture
// that is read has as many numbers as its size says; as a background of light they are finite and not negative.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "runtime/environment_file.h"
#include "runtime/film_channels.h"
#include "runtime/image_exr.h"
#include "runtime/image_io.h"
#include "tests/fuzz/target.h"

namespace fathom::fuzz {
namespace {

constexpr runtime::ReadLimits kLimits{256e6};
constexpr std::size_t kEndings = runtime::kImageFormats.size();

// A file of this process alone.
std::string file_with(Bytes content, std::string_view ending) {
  const auto folder = std::filesystem::temp_directory_path();
  const std::string path = (folder / fmt::format("fathom-fuzz-{}.{}", getpid(), ending)).string();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
  return path;
}

void check_environment(const std::string& path) {
  const auto read = runtime::read_environment(path, kLimits);
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
  const std::string path = file_with(input.subspan(1), ending);
  const auto read = runtime::read_image(path, kLimits);
  if (const auto* image = std::get_if<runtime::FloatImage>(&read)) {
    promise(image->values.size() == image->channels.size(), "every channel has values");
    for (const auto& channel : image->values) {
      promise(channel.size() == image->area.pixels(), "a channel has as many values as there are pixels");
    }
  } else {
    promise(!std::get<runtime::UnreadImage>(read).problem.empty(), "there is a reason");
  }
  if (ending == "hdr" || ending == "exr") check_environment(path);
  std::filesystem::remove(path);
}

std::vector<Input> seeds_of_picture() {
  runtime::Film film(5, 3);
  for (int i = 0; i < 15; ++i) {
    runtime::PathSample sample;
    sample.radiance = glm::vec3(static_cast<float>(i) / 7, 0.5f, 2.f / static_cast<float>(i + 1));
    film.add(i % 5, i / 5, sample);
  }
  const runtime::LayerValues layer = runtime::layer_of(film, runtime::Layer::Beauty);
  std::vector<Input> seeds;
  for (std::size_t i = 0; i < kEndings; ++i) {
    for (const int bits : {8, 16}) {
      const runtime::ImageFormatInfo& format = runtime::kImageFormats[i];
      if (bits == 16 && !format.deep) continue;
      const std::string path = file_with({}, format.ending);
      const bool exr = format.format == runtime::ImageFormat::Exr;
      const auto problem = exr ? runtime::write_exr(runtime::rows_of(film, 5, 3, glm::dvec3(0), {}), path)
                               : runtime::write_layer(layer, {{}, bits}, path);
      if (problem) continue;
      Input seed = read_file(path);
      std::filesystem::remove(path);
      seed.insert(seed.begin(), static_cast<std::uint8_t>(i));
      seeds.push_back(std::move(seed));
    }
  }
  return seeds;
}

}  // namespace fathom::fuzz
