// fathom plan: cuts a render into units for many machines, and reports the progress of the units.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <ostream>

#include "runtime/cli/frames/scene_frames.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/picture/render_identity.h"
#include "runtime/cli/plan/plan_pilot.h"
#include "runtime/cli/plan/plan_status.h"
#include "runtime/cli/request/render_options.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kPlanExamples =
    "fathom plan scene.fathom -s 4096 -o still.json\n"
    "fathom plan hop.fathom --frames 0:1000 --tiles 2x2 --sample-block 64 -o hop.json\n"
    "fathom render --plan hop.json --unit 7        # any machine, any order\n"
    "fathom plan --status hop.json                 # what is missing\n"
    "fathom merge --plan hop.json -o hop.####.png";

struct PlanRequest {
  RenderRequest render;
  std::optional<std::string> output;
  std::optional<PixelSize> tiles;   // --tiles, columns and rows
  std::optional<int> block;         // --sample-block, samples per pixel
  std::optional<double> unit_time;  // --unit-time, seconds
  std::optional<int> workers, per_task;
  bool no_pilot = false, status = false, sums = false, json = false;
  std::vector<std::string> arguments;  // arguments that the plan records
  std::vector<std::string> running;    // arguments for the pilot only
};

// Options that do not change the rendered images, and limits, which a worker may raise.
constexpr std::array<std::string_view, 14> kOwn = {
    "--limit",    "--output",   "--frames", "--tiles", "--sample-block", "--unit-time", "--workers",
    "--no-pilot", "--per-task", "--status", "--quiet", "--threads",      "--root",      "--error-format",
};

void add_options(Arguments& arguments, PlanRequest& request) {
  arguments.option("-o,--output", "FILE", "Plan to write, .json; its units go to the folder FILE.units beside it",
                   any_text(request.output));
  arguments.option("--tiles", "CxR", "Cut frames into C columns and R rows (by --unit-time)",
                   into(read_size, request.tiles));
  arguments.option("--sample-block", "N", "Samples per pixel in a unit (by --unit-time)",
                   whole(request.block, 1, compiler::kMaxSpp));
  arguments.option("--unit-time", "TIME",
                   "Time that a unit is to take on this machine, as 90s or 5m (2m; with --workers 1m to 5m)",
                   into(read_duration, request.unit_time));
  arguments.option("--workers", "N", "Cut for so many machines like this one, and say how long they take",
                   whole(request.workers, 1, 1'000'000));
  arguments.flag("--no-pilot", "Render no small picture to learn what a unit costs", request.no_pilot);
  arguments.option("--threads", "N", "Number of threads of the pilot (one per processor)",
                   whole(request.render.options.threads, 1, 4096));
  arguments.group("Status");
  arguments.flag("--status", "Say which units of a plan are done, and which are to be rendered", request.status);
  arguments.option("--per-task", "N", "List tasks of N units in place of units", whole(request.per_task, 1));
  arguments.flag("--sums", "Read the films whole, not their heads alone", request.sums);
  arguments.flag("--json", "Print the status as JSON", request.json);
}

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, PlanRequest& request) {
  Arguments arguments("plan", "Cuts a render into units for many machines; see docs/how-to/farm.md.", kPlanExamples);
  add_scene_arguments(arguments, request.render.scene);
  add_options(arguments, request);
  arguments.group("Picture");
  add_image_options(arguments, request.render);
  if (const auto code = arguments.parse(args, streams)) return *code;
  for (const Arguments::ParsedOption& option : arguments.parsed_options()) {
    const bool own = std::ranges::find(kOwn, option.name) != kOwn.end();
    const bool runs = option.name == "--threads" || option.name == "--limit" || option.name == "--error-format";
    if (own && !runs) continue;
    std::ranges::copy(option.arguments(), std::back_inserter(runs ? request.running : request.arguments));
  }
  if (request.status) return std::nullopt;
  if (request.per_task || request.sums || request.json) {
    return fail(streams, kUsage, "--per-task, --sums and --json go with --status");
  }
  if (!request.output) return fail(streams, kUsage, "no file to write", {"name it with -o plan.json"});
  if (request.output == "-") {
    return fail(streams, kUsage, "a plan cannot go to standard output: its units lie in a folder beside it",
                {"name a file with -o plan.json"});
  }
  if (const auto code = check_text_output(request.output, streams)) return *code;
  if (const auto code = resolve_options(request.render, streams)) return *code;
  return std::nullopt;
}

// Stores the scene's text with all imports in the plan, and the values of its parameters in the plan's arguments.
std::optional<ExitCode> take_scene(PlanRequest& request, RenderPlan& plan, const Streams& streams) {
  SceneArguments& arguments = request.render.scene;
  const std::size_t given = arguments.definitions.size();
  auto text = read_scene_text(arguments, streams);
  if (const auto* code = std::get_if<ExitCode>(&text)) return *code;
  SceneInput input{std::get<SceneText>(std::move(text)).source, std::nullopt};
  // Definitions from a compiled file precede those of the command line, which override them.
  for (std::size_t i = 0; i + given < arguments.definitions.size(); ++i) {
    const auto& [name, value] = arguments.definitions[i];
    plan.arguments.push_back(fmt::format("--define={}={}", name, value));
  }
  plan.arguments.insert(plan.arguments.end(), request.arguments.begin(), request.arguments.end());
  if (request.render.frames.given()) {
    const auto sequence = sequence_of(request.render.frames, input, arguments, streams);
    if (const auto* code = std::get_if<ExitCode>(&sequence)) return *code;
    plan.grid.frames = std::get<Sequence>(sequence).frames;
  } else {
    const auto animation = read_animation(input, arguments, streams);
    if (const auto* code = std::get_if<ExitCode>(&animation)) return *code;
  }
  plan.source = std::move(input.source);
  return std::nullopt;
}

// Takes from the first frame the settings that all frames share.
std::optional<ExitCode> take_settings(const PreparedRender& picture, RenderPlan& plan, const Streams& streams) {
  const runtime::RenderOptions& options = picture.request.options;
  const runtime::Settings settings = runtime::resolve(picture.scene, options);
  if (settings.noise_threshold) {
    return fail(streams, kUsage, "a noise threshold does not go with a plan: a pixel's samples depend on all others",
                {"add --uniform"});
  }
  plan.grid.width = settings.width, plan.grid.height = settings.height;
  plan.grid.spp = plan.grid.block = static_cast<std::uint32_t>(settings.spp);
  plan.identity = render_identity(picture.scene, settings, options);
  const compiler::Background& background = picture.scene.background;
  if (background.type != compiler::Background::Type::Image) return std::nullopt;
  auto bytes = read_text(background.image.file, picture.request.scene.limits, streams);
  if (const auto* read_error = std::get_if<ReadError>(&bytes))
    return fail(streams, background.image.file, *read_error);
  plan.background_name = background.image.file;
  plan.background = std::get<std::string>(std::move(bytes));
  return std::nullopt;
}

std::optional<ExitCode> put_grid(const PlanRequest& request, const Pilot& pilot, PlanGrid& grid,
                                 const Streams& streams) {
  if (request.tiles) grid.columns = request.tiles->width, grid.rows = request.tiles->height;
  if (!request.no_pilot) {
    const double frame = pilot.frame_seconds(grid), all = frame * static_cast<double>(grid.frame_count());
    cut(grid, request.tiles.has_value(), frame,
        request.unit_time.value_or(default_unit_seconds(all, request.workers)));
  }
  if (request.block) grid.block = std::min(static_cast<std::uint32_t>(*request.block), grid.spp);
  if (grid.columns > grid.width || grid.rows > grid.height) {
    return fail(streams, kUsage,
                fmt::format("--tiles: {}x{} are more than the {}x{} pixels of a frame", grid.columns, grid.rows,
                            grid.width, grid.height));
  }
  if (!too_many_units(grid)) return std::nullopt;
  return fail(streams, kUsage, fmt::format("a plan has {:.0f} units at most", kMaxUnits),
              {"cut fewer tiles or larger blocks of samples, or let --unit-time say how many"});
}

std::string in_time(double seconds) {
  if (seconds < 1) return fmt::format("{:.2f} s", seconds);
  if (seconds < 100) return fmt::format("{:.1f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

void describe(const PlanRequest& request, const RenderPlan& plan, const Pilot& pilot, const Streams& streams) {
  const PlanGrid& grid = plan.grid;
  say(streams, fmt::format("wrote {}: {} of {}x{} pixels and {}, in {}x{} tiles and {} of {}: {}", *request.output,
                           grid.frames ? count_of(grid.frame_count(), "frame") : "a still", grid.width, grid.height,
                           count_of(grid.spp, "sample"), grid.columns, grid.rows, count_of(grid.blocks(), "block"),
                           grid.block, count_of(grid.units(), "unit")));
  if (request.no_pilot) return;
  const Pilot::UnitCost unit = pilot.unit_cost(grid);
  const double all = unit.mean * static_cast<double>(grid.units());
  say(streams, fmt::format("a unit takes {} on this machine, {} at most, beside {} to start (by {} in {})",
                           in_time(unit.mean), in_time(unit.longest), in_time(pilot.start_seconds()),
                           count_of(pilot.frames(), "small picture"), in_time(pilot.seconds())));
  say(streams, fmt::format("all of them take {}", in_time(all)));
  if (!request.workers) return;
  // Bounds of list scheduling, in which an idle machine takes the next unit. Source: R. L. Graham, Bounds on
  // Multiprocessing Timing Anomalies, 1969.
  const double n = *request.workers;
  const double least = std::max(all / n, unit.longest), most = all / n + unit.longest * (n - 1) / n;
  say(streams, fmt::format("{} like it: {} to {}", count_of(static_cast<std::size_t>(*request.workers), "machine"),
                           in_time(least), in_time(most)));
}

}  // namespace

int run_plan(std::span<const std::string> args, const Streams& streams) {
  PlanRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  const SceneArguments& scene = request.render.scene;
  if (request.status) {
    const auto per_task = static_cast<std::uint64_t>(request.per_task.value_or(1));
    return print_status({scene.path, per_task, request.sums, request.json}, scene.limits, streams);
  }
  RenderPlan plan;
  if (const auto code = take_scene(request, plan, streams)) return *code;
  PlanFrames pictures(plan, streams);
  if (const auto code = pictures.open(request.running, "")) return *code;
  const auto first = pictures.at(0);
  if (const auto* code = std::get_if<ExitCode>(&first)) return *code;
  if (const auto code = take_settings(*std::get<PreparedRender*>(first), plan, streams)) return *code;
  Pilot pilot;
  if (!request.no_pilot) {
    if (const auto code = pilot.run(pictures, plan.grid, streams)) return *code;
  }
  if (const auto code = put_grid(request, pilot, plan.grid, streams)) return *code;
  const auto text = write_plan(plan);
  if (const auto* read_error = std::get_if<ReadError>(&text)) {
    return fail(streams, read_error->code, read_error->reason, {read_error->help});
  }
  if (const auto problem = write_text(std::get<std::string>(text), *request.output))
    return fail(streams, kIo, *problem);
  describe(request, plan, pilot, streams);
  return kDone;
}

}  // namespace fathom::cli
