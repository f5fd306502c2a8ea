#include "compiler/artefact/programs.h"

#include <fmt/format.h>

#include <algorithm>

#include "vm/program/check.h"

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
  CompiledScene scene{{}, {field(0), {}}, {}, glm::dvec3(0), {}, {}, {}, {}, 0, ""};
  for (std::size_t i = 0; i < media_; ++i) scene.media.push_back({{field(2 + 2 * i), {}}, 0});
  for (std::size_t i = 0; i < formulas_; ++i) scene.formulas.push_back(std::move(programs[2 + 2 * media_ + i]));
  return scene;
}

namespace {

// Calls of(word, surface) for every tag of a program until it returns false.
template <typename F>
void for_each_tag(const vm::VerifiedProgram& program, const F& of) {
  const std::vector<std::uint32_t>& words = program.program().words;
  for (std::size_t at = 0; at < words.size(); at += vm::instruction_length(words[at])) {
    const bool tag = (words[at] & 0xff) == static_cast<std::uint32_t>(vm::Opcode::Tag);
    if (tag && !of(static_cast<std::uint32_t>(at), vm::operand_of(words[at]))) return;
  }
}

}  // namespace

std::optional<TagFault> check_tags(const CompiledScene& scene) {
  const std::vector<NamedProgram> all = programs_of(scene);
  const std::size_t count = scene.surfaces.size();
  std::optional<TagFault> fault;
  for (std::size_t i = 0; i < all.size() && !fault; ++i) {
    for_each_tag(*all[i].program, [&](std::uint32_t word, std::uint32_t surface) {
      if (surface < count) return true;
      fault = TagFault{
          i, word, fmt::format("tag {}: the scene has {} {}", surface, count, count == 1 ? "surface" : "surfaces")};
      return false;
    });
  }
  return fault;
}

std::size_t surfaces_named(const vm::VerifiedProgram& program) {
  std::size_t count = 1;
  for_each_tag(program, [&](std::uint32_t, std::uint32_t surface) {
    count = std::max(count, std::size_t{surface} + 1);
    return true;
  });
  return count;
}

std::optional<Excess> excess_of(const CompiledScene& stored, const Limits& limits) {
  for (const NamedProgram& row : programs_of(stored)) {
    if (const auto excess = excess_of(*row.program, limits)) {
      return Excess{fmt::format("program `{}`: {}", row.name, excess->what), excess->remedy};
    }
  }
  const double width = stored.film.width, height = stored.film.height;
  if (const double side = std::max(width, height); side > limits.image_side) {
    return Excess{
        fmt::format("a picture of {} by {} pixels, and {} are allowed in a row", width, height, limits.image_side),
        raise(&Limits::image_side, side)};
  }
  if (width * height > limits.pixels) {
    return Excess{fmt::format("a picture of {} by {} pixels, and {} are allowed", width, height, limits.pixels),
                  raise(&Limits::pixels, width * height)};
  }
  if (stored.settings.spp > limits.samples) {
    return Excess{fmt::format("{} samples per pixel, and {} are allowed", stored.settings.spp, limits.samples),
                  raise(&Limits::samples, stored.settings.spp)};
  }
  return std::nullopt;
}

}  // namespace fathom::compiler
