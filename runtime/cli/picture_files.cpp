#include "runtime/cli/picture_files.h"

#include <fmt/format.h>

#include "runtime/cli/output_file.h"
#include "runtime/cli/picture_attributes.h"
#include "runtime/film_channels.h"
#include "runtime/image_exr.h"
#include "runtime/image_io.h"

namespace fathom::cli {
namespace {

// The layers that an output is of, and the file of each.
struct LayerFile {
  runtime::Layer layer;
  std::string path;
};
std::vector<LayerFile> layer_files(const PictureFiles& pictures, const std::string& output) {
  std::vector<LayerFile> files = {{runtime::Layer::Beauty, output}};
  if (holds_layers(output)) return files;
  const auto add = [&](bool wanted, runtime::Layer layer) {
    if (wanted) files.push_back({layer, beside(output, std::string(runtime::info(layer).name))});
  };
  add(pictures.albedo, runtime::Layer::Albedo);
  add(pictures.depth, runtime::Layer::Depth);
  add(pictures.normal, runtime::Layer::Normal);
  add(pictures.noisy, runtime::Layer::Noisy);
  return files;
}

std::string written(const std::string& path, const runtime::Film& film) {
  return fmt::format("wrote {} ({}x{})", path, film.width(), film.height());
}

std::optional<std::string> write_output(const PictureFiles& pictures, const std::string& path,
                                        const runtime::FilmHeader& header, const runtime::PartialRender& render,
                                        std::optional<double> seconds, std::vector<std::string>& lines) {
  const runtime::Film& film = render.film;
  if (is_film(path)) {
    if (auto problem = runtime::write_film(header, render, path)) return problem;
    lines.push_back(written(path, film) + ": sums, to be merged");
    return std::nullopt;
  }
  if (holds_layers(path)) {
    runtime::Attributes attributes = header.attributes;
    describe_samples(render, attributes);
    if (seconds) attributes["renderTimeSeconds"] = static_cast<float>(*seconds);
    const auto rows = runtime::rows_of(film, header.width, header.height, header.origin, std::move(attributes));
    if (auto problem = runtime::write_exr(rows, path)) return problem;
    lines.push_back(written(path, film) + fmt::format(": {} channels", rows.channels.size()));
    return std::nullopt;
  }
  const runtime::PictureOptions options{tone_in(header.attributes), pictures.deep ? 16 : 8};
  for (const LayerFile& file : layer_files(pictures, path)) {
    if (auto problem = runtime::write_layer(runtime::layer_of(film, file.layer), options, file.path)) return problem;
    lines.push_back(written(file.path, film));
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> files_of(const PictureFiles& pictures) {
  std::vector<std::string> files;
  for (const std::string& path : pictures.outputs) {
    for (const LayerFile& file : layer_files(pictures, path)) files.push_back(file.path);
  }
  return files;
}

std::optional<ExitCode> check_paths(const PictureFiles& pictures, const Streams& streams) {
  for (const std::string& path : files_of(pictures)) {
    if (const auto problem = runtime::check_file_path(path)) return fail(streams, kIo, *problem);
  }
  return std::nullopt;
}

// Of the formats that are shown only some have 16 bits.
std::optional<ExitCode> check_bits(const PictureFiles& pictures, const Streams& streams) {
  if (!pictures.deep) return std::nullopt;
  for (const std::string& path : pictures.outputs) {
    const runtime::ImageFormatInfo* format = runtime::image_format_of(path);
    if (!format || !format->shown || format->deep) continue;
    return fail(streams, kUsage, fmt::format("--bits 16: `{}` can have 8 bits a sample only", path),
                {"16 bits go into .png; .exr, .pfm and .hdr hold the numbers themselves"});
  }
  return std::nullopt;
}

std::string lost_text(std::string_view what) {
  return fmt::format(
      "{} lost: what a pixel's samples add up to, light, depths or places, ends at {:.2g}; where it is light, scale "
      "the lights down, else the scene",
      what, runtime::kFullPixel);
}

std::optional<std::string> write_pictures(const PictureFiles& pictures, const runtime::FilmHeader& header,
                                          const runtime::PartialRender& render, std::optional<double> seconds,
                                          std::vector<std::string>& lines) {
  for (const std::string& path : pictures.outputs) {
    if (auto problem = write_output(pictures, path, header, render, seconds, lines)) return problem;
  }
  return std::nullopt;
}

}  // namespace fathom::cli
