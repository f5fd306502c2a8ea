#include "runtime/cli/request/render_memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/cli/input/memory.h"
#include "runtime/film/film.h"
#include "runtime/path/options.h"

namespace fathom::cli {
namespace {

// Returns the bytes per pixel of the film, of denoising and of the image that is written. A file with all layers is
// written row by row, except to standard output, before which it is held whole.
double bytes_per_pixel(const runtime::Settings& settings, const RenderRequest& request) {
  const auto film =
      static_cast<double>(runtime::Film::memory_per_pixel(settings.layers, runtime::stages_of(settings)));
  // SIGUSR1 denoises a copy of the film while the render continues.
  return film + kImageBytes + (request.denoise ? film + kDenoiserBytes : 0) +
         (holds_whole(request.outputs) ? film : 0);
}

}  // namespace

std::optional<ExitCode> check_memory(const RenderRequest& request, const compiler::CompiledScene& scene,
                                     const Streams& streams) {
  const runtime::Settings settings = runtime::resolve(scene, request.options);
  const double allowed = allowed_memory(request.scene.limits);
  const double pixels = static_cast<double>(settings.crop.pixels()), each = bytes_per_pixel(settings, request);
  const double needed = pixels * each;
  if (needed <= allowed) return std::nullopt;
  const bool given = request.size || request.resolution || request.crop;
  return fail_about(
      request.scene, given ? kUsage : kBadScene,
      fmt::format("{}the render would take {} of memory ({:.0f} pixels of {:.0f} bytes); {} are allowed",
                  given ? "" : scene.source.name() + ": ", format_bytes(needed), pixels, each, format_bytes(allowed)),
      {"ask for a smaller picture, or a part of it with --crop", compiler::raise(&compiler::Limits::memory, needed)},
      streams);
}

void fit_regions(RenderRequest& request, const compiler::CompiledScene& scene) {
  const runtime::Settings settings = runtime::resolve(scene, request.options);
  const double left = allowed_memory(request.scene.limits) -
                      static_cast<double>(settings.crop.pixels()) * bytes_per_pixel(settings, request);
  const auto most = static_cast<double>(request.options.region_memory);
  // Half of the rest, because building regions takes more memory than the regions. Whole MiB, because the render's
  // identity states MiB.
  request.options.region_memory = static_cast<std::size_t>(std::clamp(left / 2, 0.0, most)) >> 20 << 20;
}

}  // namespace fathom::cli
