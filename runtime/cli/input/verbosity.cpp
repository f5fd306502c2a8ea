#include "runtime/cli/input/verbosity.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <vector>

#include "runtime/cli/dump/operation_table.h"
#include "runtime/cli/options/camera_options.h"
#include "vm/encoding/disassemble.h"
#include "vm/encoding/printable.h"
#include "vm/interpret/evaluate.h"

namespace fathom::cli {
namespace {

// Counts the nodes reachable from the root, because passes leave unreachable nodes in the graph. Children have
// smaller ids than their parents.
std::size_t count_nodes(const compiler::Scene& scene) {
  std::vector<bool> reached(scene.root + 1);
  reached[scene.root] = true;
  for (std::size_t id = reached.size(); id-- > 0;) {
    if (!reached[id]) continue;
    for (const compiler::NodeId child : scene.graph.children(static_cast<compiler::NodeId>(id)))
      reached[child] = true;
  }
  return static_cast<std::size_t>(std::count(reached.begin(), reached.end(), true));
}

std::string triple(glm::dvec3 v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z); }

std::string describe_settings(const compiler::CompiledScene& scene, const runtime::Settings& settings) {
  std::string text = fmt::format("instruction set {}, {}\n", vm::isa_name(),
                                 count_of(static_cast<std::size_t>(settings.threads), "thread"));
  text += fmt::format("{}x{} pixels, {} samples per pixel, Russian roulette from bounce {}, tiles of {}, seed {}\n",
                      settings.width, settings.height, settings.spp, settings.rr_depth, settings.tile, settings.seed);
  text += fmt::format(
      "sampler {}, filter {}{}\n", compiler::kSamplerNames[static_cast<std::size_t>(settings.sampler)],
      compiler::kFilterNames[static_cast<std::size_t>(settings.filter)], settings.noise_threshold ? ", adaptive" : "");
  text += settings.far ? fmt::format("rays end after {:.6g}\n", *settings.far) : "";
  const compiler::Box bound = scene.bound.moved(scene.origin);
  text += fmt::format("bound {} to {}, Lipschitz constant {:.6g} ({})\n", triple(bound.lo), triple(bound.hi),
                      scene.lipschitz,
                      scene.certified             ? "proved"
                      : scene.formula_box.empty() ? "an estimate"
                                                  : "proved in cells");
  if (scene.origin != glm::dvec3(0)) text += fmt::format("the programs' origin is {}\n", triple(scene.origin));
  return text;
}

std::string describe_tables(const compiler::CompiledScene& scene) {
  std::string text;
  const char* types[] = {"diffuse", "emissive", "specular", "transparent", "principled"};
  for (const compiler::Material& material : scene.materials) {
    text += fmt::format("material `{}`: {}, colour {}\n", material.name,
                        types[static_cast<std::size_t>(material.type)], triple(material.color));
  }
  for (const compiler::Surface& surface : scene.surfaces) {
    text += fmt::format("surface `{}` of material `{}`\n", surface.name, scene.materials[surface.material].name);
  }
  return text;
}

}  // namespace

compiler::CompileOptions Verbosity::watch_compiler() {
  start_ = std::chrono::steady_clock::now();
  compiler::CompileOptions options;
  if (level_ < 2) return options;
  options.on_pass = [this](std::string_view pass, const compiler::Scene& scene) {
    streams_.err << fmt::format("after {:<12} {:>8} nodes\n", pass, count_nodes(scene));
  };
  return options;
}

void Verbosity::describe(const compiler::CompiledScene& scene) const {
  if (level_ < 1) return;
  const std::chrono::duration<double, std::milli> compiling = std::chrono::steady_clock::now() - start_;
  streams_.err << fmt::format("{}: {}\ncompiled in {:.1f} ms to {}, about {} a point\n",
                              vm::printable(scene.source.name()), scene.summary, compiling.count(),
                              count_of(scene.distance.instructions(), "instruction"),
                              count_of(scene.distance.cost(), "multiply-add"));
}

void Verbosity::describe(const compiler::CompiledScene& scene, const runtime::Settings& settings) const {
  std::ostream& err = streams_.err;
  describe(scene);
  if (level_ >= 1) err << camera_text(scene) << '\n';
  if (level_ >= 3) err << describe_settings(scene, settings);
  if (level_ >= 4) err << vm::printable(describe_tables(scene));
  if (level_ >= 5) err << operation_table(scene.distance);
  if (level_ >= 6)
    err << vm::disassemble(scene.distance, {.few = true}) << '\n' << vm::disassemble(scene.surface, {.few = true});
}

}  // namespace fathom::cli
