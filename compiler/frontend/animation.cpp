#include "compiler/frontend/animation.h"

#include <algorithm>
#include <string>
#include <variant>

#include "compiler/frontend/elaborate/settings.h"
#include "compiler/frontend/read_scene.h"

namespace fathom::compiler {
namespace {

const syntax::Value* value_of(const syntax::File& file, std::string_view name) {
  const auto* record = std::get_if<syntax::Record>(&file.root.data);
  const syntax::Property* property = record ? record->find(name) : nullptr;
  return property ? property->value.get() : nullptr;
}

}  // namespace

std::optional<Animation> read_animation(Source& source, Diagnostics& diagnostics, const Limits& limits,
                                        const Definitions& definitions, const ImportReader& imports) {
  std::optional<ReadScene> read = read_scene(source, diagnostics, limits, definitions, imports);
  if (!read) return std::nullopt;
  const Scope parameters = read->parameters
                               ? *std::move(read->parameters)
                               : read_parameters(value_of(read->file, "params"), definitions, limits, diagnostics);
  Animation animation;
  animation.time = declares(parameters, kTimeParameter);
  animation.frame = declares(parameters, kFrameParameter);
  const syntax::Value* value = value_of(read->file, "film");
  if (value != nullptr && std::holds_alternative<syntax::Record>(value->data)) {
    const Film film = read_film(*value, parameters, diagnostics);
    animation.frames = film.frames;
    animation.fps = film.fps;
  }
  if (diagnostics.has_errors()) return std::nullopt;
  return animation;
}

Definitions moment(const Animation& animation, int frame, double time) {
  Definitions definitions;
  if (animation.time) definitions.emplace_back(kTimeParameter, time);
  if (animation.frame) definitions.emplace_back(kFrameParameter, frame);
  return definitions;
}

}  // namespace fathom::compiler
