// fathom merge: adds films of parts of a render up to the film or the images of the whole. Film sums are integers, so
// the result is independent of the order of the parts and of the way in which the work was split.
// Tested by: tests/runtime/cli/cli_merge_test.cpp
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ostream>

#include "runtime/cli/input/memory.h"
#include "runtime/cli/input/scene_arguments.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/plan/plan_merge.h"
#include "runtime/cli/verbs.h"
#include "runtime/denoise/denoise.h"

namespace fathom::cli {
namespace {

constexpr const char* kMergeExamples =
    "fathom render scene.fathom -s 64 --sample-range 0:32 -o a.film  # here\n"
    "fathom render scene.fathom -s 64 --sample-range 32:64 -o b.film # there\n"
    "fathom merge a.film b.film -o out.exr -o out.png\n"
    "fathom merge left.film right.film -o whole.film   # to be merged again";

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, MergeRequest& request) {
  Arguments arguments("merge", "Adds up the films of parts of a render.", kMergeExamples);
  arguments.positionals("film", "Films to add up, each of another part", request.inputs, "FILE", false);
  arguments.option(
      "-o,--output", "FILE",
      "File to write: .film, or a picture as `fathom render` writes it; - is standard output; may be repeated",
      append_to(read_output, request.pictures.outputs));
  add_format_option(arguments, false, request.format);
  arguments.option("--exposure", "STOPS", "Brightness of the picture in stops: 1 doubles it (that of the films)",
                   into(read_exposure, request.exposure));
  arguments.option("--tone", "CURVE", "Tone curve: none, filmic, aces, agx or neutral (that of the films)",
                   one_of({compiler::kToneCurves.begin(), compiler::kToneCurves.end()}, request.tone));
  arguments.option("--bits", "N", "Bits per channel in png: 8 or 16 (8)", one_of({"8", "16"}, request.bits));
  arguments.flag("--denoise", "Denoise the pictures; the noisy ones go to FILE-noisy", request.denoise);
  arguments.flag("-q,--quiet", "Print only errors, warnings and notes", request.quiet);
  add_limit_option(arguments, request.limits);
  arguments.group("Plans (docs/how-to/farm.md)");
  arguments.option("--plan", "FILE", "Add up the units of a plan; #### in -o is a frame's number",
                   any_text(request.plan));
  add_frames_option(arguments, "Frames A to B-1 of the plan, every S-th; 7 is one frame (all)", request.frames);
  if (const auto code = arguments.parse(args, streams)) return code;
  if (request.inputs.empty() != request.plan.has_value()) {
    return fail(streams, kUsage,
                request.plan ? "--plan has all films: it goes with no other" : "the films are missing",
                {"`fathom merge --help` lists the options"});
  }
  if (request.frames.given() && !request.plan) return fail(streams, kUsage, "--frames goes with --plan");
  request.pictures.deep = request.bits != 0;
  request.pictures.noisy = request.denoise;
  if (request.pictures.outputs.empty()) return fail(streams, kUsage, "no file to write", {"name it with -o FILE"});
  if (const auto code = apply_format(request.pictures.outputs, request.format, streams)) return code;
  if (const auto code = check_bits(request.pictures, streams)) return code;
  for (const std::string& input : request.inputs) streams.files.add_input(input);
  if (const auto code = claim_outputs(files_of(request.pictures), streams)) return code;
  return check_paths(request.pictures, streams);
}

// A film file of the command line: its path and header, without the sums.
struct Part {
  std::string path;
  runtime::FilmFile file;
};

ExitCode fail_to_read(const runtime::FilmReadError& read_error, const Streams& streams) {
  return fail(streams, read_error.missing ? kIo : kBadScene, read_error.problem);
}

std::variant<std::vector<Part>, ExitCode> read_parts(const MergeRequest& request, const Streams& streams) {
  std::vector<Part> parts;
  for (const std::string& path : request.inputs) {
    auto read = runtime::read_film_header(path, read_limits(request.limits));
    if (const auto* read_error = std::get_if<runtime::FilmReadError>(&read))
      return fail_to_read(*read_error, streams);
    parts.push_back({path, std::get<runtime::FilmFile>(std::move(read))});
  }
  // The parts are sorted because the sum takes some facts from the first part. The order of the command line must not
  // matter.
  const auto place = [](const Part& part) {
    const runtime::PixelRect area = part.file.shape.area;
    return std::array<std::int64_t, 3>{area.y0, area.x0, part.file.header.samples.first};
  };
  std::stable_sort(parts.begin(), parts.end(), [&](const Part& a, const Part& b) { return place(a) < place(b); });
  return parts;
}

std::string text_of(const runtime::SampleBlock& block) {
  return fmt::format("samples {}:{} of the pixels {},{},{},{}", block.samples.first, block.samples.last,
                     block.area.x0, block.area.y0, block.area.x1, block.area.y1);
}

// Checks that the parts belong to one render and do not overlap. Otherwise prints a message and returns an exit code.
std::optional<ExitCode> check_parts(const std::vector<Part>& parts, const Streams& streams) {
  const Part& first = parts.front();
  for (const Part& part : parts) {
    auto problems = runtime::differences(first.file.header.identity, part.file.header.identity,
                                         fmt::format("in `{}`", first.path), fmt::format("in `{}`", part.path));
    if (!problems.empty()) {
      problems.push_back("leave one out, or render it again with the scene and settings of the other");
      return fail(streams, kBadScene, fmt::format("`{}` and `{}` are of different renders", first.path, part.path),
                  problems);
    }
    const bool alike = first.file.shape.layers == part.file.shape.layers &&
                       first.file.header.width == part.file.header.width &&
                       first.file.header.height == part.file.header.height;
    if (!alike || (parts.size() > 1 && part.file.render.adaptive.used())) {
      return fail(
          streams, kBadScene,
          fmt::format("`{}` cannot be merged: {}", part.path,
                      alike ? "its pixels' samples depend on the whole picture" : "its layers or size differ"),
          {alike ? "merge it alone, or render the parts with --uniform"
                 : "leave it out, or render it again as the others"});
    }
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto both = parts[j].file.render.covered.front().overlap(parts[i].file.render.covered.front());
      if (!both) continue;
      return fail(
          streams, kBadScene, fmt::format("`{}` and `{}` both have {}", parts[j].path, parts[i].path, text_of(*both)),
          {"counted twice they would weigh too much: leave one out, or render another --sample-range or --crop"});
    }
  }
  return std::nullopt;
}

// Returns the header of the sum: the bounding rectangle and the sample range of all parts.
runtime::FilmFile frame_of(const std::vector<Part>& parts) {
  runtime::FilmFile sum = parts.front().file;
  runtime::PixelRect& area = sum.shape.area;
  runtime::SampleRange& samples = sum.header.samples;
  for (const Part& part : parts) {
    const runtime::PixelRect& other = part.file.shape.area;
    area = {std::min(area.x0, other.x0), std::min(area.y0, other.y0), std::max(area.x1, other.x1),
            std::max(area.y1, other.y1)};
    samples.first = std::min(samples.first, part.file.header.samples.first);
    samples.last = std::max(samples.last, part.file.header.samples.last);
  }
  return sum;
}

// Checks the memory for the whole sum plus the largest part, which are in memory at the same time.
std::optional<ExitCode> check_memory(const MergeRequest& request, const std::vector<Part>& parts,
                                     const runtime::FilmShape& sum, const Streams& streams) {
  const auto film = static_cast<double>(runtime::Film::memory_per_pixel(sum.layers, sum.stages));
  const double each = film + kImageBytes + (request.denoise ? kDenoiserBytes : 0) +
                      (holds_whole(request.pictures.outputs) ? film : 0);
  double needed = each * static_cast<double>(sum.area.pixels()), part = 0;
  for (const Part& other : parts) part = std::max(part, film * static_cast<double>(other.file.shape.area.pixels()));
  if (parts.size() > 1) needed += part;
  const double allowed = allowed_memory(request.limits);
  if (needed <= allowed) return std::nullopt;
  return fail(
      streams, kBadScene,
      fmt::format("the sum would take {} of memory ({}x{} pixels of {:.0f} bytes, and a part); {} are allowed",
                  format_bytes(needed), sum.area.width(), sum.area.height(), each, format_bytes(allowed)),
      {"merge films that lie closer together, for what lies between them counts, too",
       compiler::raise(&compiler::Limits::memory, needed)});
}

// Reads the part again, now with its sums.
std::variant<runtime::FilmFile, ExitCode> read_sums(const Part& part, const compiler::Limits& limits,
                                                    const Streams& streams) {
  auto read = runtime::read_film(part.path, read_limits(limits));
  if (const auto* read_error = std::get_if<runtime::FilmReadError>(&read)) return fail_to_read(*read_error, streams);
  auto& file = std::get<runtime::FilmFile>(read);
  if (file.shape == part.file.shape && file.render.covered == part.file.render.covered &&
      file.header.identity == part.file.header.identity) {
    return std::move(file);
  }
  return fail(streams, kIo, fmt::format("`{}` changed while it was read", part.path),
              {"merge once nobody writes to it any more"});
}

// Adds the parts to `sum`, which is frame_of(parts). The caller has checked that the headers match.
std::optional<ExitCode> add_up(const std::vector<Part>& parts, const compiler::Limits& limits, runtime::FilmFile& sum,
                               const Streams& streams) {
  if (parts.size() > 1)
    sum.render = {runtime::Film(sum.shape.area, sum.shape.layers), std::vector<runtime::Coverage>(1), {}};
  for (const Part& part : parts) {
    auto read = read_sums(part, limits, streams);
    if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
    auto& file = std::get<runtime::FilmFile>(read);
    if (parts.size() == 1) {
      sum.render = std::move(file.render);
      return std::nullopt;
    }
    if (!sum.render.film.merge(file.render.film))
      warn(streams, overflow_text(fmt::format("samples of `{}`", part.path)));
    sum.render.covered.front().add(file.render.covered.front());
  }
  sum.render.covered.front().canonicalise();
  return std::nullopt;
}

}  // namespace

int run_merge(std::span<const std::string> args, const Streams& streams) {
  MergeRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  if (request.plan) return merge_plan(request, streams);
  auto read = read_parts(request, streams);
  if (const auto* code = std::get_if<ExitCode>(&read)) return *code;
  const auto& parts = std::get<std::vector<Part>>(read);
  if (const auto code = check_parts(parts, streams)) return *code;
  runtime::FilmFile sum = frame_of(parts);
  const runtime::FilmLayers kept = sum.shape.layers;
  if (request.denoise && (!kept.first_hit || !kept.halves)) {
    return fail(streams, kBadScene, "--denoise: the films lack what it takes", {"render them with --denoise, too"});
  }
  if (const auto code = check_memory(request, parts, sum.shape, streams)) return *code;
  if (const auto code = add_up(parts, request.limits, sum, streams)) return *code;
  const runtime::SampleBlock all{sum.shape.area, sum.header.samples};
  const auto missing = sum.render.covered.front().missing(all);
  if (!sum.render.adaptive.used() && !missing.empty() && !request.quiet) {
    note(streams, "the films are not all of it: there are no " + text_of(missing.front()) +
                      (missing.size() > 1 ? ", among others" : ""));
  }
  override_tone(request, sum.header.attributes);
  if (request.denoise) runtime::denoise(sum.render.film, 1);
  std::vector<std::string> lines;
  const auto problem = write_image_files(request.pictures, sum.header, sum.render, std::nullopt, lines, streams);
  for (const std::string& line : lines) {
    if (!request.quiet) streams.err << line << '\n';
  }
  return problem ? fail(streams, kIo, *problem) : kDone;
}

}  // namespace fathom::cli
