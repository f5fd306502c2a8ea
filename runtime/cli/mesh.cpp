// fathom mesh: writes the scene as a closed triangle mesh, each point of which is proved to lie near the surface.
//
//     $ fathom mesh part.fathom -o part.3mf --tolerance 0.05 --unit mm
//     wrote part.3mf: 2348 triangles, 1176 vertices, 1 body, 0 hollows, 40 x 25 x 10 mm
//     0 crossings, 0 folds, 0 islands
//     every point of the mesh is within 0.0375 of the surface (proved); parts of the surface thinner than 0.02884 may
//     be further from the mesh
//
// Tested by: tests/runtime/cli/cli_mesh_test.cpp
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <glm/common.hpp>

#include "runtime/base/atomic_file.h"
#include "runtime/base/machine.h"
#include "runtime/cli/input/memory.h"
#include "runtime/cli/input/scene_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/options/step_line.h"
#include "runtime/cli/verbs.h"
#include "runtime/mesh/files/mesh_file.h"
#include "runtime/mesh/make_mesh.h"
#include "runtime/mesh/mesh_box.h"
#include "runtime/mesh/mesh_measures.h"
#include "vm/encoding/escape.h"

namespace fathom::cli {
namespace {

constexpr const char* kMeshExamples =
    "fathom mesh part.fathom -o part.3mf --unit mm                # for a printer\n"
    "fathom mesh part.fathom -o part.glb --tolerance 0.002\n"
    "fathom mesh scene.fathom -o scene.ply --box -2,0,-2,2,3,2    # a part of a scene without end\n"
    "\n"
    "The tolerance is the max distance of the mesh from the surface. Parts of the scene that are thinner than the\n"
    "tolerance may be lost, and are then named.";

struct MeshRequest {
  SceneArguments scene;
  std::string output;
  const runtime::MeshFormatInfo* format = nullptr;
  std::optional<double> tolerance;
  std::optional<int> resolution;
  std::optional<PointBox> box;
  int unit = -1;  // index into kLengthUnits; -1: not given
  int up = 0;     // 0: y, 1: z
  bool plain = false;
  std::optional<int> threads;
};

std::string mesh_endings() {
  std::string endings;
  for (const auto& format : runtime::kMeshFormats)
    endings += fmt::format("{}.{}", endings.empty() ? "" : ", ", format.ending);
  return endings;
}

OptionResult read_mesh_output(std::string_view text, MeshRequest& request) {
  request.output = text;
  request.format = runtime::mesh_format_of(text);
  if (request.format) return std::nullopt;
  return OptionError{fmt::format("`{}` does not end in a mesh format's name", text),
                     "valid endings: " + mesh_endings()};
}

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, MeshRequest& request) {
  std::vector<std::string_view> units;
  for (const auto& unit : runtime::kLengthUnits) units.push_back(unit.name);
  Arguments arguments("mesh", "Writes the scene as a closed triangle mesh.", kMeshExamples);
  add_scene_arguments(arguments, request.scene);
  arguments.option("-o,--output", "FILE", "Mesh to write: " + mesh_endings(),
                   [&](std::string_view text) { return read_mesh_output(text, request); });
  arguments.option("--tolerance", "D",
                   "Max distance of the mesh from the surface, in scene units (as --resolution 256)",
                   into(read_positive, request.tolerance));
  arguments.option("--resolution", "N", "Cells along the longest side, instead of --tolerance",
                   whole(request.resolution, runtime::kMinResolution, runtime::kMaxResolution));
  arguments.option("--box", "X0,...,Z1", "Box, from x0,y0,z0 to x1,y1,z1, at which the solid is cut off",
                   into(read_box, request.box));
  arguments.option("--unit", "UNIT", "Length of a scene unit: mm, cm, m or in (3mf: mm, glb: m; others have no unit)",
                   one_of(units, request.unit));
  arguments.option("--up", "AXIS", "Axis of the file that points up: y (default), as in the scene, or z",
                   one_of({"y", "z"}, request.up));
  arguments.flag("--no-simplify", "Keep the triangles of all cells", request.plain);
  arguments.option("--threads", "N", "Number of threads (one per processor); never changes the mesh",
                   whole(request.threads, 1, 4096));
  if (const auto code = arguments.parse(args, streams)) return code;
  if (request.tolerance && request.resolution) {
    return fail(streams, kUsage, "--tolerance and --resolution both say how fine the mesh is",
                {"give one of the two"});
  }
  if (request.format) return std::nullopt;
  const std::string stem = request.scene.path == "-" ? "" : std::filesystem::path(request.scene.path).stem().string();
  read_mesh_output((stem.empty() ? "out" : stem) + ".stl", request);
  note(streams, fmt::format("the mesh goes to {}; -o FILE chooses another name", request.output));
  return std::nullopt;
}

// Formats a place of the scene to a tenth of `size`, so that it is found in parts far from zero, too.
std::string place_text(glm::dvec3 p, double size) {
  double scale = 1;
  while (scale * size < 10 && scale < 1e12) scale *= 10;
  p = glm::round(p * scale) / scale + 0.0;  // no -0
  return fmt::format("({:.12g}, {:.12g}, {:.12g})", p.x, p.y, p.z);
}
std::string box_text(const compiler::Box& b) {
  return fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", b.lo.x, b.lo.y, b.lo.z, b.hi.x, b.hi.y, b.hi.z);
}

std::variant<runtime::MeshBox, ExitCode> choose_box(const MeshRequest& request, const compiler::CompiledScene& scene,
                                                    const Streams& streams) {
  std::optional<compiler::Box> wanted;
  if (request.box) wanted = compiler::Box{request.box->lo - scene.origin, request.box->hi - scene.origin};
  const auto chosen = runtime::mesh_box(scene, wanted);
  if (const auto* box = std::get_if<runtime::MeshBox>(&chosen)) return *box;
  if (std::get<runtime::NoMeshBox>(chosen) == runtime::NoMeshBox::Empty) {
    return fail_about(request.scene, kBadScene,
                      request.box ? "nothing of the scene is in the box" : "the scene is empty", {}, streams);
  }
  Help help = {"--box X0,Y0,Z0,X1,Y1,Z1 cuts the scene off at a box"};
  const compiler::Box contents = scene.contents.moved(scene.origin);
  if (!contents.empty() && contents.finite()) help.push_back("its bounded parts are in --box " + box_text(contents));
  return fail_about(request.scene, kBadScene, "the scene has no end, and a mesh has", help, streams);
}

ExitCode fail_to_mesh(const MeshRequest& request, const runtime::MeshResult& result, double memory,
                      const Streams& streams) {
  using End = runtime::MeshResult::End;
  if (result.end == End::TooFine) {
    return fail_about(request.scene, kUsage, "cells of this size are too small for single precision",
                      {"give a larger --tolerance or a smaller --resolution"}, streams);
  }
  if (result.end == End::TooMany) {
    return fail_about(request.scene, kUsage,
                      fmt::format("the mesh needs about {} of memory, and {} are allowed",
                                  format_bytes(result.memory), format_bytes(memory)),
                      {"give a larger --tolerance or a smaller --resolution",
                       compiler::raise(&compiler::Limits::memory, result.memory)},
                      streams);
  }
  return fail_about(request.scene, kBadScene, "no part of the scene is as thick as the cells: the mesh is empty",
                    {"give a smaller --tolerance or a larger --resolution"}, streams);
}

std::string surface_name(const compiler::CompiledScene& scene, std::uint32_t surface) {
  const bool named = surface < scene.surfaces.size() && !scene.surfaces[surface].name.empty();
  return named ? fmt::format("`{}`", scene.surfaces[surface].name) : "the scene";
}

std::string lost_part_text(const compiler::CompiledScene& scene, const runtime::LostPart& part) {
  const std::string name = surface_name(scene, part.surface), other = surface_name(scene, part.other);
  std::string text = part.is_gap ? "a gap of " + name : "a part of " + name;
  if (part.is_gap && name != other) text = fmt::format("a gap between {} and {}", name, other);
  text += fmt::format(", {:.2g} {} at {}: ", part.thickness, part.is_gap ? "wide" : "thin",
                      place_text(part.place + scene.origin, part.thickness));
  if (part.is_torn) {
    text += part.is_gap ? "the mesh closes it" : "it is in pieces in the mesh";
  } else {
    text += fmt::format("the mesh lacks it at {}", count_of(part.places, "place"));
  }
  if (part.tapers) return text + "; it thins out, and finer cells lose less of it";
  return text + fmt::format("; --tolerance {:.2g} keeps it{}", part.thickness, part.is_torn ? " in one here" : "");
}

void warn_of_lost_parts(const compiler::CompiledScene& scene, const runtime::MeshResult& result,
                        const Streams& streams) {
  for (const runtime::LostPart& part : result.lost) warn(streams, lost_part_text(scene, part));
}

// Returns the mesh in the coordinates of the file.
runtime::MeshDocument make_document(const MeshRequest& request, const compiler::CompiledScene& scene,
                                    runtime::TriangleMesh mesh) {
  runtime::MeshDocument document;
  document.materials = runtime::mesh_materials(scene, mesh, document.material_of);
  document.mesh = std::move(mesh);
  for (glm::dvec3& v : document.mesh.vertices) {
    v += scene.origin;
    if (request.up == 1) v = {v.x, -v.z, v.y};
  }
  document.name = std::filesystem::path(request.output).stem().string();
  std::vector<std::string> names;
  for (const compiler::Surface& surface : scene.surfaces) names.push_back(surface.name);
  document.parts = runtime::mesh_parts(document.mesh, names, document.name);
  if (request.unit >= 0) document.unit = &runtime::kLengthUnits[static_cast<std::size_t>(request.unit)];
  return document;
}

// Returns the names of all files that the mesh is written to.
std::vector<std::string> outputs_of(const MeshRequest& request) {
  std::vector<std::string> outputs = {request.output};
  if (request.format->format == runtime::MeshFormat::Obj) {
    outputs.push_back(runtime::material_file_of(request.output));
  }
  return outputs;
}

std::optional<std::string> write_document(const MeshRequest& request, const runtime::MeshDocument& document) {
  using runtime::MeshFormat;
  switch (request.format->format) {
    case MeshFormat::Stl:
      return runtime::write_file(encode_stl(document), request.output);
    case MeshFormat::Ply:
      return runtime::write_file(encode_ply(document), request.output);
    case MeshFormat::Glb:
      return runtime::write_file(encode_glb(document), request.output);
    case MeshFormat::ThreeMf: {
      const auto bytes = encode_3mf(document);
      return bytes ? runtime::write_file(*bytes, request.output) : fmt::format("cannot pack `{}`", request.output);
    }
    case MeshFormat::Obj:
      break;
  }
  // Both files are whole before either gets its name.
  const std::string materials = runtime::material_file_of(request.output);
  runtime::AtomicFile mesh_file(request.output), material_file(materials);
  mesh_file.write(encode_obj(document, std::filesystem::path(materials).filename().string()));
  material_file.write(encode_mtl(document));
  std::optional<std::string> problem = material_file.problem();
  if (problem) return problem;
  const auto renamed = mesh_file.commit([&] { return !(problem = material_file.commit()); });
  return problem ? problem : renamed;
}

std::string solids_text(const runtime::TriangleMesh& mesh) {
  const runtime::MeshMeasures measures = runtime::measure(mesh);
  return (measures.bodies == 1 ? "1 body" : fmt::format("{} bodies", measures.bodies)) + ", " +
         count_of(measures.hollows, "hollow");
}

void summarise(const MeshRequest& request, const compiler::CompiledScene& scene, const runtime::MeshResult& result,
               const runtime::MeshDocument& document, int threads, double seconds, const Streams& streams) {
  compiler::Box box;
  for (const glm::dvec3& v : document.mesh.vertices) box = unite(box, {v, v});
  const glm::dvec3 size = box.hi - box.lo;
  say(streams,
      fmt::format("wrote {}: {} triangles, {} vertices, {}, {:.4g} x {:.4g} x {:.4g}{}{}", request.output,
                  document.mesh.triangles.size(), document.mesh.vertices.size(), solids_text(document.mesh), size.x,
                  size.y, size.z, document.unit ? " " : "", document.unit ? document.unit->name : ""));
  say(streams,
      fmt::format("{}, {}, {}", count_of(runtime::count_crossings(document.mesh, threads), "crossing"),
                  count_of(runtime::count_folds(document.mesh), "fold"), count_of(result.islands, "island")));
  constexpr double kUp = 1.0005;  // so that four digits are not below the bound
  say(streams,
      fmt::format("every point of the mesh is within {:.4g} of the surface ({}); parts of the surface thinner "
                  "than {:.4g} may be further from the mesh",
                  kUp * result.bound, scene.certified ? "proved" : "estimated: the float error of the scene is",
                  result.cell));
  say(streams, fmt::format("{} cells of {:.4g}, {} triangles before simplification, {:.2f} s", result.cells,
                           result.cell, result.contour_triangles, seconds));
}

}  // namespace

int run_mesh(std::span<const std::string> args, const Streams& streams) {
  MeshRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  if (const auto code = check_output_files(outputs_of(request), streams)) return *code;
  auto source = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&source)) return *code;
  const auto compiled = compile_scene(std::get<SceneInput>(std::move(source)), request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&compiled)) return *code;
  const auto& scene = std::get<compiler::CompiledScene>(compiled);
  const auto chosen = choose_box(request, scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&chosen)) return *code;
  const auto& box = std::get<runtime::MeshBox>(chosen);

  const auto start = std::chrono::steady_clock::now();
  runtime::MeshOptions options =
      runtime::mesh_options(box, request.tolerance, request.resolution.value_or(runtime::kDefaultResolution));
  options.simplifies = !request.plain;
  options.memory = allowed_memory(request.scene.limits);
  options.threads = request.threads ? *request.threads : runtime::usable_processors();
  auto last = start;
  StepLine line(streams, "meshing");
  options.progress = [&](std::string_view step) {
    line.begin(step);
    const auto now = std::chrono::steady_clock::now();
    if (streams.verbosity > 0)
      note(streams, fmt::format("{:.2f} s before: {}", std::chrono::duration<double>(now - last).count(), step));
    last = now;
  };
  runtime::MeshResult result = runtime::make_mesh(scene, box.box, options);
  line.end();
  warn_of_lost_parts(scene, result, streams);
  if (result.end != runtime::MeshResult::End::Done) return fail_to_mesh(request, result, options.memory, streams);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  const runtime::MeshDocument document = make_document(request, scene, std::move(result.mesh));
  if (const auto problem = write_document(request, document)) return fail(streams, kIo, *problem);
  summarise(request, scene, result, document, options.threads, time.count(), streams);
  return kDone;
}

}  // namespace fathom::cli
