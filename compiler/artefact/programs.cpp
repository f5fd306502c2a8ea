#include "compiler/artefact/programs.h"

#include <fmt/format.h>

#include "vm/check.h"

namespace fathom::compiler {

std::vector<NamedProgram> programs_of(const CompiledScene& scene) {
  std::vector<NamedProgram> all = {{"distance", &scene.distance}, {"surface", &scene.surface}};
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    all.push_back({fmt::format("medium {} distance", i), &scene.media[i].distance});
    all.push_back({fmt::format("medium {} surface", i), &scene.media[i].surface});
  }
  for (std::size_t i = 0; i < scene.formulas.size(); ++i) {
    all.push_back({fmt::format("formula {}", i), &scene.formulas[i]});
  }
  return all;
}

bool has_debug(const vm::VerifiedProgram& program) {
  return !program.program().debug.empty() || !program.program().source_name.empty();
}

std::string ProgramList::name(std::size_t index) const {
  const std::string which = index % 2 == 0 ? "distance" : "surface";
  if (index < 2) return which;
  if (index < 2 + 2 * media_) return fmt::format("medium {} {}", index / 2 - 1, which);
  return fmt::format("formula {}", index - 2 - 2 * media_);
}

CompiledScene ProgramList::scene() && {
  CHECK(full(), "a scene has all of its programs");
  const auto field = [this](std::size_t at) {
    return CompiledField{std::move(programs[at]), std::move(programs[at + 1]), {}, {}, 1, 0, false};
  };
  CompiledScene scene{{}, field(0), {}, glm::dvec3(0), {}, {}, {}, 0, ""};
  for (std::size_t i = 0; i < media_; ++i) scene.media.push_back({field(2 + 2 * i), 0});
  for (std::size_t i = 0; i < formulas_; ++i) scene.formulas.push_back(std::move(programs[2 + 2 * media_ + i]));
  return scene;
}

std::optional<TagFault> check_tags(const CompiledScene& scene) {
  const std::vector<NamedProgram> all = programs_of(scene);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<std::uint32_t>& words = all[i].program->program().words;
    for (std::size_t at = 0; at < words.size(); at += vm::instruction_length(words[at])) {
      const bool tag = (words[at] & 0xff) == static_cast<std::uint32_t>(vm::Opcode::Tag);
      if (!tag || vm::operand_of(words[at]) < scene.surfaces.size()) continue;
      return TagFault{i, static_cast<std::uint32_t>(at),
                      fmt::format("tag {}: the scene has {} {}", vm::operand_of(words[at]), scene.surfaces.size(),
                                  scene.surfaces.size() == 1 ? "surface" : "surfaces")};
    }
  }
  return std::nullopt;
}

}  // namespace fathom::compiler
