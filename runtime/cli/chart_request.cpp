#include "runtime/cli/chart_request.h"

#include <fmt/format.h>

#include "runtime/cli/options/arguments.h"

namespace fathom::cli {
namespace {

constexpr const char* kChartExamples =
    "fathom chart -o charts                     # the project's scenes\n"
    "fathom chart scene.fathom -o charts        # charts/index.html shows it\n"
    "fathom chart scene.fathom -o charts --no-images --rays 2000 --rounds 3";

}  // namespace

std::variant<ChartRequest, int> parse_chart(std::span<const std::string> args, const Streams& streams) {
  ChartRequest request;
  std::optional<std::string> folder;
  std::optional<int> rays, rounds, spp, seeds, reference_spp;
  std::optional<PixelSize> size;
  std::optional<std::uint64_t> seed;
  Arguments arguments("chart",
                      "Charts speed against accuracy: every way to follow rays, compared with a search in double, on "
                      "rays of the scene\n"
                      "and on its picture. Needs no display. The page it writes needs no network.",
                      kChartExamples);
  add_scene_arguments(arguments, request.scene, false);
  arguments.flag("-q,--quiet", "Print only errors, warnings and notes", request.quiet);
  arguments.option("-o,--output", "FOLDER", "Folder for index.html, *.csv, *.svg and *.png (chart)",
                   any_text(folder));
  arguments.group("Rays");
  arguments.option("--rays", "N", "Number of rays of each class: camera, bounce and grazing (10000)",
                   whole(rays, 100, 10'000'000));
  arguments.option("--rounds", "N", "Number of timings of each method, of which the median counts (9)",
                   whole(rounds, 1, 1001));
  arguments.option("--seed", "N", "Seed of the rays (1)", into(read_seed, seed));
  arguments.group("Pictures");
  arguments.flag("--no-images", "Chart no pictures", request.no_images);
  arguments.option("--size", "WxH", "Width and height of the compared pictures (64x36)", into(read_size, size));
  arguments.option("-s,--spp", "N", "Max samples per pixel (64)", whole(spp, 2, 1 << 14));
  arguments.option("--seeds", "N", "Number of pictures per point of the chart (16)", whole(seeds, 1, 4096));
  arguments.option("--reference-spp", "N", "Samples per pixel of the reference (1024)",
                   whole(reference_spp, 2, 1 << 20));
  if (const auto code = arguments.parse(args, streams)) return *code;

  request.folder = folder.value_or("chart");
  if (request.folder == "-") {
    return fail(streams, kUsage, "--output: charts cannot go to standard output: they are a folder of files");
  }
  if (request.folder.empty()) return fail(streams, kUsage, "--output: the folder needs a name");
  request.rays = rays.value_or(request.rays);
  request.rounds = rounds.value_or(request.rounds);
  request.seed = seed.value_or(request.seed);
  request.images.spp = spp.value_or(request.images.spp);
  request.images.seeds = seeds.value_or(request.images.seeds);
  request.images.reference_spp = reference_spp.value_or(request.images.reference_spp);
  if (size) request.images.width = size->width, request.images.height = size->height;
  request.command = "fathom chart";
  for (const std::string& word : args) request.command += " " + word;
  return request;
}

}  // namespace fathom::cli
