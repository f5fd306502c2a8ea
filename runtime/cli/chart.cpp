// fathom chart: measures all ray-marching methods on a scene and draws charts, maps and a page.
//
//     $ fathom chart scene.fathom -o charts
//     scene: the default is on the Pareto front of time: camera yes, bounce yes, grazing yes
//     wrote charts/index.html
//
// Tested by: tests/runtime/cli/cli_chart_test.cpp
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <ostream>

#include "runtime/chart/chart_a.h"
#include "runtime/chart/chart_b.h"
#include "runtime/chart/colormap.h"
#include "runtime/chart/csv.h"
#include "runtime/chart/page.h"
#include "runtime/cli/chart_request.h"
#include "runtime/cli/chart_scenes.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/options/step_line.h"
#include "runtime/cli/options/version.h"
#include "runtime/cli/verbs.h"
#include "runtime/field/pieces.h"
#include "runtime/image/image_io.h"
#include "runtime/measure/maps.h"
#include "runtime/measure/measure_rays.h"
#include "vm/interpret/evaluate.h"

namespace fathom::cli {
namespace {

constexpr int kMapSide = 320;  // pixels of the longer side; the scene's film gives the aspect ratio

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
    if (begin != std::string::npos) return line.substr(begin);
  }
  return "unknown processor";
}

runtime::Provenance provenance_of(const ChartRequest& request) {
  runtime::Provenance provenance;
  provenance.commit = fmt::format("fathom {} {}", kVersion, kCommit.empty() ? "(no commit)" : kCommit);
  provenance.cpu = processor();
  provenance.compiler = kCompiler;
  provenance.isa = vm::isa_name();
  provenance.date = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)));
  provenance.command = request.command;
  provenance.rounds = request.rounds;
  return provenance;
}

// Collects and writes the measurements, charts and maps. Remembers the first write error.
class Charts {
 public:
  Charts(const ChartRequest& request, const Streams& streams)
      : request_(request), streams_(streams), provenance_(provenance_of(request)) {
    page_.provenance = provenance_;
  }

  // Measures and draws one scene. Does nothing after a write error.
  void add(const compiler::CompiledScene& scene, const std::string& name) {
    if (problem_) return;
    runtime::Field field = runtime::make_field(scene, scene.settings.far);
    runtime::add_pieces(field, scene, runtime::extent_of(scene), scene.settings.far, false);
    runtime::PageScene section{name, {}, {}};
    add_rays(scene, field, section);
    if (!request_.no_images) add_pictures(scene, section);
    add_maps(scene, field, section);
    page_.scenes.push_back(section);
  }

  std::optional<std::string> finish() {
    page_.rays = rays_;
    write("chart.csv", runtime::rays_csv(rays_, provenance_));
    page_.files.push_back("chart.csv");
    if (!request_.no_images) {
      write("images.csv", runtime::images_csv(images_, provenance_));
      page_.files.push_back("images.csv");
    }
    write("index.html", runtime::page_html(page_));
    return problem_;
  }

 private:
  void say(const std::string& text) const {
    if (!request_.quiet) streams_.err << text << std::flush;
  }
  std::string path_of(const std::string& name) const {
    return (std::filesystem::path(request_.folder) / name).string();
  }
  void write(const std::string& name, const std::string& text) {
    if (!problem_) problem_ = runtime::write_file({text.begin(), text.end()}, path_of(name));
  }

  void add_chart(runtime::PageScene& section, const std::string& suffix, const std::string& svg,
                 const char* reading) {
    write(fmt::format("{}-{}.svg", section.name, suffix), svg);
    section.charts.push_back({svg, reading});
  }

  void add_rays(const compiler::CompiledScene& scene, const runtime::Field& field, runtime::PageScene& section) {
    say(fmt::format("{}: {} rays of each class by {} methods\n", section.name, request_.rays,
                    runtime::charted_methods().size()));
    const std::size_t count = static_cast<std::size_t>(request_.rays);
    const std::vector<runtime::RaySet> sets = runtime::make_ray_sets(scene, field, count, request_.seed);
    StepLine line(streams_, section.name + ": rays");
    const auto rows =
        runtime::measure_rays(scene, field, sets, runtime::charted_methods(), request_.rounds, section.name);
    line.end();
    rays_.insert(rays_.end(), rows.begin(), rows.end());
    using runtime::Cost;
    add_chart(section, "time", runtime::chart_a(rows, section.name, Cost::Time, provenance_),
              runtime::kReadChartATime);
    add_chart(section, "evaluations", runtime::chart_a(rows, section.name, Cost::Evaluations, provenance_),
              runtime::kReadChartAEvaluations);
    report_front(rows, section.name, Cost::Time, "time");
    report_front(rows, section.name, Cost::Evaluations, "evaluations");
  }

  // Prints for each ray class whether the default is on the Pareto front, and which rows dominate the default.
  void report_front(const std::vector<runtime::RayMeasurement>& rows, const std::string& name, runtime::Cost cost,
                    const char* word) const {
    std::string line = fmt::format("{}: the default is on the Pareto front of {}:", name, word), why;
    for (const runtime::FrontVerdict& verdict : runtime::judge_default(rows, name, cost)) {
      const bool hits = std::any_of(rows.begin(), rows.end(), [&](const runtime::RayMeasurement& row) {
        return row.ray_class == verdict.ray_class && runtime::is_default(row) && !std::isnan(row.terr_p99);
      });
      line += fmt::format(" {} {}", verdict.ray_class, verdict.on_front ? "yes" : hits ? "no" : "(no ray hits)");
      for (const runtime::RayMeasurement& other : verdict.dominated_by) {
        why += fmt::format("  {}: {} eps {:g} is better in all\n", verdict.ray_class, runtime::name_of(other, rows),
                           other.eps);
      }
    }
    print(streams_, line + '\n' + why);
  }

  void add_pictures(const compiler::CompiledScene& scene, runtime::PageScene& section) {
    const runtime::ImagePlan& plan = request_.images;
    say(fmt::format("{}: pictures of {}x{}, {} seeds\n", section.name, plan.width, plan.height, plan.seeds));
    const std::vector<runtime::ImageVariant> variants = runtime::image_variants(scene);
    StepLine line(streams_, section.name + ": pictures");
    const auto rows = runtime::measure_images(scene, variants, plan, section.name);
    line.end();
    images_.insert(images_.end(), rows.begin(), rows.end());
    add_chart(section, "pictures", runtime::chart_b(rows, section.name, provenance_), runtime::kReadChartB);
    const bool has_lights = std::any_of(variants.begin(), variants.end(), [](const runtime::ImageVariant& way) {
      return way.light_sampling != runtime::LightSampling::Mis;
    });
    if (!has_lights) return;
    add_chart(section, "light", runtime::chart_light(rows, section.name, provenance_), runtime::kReadChartLight);
  }

  void add_map(runtime::PageScene& section, const std::vector<float>& values, int width, int height,
               const std::string& suffix, const char* title, const char* reading) {
    const std::string name = fmt::format("{}-{}.png", section.name, suffix);
    const runtime::ByteImage picture = runtime::draw_map(values, width, height, runtime::scale_for(values, true));
    if (!problem_) problem_ = runtime::write_image(picture, path_of(name));
    section.maps.push_back({name, title, reading});
  }

  void add_maps(const compiler::CompiledScene& scene, const runtime::Field& field, runtime::PageScene& section) {
    const int longer = std::max(scene.film.width, scene.film.height);
    const int width = std::max(1, kMapSide * scene.film.width / longer);
    const int height = std::max(1, kMapSide * scene.film.height / longer);
    const runtime::PixelMaps maps = runtime::measure_maps(scene, field, width, height);
    add_map(section, maps.evaluations, maps.width, maps.height, "map-evaluations", "Evaluations",
            "How often the field is evaluated for each pixel's camera ray.");
    add_map(section, maps.in_double, maps.width, maps.height, "map-double", "Decided in double",
            "Evaluations in double of the rays that float could not decide; black where it could.");
    add_map(section, maps.depth_error, maps.width, maps.height, "map-depth-error", "Depth error",
            "How far the hit is from the reference, in units of float's last place; grey where both miss.");
  }

  const ChartRequest& request_;
  const Streams& streams_;
  runtime::Provenance provenance_;
  runtime::Page page_;
  std::vector<runtime::RayMeasurement> rays_;
  std::vector<runtime::ImageMeasurement> images_;
  std::optional<std::string> problem_;
};

std::variant<std::vector<SceneInput>, ExitCode> read_scenes(const ChartRequest& request, const Streams& streams) {
  std::vector<SceneInput> sources;
  if (request.scene.path.empty()) {
    for (const compiler::EmbeddedFile& scene : chart_scenes()) {
      sources.push_back({compiler::Source(std::string(scene.name), std::string(scene.text)), std::nullopt});
    }
    return sources;
  }
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  sources.push_back(std::get<SceneInput>(std::move(source)));
  return sources;
}

// Returns the stem of the output files' names: the scene file's name without its ending, or `scene` for standard
// input.
std::string name_of(const compiler::Source& source, const ChartRequest& request) {
  const std::string stem = std::filesystem::path(source.name()).stem().string();
  return request.scene.path == "-" || stem.empty() ? "scene" : stem;
}

struct NamedScene {
  std::string name;
  compiler::CompiledScene scene;
};

std::variant<std::vector<NamedScene>, ExitCode> compile_scenes(const ChartRequest& request, const Streams& streams) {
  auto sources = read_scenes(request, streams);
  if (const auto* code = std::get_if<ExitCode>(&sources)) return *code;
  std::vector<NamedScene> scenes;
  for (SceneInput& source : std::get<std::vector<SceneInput>>(sources)) {
    const std::string name = name_of(source.source, request);
    compiler::CompileOptions options;
    options.pieces = true;
    auto compiled = compile_scene(std::move(source), request.scene, streams, options);
    if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
    scenes.push_back({name, std::get<compiler::CompiledScene>(std::move(compiled))});
  }
  return scenes;
}

}  // namespace

int run_chart(std::span<const std::string> args, const Streams& streams) {
  auto parsed = parse_chart(args, streams);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const ChartRequest& request = std::get<ChartRequest>(parsed);
  const auto scenes = compile_scenes(request, streams);
  if (const auto* code = std::get_if<ExitCode>(&scenes)) return *code;
  const std::filesystem::path folder = request.folder;
  std::vector<std::string> texts;
  for (const char* name : {"index.html", "chart.csv", "images.csv"}) texts.push_back((folder / name).string());
  if (const auto code = check_output_files(texts, streams)) return *code;

  Charts charts(request, streams);
  for (const auto& [name, scene] : std::get<std::vector<NamedScene>>(scenes)) charts.add(scene, name);
  if (const auto problem = charts.finish()) return fail(streams, kIo, *problem);
  if (!request.quiet) streams.err << fmt::format("wrote {}/index.html\n", request.folder);
  return kDone;
}

}  // namespace fathom::cli
