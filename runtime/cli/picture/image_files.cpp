#include "runtime/cli/picture/image_files.h"

#include <fmt/format.h>

#include "runtime/cli/picture/image_attributes.h"
#include "runtime/film/film_channels.h"
#include "runtime/film/film_layers.h"
#include "runtime/image/image_exr.h"

namespace fathom::cli {
namespace {

// One layer of an output and its file. Standard output holds only the image itself.
struct LayerFile {
  runtime::Layer layer;
  Output output;
};
std::vector<LayerFile> layer_files(const ImageFiles& pictures, const Output& output) {
  std::vector<LayerFile> files = {{runtime::Layer::Beauty, output}};
  if (output.layers() || output.standard()) return files;
  const auto add = [&](bool wanted, runtime::Layer layer) {
    if (!wanted) return;
    files.push_back({layer, {with_suffix(output.path, std::string(runtime::info(layer).name)), output.format}});
  };
  add(pictures.albedo, runtime::Layer::Albedo);
  add(pictures.depth, runtime::Layer::Depth);
  add(pictures.normal, runtime::Layer::Normal);
  add(pictures.noisy, runtime::Layer::Noisy);
  return files;
}

std::optional<std::string> write_output(const ImageFiles& pictures, const Output& output,
                                        const runtime::FilmHeader& header, const runtime::PartialRender& render,
                                        std::optional<double> seconds, std::vector<std::string>& lines,
                                        const Streams& streams) {
  const runtime::Film& film = render.film;
  const int width = film.width(), height = film.height();
  if (output.film()) {
    const Fill fill = [&](runtime::AtomicFile& file) {
      runtime::write_film(header, render, file);
      return file.commit();
    };
    if (auto problem = write_to(output, fill, streams)) return problem;
    lines.push_back(wrote(output, width, height) + ": sums, to be merged");
    return std::nullopt;
  }
  if (output.layers()) {
    runtime::Attributes attributes = header.attributes;
    describe_samples(render, attributes);
    if (seconds) attributes["renderTimeSeconds"] = static_cast<float>(*seconds);
    const auto rows = runtime::rows_of(film, header.width, header.height, header.origin, std::move(attributes));
    const Fill fill = [&](runtime::AtomicFile& file) { return runtime::write_exr(rows, file); };
    if (auto problem = write_to(output, fill, streams)) return problem;
    lines.push_back(wrote(output, width, height) + fmt::format(": {} channels", rows.channels.size()));
    return std::nullopt;
  }
  const runtime::ImageOptions options{tone_in(header.attributes), pictures.deep ? 16 : 8};
  for (const LayerFile& each : layer_files(pictures, output)) {
    const Fill fill = [&](runtime::AtomicFile& file) {
      return runtime::write_layer(runtime::layer_of(film, each.layer), options, output.format->format, file);
    };
    if (auto problem = write_to(each.output, fill, streams)) return problem;
    lines.push_back(wrote(each.output, width, height));
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> files_of(const ImageFiles& pictures) {
  std::vector<std::string> files;
  for (const Output& output : pictures.outputs) {
    if (output.standard()) continue;
    for (const LayerFile& file : layer_files(pictures, output)) files.push_back(file.output.path);
  }
  return files;
}

std::optional<ExitCode> check_paths(const ImageFiles& pictures, const Streams& streams) {
  for (const std::string& path : files_of(pictures)) {
    if (const auto problem = runtime::check_file_path(path)) return fail(streams, kIo, *problem);
  }
  return std::nullopt;
}

// Among the displayable formats only some have 16 bits.
std::optional<ExitCode> check_bits(const ImageFiles& pictures, const Streams& streams) {
  if (!pictures.deep) return std::nullopt;
  for (const Output& output : pictures.outputs) {
    if (output.film() || !output.format->for_display || output.format->deep) continue;
    return fail(streams, kUsage,
                fmt::format("--bits 16: `{}` can have only 8 bits per channel",
                            output.standard() ? output.format->ending : output.path),
                {"16 bits go into png; exr, pfm and hdr hold the numbers themselves"});
  }
  return std::nullopt;
}

std::string overflow_text(std::string_view what) {
  return fmt::format(
      "{} lost: a pixel's sums of light, depths and places end at {:.2g}; scale the lights down where it is light, "
      "else the scene",
      what, runtime::kMaxPixelSum);
}

std::optional<std::string> write_image_files(const ImageFiles& pictures, const runtime::FilmHeader& header,
                                             const runtime::PartialRender& render, std::optional<double> seconds,
                                             std::vector<std::string>& lines, const Streams& streams) {
  for (const Output& output : pictures.outputs) {
    if (auto problem = write_output(pictures, output, header, render, seconds, lines, streams)) return problem;
  }
  return std::nullopt;
}

}  // namespace fathom::cli
