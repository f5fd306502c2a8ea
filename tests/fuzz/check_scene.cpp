#include "tests/fuzz/check_scene.h"

#include <algorithm>

#include "compiler/artefact/compiled_file.h"
#include "compiler/artefact/programs.h"
#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/read_scene.h"
#include "compiler/frontend/syntax/json.h"
#include "compiler/shapes/print_graph.h"
#include "tests/fuzz/check_program.h"
#include "tests/fuzz/target.h"
#include "tests/support/draw_small.h"
#include "vm/prune/def_use_graph.h"

namespace fathom::fuzz {
namespace {

using compiler::Diagnostics;
using compiler::Source;

void check_cheap(const vm::VerifiedProgram& program, test::Random& random, double reach) {
  if (program.cost() <= kMaxCost) check_program(program, random, reach);
}

// Checks that a written file reads back as the same scene.
void check_round_trip(const compiler::ReadScene& scene) {
  const std::string written = compiler::write_json(scene.file);
  const Source source("written.json", written);
  Diagnostics diagnostics;
  const auto read = compiler::read_json(source, diagnostics);
  if (!read) throw BrokenPromise("a written scene cannot be read: " + diagnostics.all().front().message);
  promise(compiler::write_json(*read) == written, "a written scene reads as another");
}

}  // namespace

void check_scene(const std::string& text) {
  Source source("scene.json", text);
  Diagnostics diagnostics;
  compiler::CompileOptions options;
  options.lint = true;
  // Small limits keep a run short.
  options.limits.instructions = 20'000;
  options.limits.nodes = 20'000;
  bool is_text = false;
  options.on_syntax = [&](const compiler::ReadScene& read) {
    is_text = read.format == compiler::SceneFormat::Text;
    if (!is_text && !diagnostics.has_errors()) check_round_trip(read);
  };
  options.on_pass = [&](std::string_view, const compiler::Scene& scene) { compiler::print_graph(scene, source); };
  const auto scene = compiler::compile(source, diagnostics, options);
  for (const auto format : {compiler::ErrorFormat::Text, compiler::ErrorFormat::Short, compiler::ErrorFormat::Json}) {
    const std::string printed = diagnostics.print(source, format);
    promise(printed.empty() == diagnostics.all().empty(), "every message is printed");
  }
  promise(scene.has_value() != diagnostics.has_errors(), "there is a scene exactly when there is no error");
  if (!scene) return;
  // Texts are checked only now: an expression's value may be infinite until the compiler refuses it, and JSON cannot
  // express infinity.
  if (is_text) check_round_trip(*compiler::read_scene(source, diagnostics));
  test::Random random(text.size());
  const compiler::Box box = scene->contents;
  const glm::dvec3 size = box.hi - box.lo;
  const double reach = !box.empty() && box.finite() ? std::clamp(size.x + size.y + size.z, 1e-3, 1e6) : 4;
  check_cheap(scene->distance, random, reach);
  check_cheap(scene->surface, random, reach);
  for (const compiler::Medium& medium : scene->media) check_cheap(medium.distance, random, reach);
  for (const vm::VerifiedProgram& formula : scene->formulas) check_cheap(formula, random, 4);
}

void check_stored(const compiler::CompiledScene& scene) {
  test::Random random(scene.distance.instructions());
  for (const compiler::NamedProgram& row : compiler::programs_of(scene)) {
    if (row.program->cost() > kMaxCost) continue;
    check_evaluation(*row.program, random, 4);
    vm::DefUseGraph().read(*row.program);
  }
  test::draw_small(scene);
}

}  // namespace fathom::fuzz
