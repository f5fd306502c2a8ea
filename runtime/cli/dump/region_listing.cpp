#include "runtime/cli/dump/region_listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "compiler/graph/node_facts.h"
#include "compiler/source/limits.h"
#include "runtime/field/field.h"
#include "runtime/render.h"
#include "vm/encoding/disassemble.h"
#include "vm/program/check.h"

namespace fathom::cli {
namespace {

// Budget in multiply-adds, a few seconds, for building regions of a program too short for renders to use regions.
constexpr double kMaxCost = 2e10;

// Makes a program of a region's part. Its instructions keep the symbols of the instructions that they come from.
vm::VerifiedProgram as_program(const vm::PrunedProgram& part, const vm::Program& whole) {
  vm::Program program;
  program.words = part.words, program.doubles = part.doubles, program.locals = part.locals;
  program.source_name = whole.source_name;
  std::uint32_t at = 0;
  for (const std::uint32_t source : part.sources) {
    const auto entry =
        std::lower_bound(whole.debug.begin(), whole.debug.end(), source,
                         [](const vm::DebugEntry& e, std::uint32_t offset) { return e.offset < offset; });
    program.debug.push_back(entry == whole.debug.end() ? vm::DebugEntry{} : *entry);
    program.debug.back().offset = at;
    at += static_cast<std::uint32_t>(vm::instruction_length(program.words[at]));
  }
  auto verified = vm::verify(std::move(program), compiler::largest_machine());
  CHECK(std::holds_alternative<vm::VerifiedProgram>(verified), "the part of a sound program is sound");
  return std::get<vm::VerifiedProgram>(std::move(verified));
}

std::string size_of(std::size_t instructions, std::uint64_t cost) {
  return fmt::format("{} instruction{}, {} multiply-adds a point", instructions, instructions == 1 ? "" : "s", cost);
}

}  // namespace

std::optional<std::string> region_listing(const compiler::CompiledScene& scene, glm::dvec3 point) {
  runtime::Field field = runtime::make_field(scene, scene.settings.far);
  runtime::RegionOptions options = runtime::region_options(runtime::resolve(scene, {}));
  add_regions(field, scene, options);
  const bool used = field.regions != nullptr;
  options.always = true, options.evaluations = kMaxCost / static_cast<double>(scene.distance.cost());
  if (!used) add_regions(field, scene, options);
  if (!field.regions) return std::nullopt;
  const runtime::Regions::Region region = field.regions->region(point - scene.origin);
  const vm::VerifiedProgram& whole = scene.surface;
  std::string text = fmt::format("; region at {} {} {}: {}, cell {}\n", point.x, point.y, point.z, region.kind,
                                 compiler::describe(region.cell.moved(scene.origin)));
  if (scene.origin != glm::dvec3(0)) {
    text += fmt::format("; origin {} {} {}\n", scene.origin.x, scene.origin.y, scene.origin.z);
  }
  if (!used) text += "; the whole program is so short that renders evaluate it everywhere\n";
  if (region.part.words.empty()) {
    text += fmt::format("; nothing is near: distances round to {:.6g}\n", region.limit);
  } else {
    const vm::VerifiedProgram part = as_program(region.part, whole.program());
    if (std::isfinite(region.limit)) text += fmt::format("; holds where the field is at most {:.6g}\n", region.limit);
    text += fmt::format("; {}\n", size_of(part.instructions(), part.cost())) + vm::disassemble(part, {.few = true});
  }
  return text + fmt::format("\n; whole: {}\n", size_of(whole.instructions(), whole.cost())) +
         vm::disassemble(whole, {.few = true});
}

}  // namespace fathom::cli
