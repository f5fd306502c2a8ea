// fathom eval: evaluates the field at points and prints one line per point, each number with the fewest digits that
// read back to the same value.
//
//     $ fathom eval ball.json --at 0,2,0
//     1.5 0 1 0 ball
//
// Tested by: tests/runtime/cli/cli_test.cpp
#include <fmt/format.h>

#include <ostream>

#include "compiler/geometry/outward.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/verbs.h"
#include "vm/encoding/printable.h"
#include "vm/interpret/evaluate.h"

namespace fathom::cli {
namespace {

constexpr const char* kEvalExamples =
    "fathom eval scene.fathom --at 0,1,0 --at -1,0.5,2\n"
    "fathom eval scene.fathom --points points.txt --number f32 # lines of x y z\n"
    "fathom eval scene.fathom --box -1,-1,-1,1,1,1             # bounds in a box\n"
    "fathom eval scene.fathom --at 0,1,0 --after graph         # without passes";

enum Number { kF32, kF64, kRange };

struct EvalRequest {
  SceneArguments scene;
  std::vector<glm::dvec3> points;
  std::optional<std::string> points_file;
  std::vector<PointBox> boxes;
  int number = -1;  // a Number; -1: not given
  int stage = -1;   // 0: --stage graph; -1: not given
  std::optional<std::string> after;
};

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, EvalRequest& request) {
  Arguments arguments(
      "eval", "Prints the field at points, a line each: the distance, the gradient's x y z, the object's name.",
      kEvalExamples);
  add_scene_arguments(arguments, request.scene);
  arguments.option("--at", "X,Y,Z", "Point in scene units; may be repeated", append_to(read_point, request.points));
  arguments.option("--points", "FILE", "File of points, with x y z on each line; - is standard input",
                   any_text(request.points_file));
  arguments.option("--number", "TYPE",
                   "Number type: f64 (default), f32, or range, which prints a lower and an upper bound",
                   one_of({"f32", "f64", "range"}, request.number));
  arguments.option("--box", "X0,...,Z1", "Box to bound the distance in, from x0,y0,z0 to x1,y1,z1; may be repeated",
                   append_to(read_box, request.boxes));
  arguments.option("--after", "PASS", "Stop after this pass of the compiler; graph stops before the first",
                   pass_name(request.after));
  arguments.option("--stage", "STAGE", "graph: the same as --after graph", one_of({"graph"}, request.stage));
  if (const auto code = arguments.parse(args, streams)) return code;

  if (request.stage == 0) request.after = "graph";
  if (request.number < 0) request.number = request.boxes.empty() ? kF64 : kRange;
  if (!request.boxes.empty() && request.number != kRange) {
    return fail(streams, kUsage, "--box needs --number range");
  }
  if (request.points.empty() && request.boxes.empty() && !request.points_file) {
    return fail(streams, kUsage, "no point to evaluate at", {"give --at X,Y,Z, --points FILE or --box"});
  }
  if (request.points_file == "-" && request.scene.path == "-") {
    return fail(streams, kUsage, "the scene and the points cannot both come from standard input");
  }
  return std::nullopt;
}

// Appends the file's points to `points`. Returns an exit code after a message if the file cannot be read.
std::optional<ExitCode> read_points(const std::string& path, const compiler::Limits& limits, const Streams& streams,
                                    std::vector<glm::dvec3>& points) {
  const auto read = read_text(path, limits, streams);
  if (const auto* read_error = std::get_if<ReadError>(&read)) return fail(streams, path, *read_error);
  std::string_view rest = std::get<std::string>(read);
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    const auto coordinates = to_numbers(line, 3, true);
    if (!coordinates) {
      return fail(streams, kBadScene, fmt::format("{}:{}: `{}` is not a point", source_name(path), number, line),
                  {"a line is three numbers: x y z"});
    }
    points.push_back({(*coordinates)[0], (*coordinates)[1], (*coordinates)[2]});
  }
  return std::nullopt;
}

std::string surface_name(const compiler::CompiledScene& scene, std::uint32_t surface) {
  if (surface >= scene.surfaces.size() || scene.surfaces[surface].name.empty()) return "-";
  return vm::escape_controls(scene.surfaces[surface].name);
}

void print_f64(const compiler::CompiledScene& scene, const std::vector<glm::dvec3>& points, std::ostream& out) {
  vm::Workspace workspace;
  for (const glm::dvec3& point : points) {
    const vm::SurfaceValue value = vm::evaluate_surface(scene.surface, point - scene.origin, workspace);
    out << fmt::format("{} {} {} {} {}\n", value.distance, value.gradient.x, value.gradient.y, value.gradient.z,
                       surface_name(scene, value.surface));
  }
}

void print_f32(const compiler::CompiledScene& scene, const std::vector<glm::dvec3>& points, std::ostream& out) {
  const std::size_t count = points.size();
  std::vector<float> x(count), y(count), z(count), distance(count), gx(count), gy(count), gz(count);
  std::vector<std::uint32_t> surface(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 point(points[i] - scene.origin);
    x[i] = point.x;
    y[i] = point.y;
    z[i] = point.z;
  }
  vm::Workspace workspace;
  vm::evaluate_surface(scene.surface, {x.data(), y.data(), z.data()}, count,
                       {distance.data(), gx.data(), gy.data(), gz.data(), surface.data()}, workspace);
  for (std::size_t i = 0; i < count; ++i) {
    out << fmt::format("{} {} {} {} {}\n", distance[i], gx[i], gy[i], gz[i], surface_name(scene, surface[i]));
  }
}

void print_ranges(const compiler::CompiledScene& scene, const std::vector<PointBox>& boxes, std::ostream& out) {
  vm::Workspace workspace;
  for (const PointBox& box : boxes) {
    const auto [lo, hi] = compiler::moved_outward({box.lo, box.hi}, -scene.origin);
    const vm::Range range = vm::evaluate_range(scene.distance, lo, hi, workspace);
    out << fmt::format("{} {}\n", range.lo, range.hi);
  }
}

}  // namespace

int run_eval(std::span<const std::string> args, const Streams& streams) {
  EvalRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  if (request.points_file) {
    if (const auto code = read_points(*request.points_file, request.scene.limits, streams, request.points))
      return *code;
  }
  compiler::CompileOptions options;
  options.stop_after = request.after;
  const auto compiled = compile_scene(std::get<SceneInput>(std::move(source)), request.scene, streams, options);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  const auto& scene = std::get<compiler::CompiledScene>(compiled);

  if (request.number == kF64) print_f64(scene, request.points, streams.out);
  if (request.number == kF32) print_f32(scene, request.points, streams.out);
  if (request.number == kRange) {
    std::vector<PointBox> boxes;
    for (const glm::dvec3& point : request.points) boxes.push_back({point, point});
    boxes.insert(boxes.end(), request.boxes.begin(), request.boxes.end());
    print_ranges(scene, boxes, streams.out);
  }
  return kDone;
}

}  // namespace fathom::cli
