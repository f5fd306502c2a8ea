// Fuzz target for image files. The first byte selects the file name's extension, and all other bytes are the file. An
// image that is read has as many values as its size says. An environment map has finite, non-negative values.
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
