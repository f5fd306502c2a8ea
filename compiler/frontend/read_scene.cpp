#include "compiler/frontend/read_scene.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/derive/derive.h"
#include "compiler/frontend/elaborate/elaborate.h"
#include "compiler/frontend/formats/expression_list.h"
#include "compiler/frontend/formats/nested_nodes.h"
#include "compiler/frontend/syntax/json.h"
#include "compiler/frontend/text/print.h"

namespace fathom::compiler {

namespace {

// Converts a scene of another format to text. Checks that scene separately first, so that error messages refer to its
// own lines.
TextMaker text_maker(const Limits& limits) {
  return [&limits](const Source& scene, Diagnostics& diagnostics) -> std::optional<std::string> {
    Source source = scene;
    const std::optional<ReadScene> read = read_scene(source, diagnostics, limits);
    const std::optional<ElaboratedScene> checked =
        read ? elaborate(read->file, diagnostics, {}, limits) : std::nullopt;
    if (checked) derive(checked->scene, checked->type_spans, limits, diagnostics);
    if (diagnostics.has_errors()) return std::nullopt;
    return text::print_text(read->file, source);
  };
}

}  // namespace

std::optional<SceneWithFormulas> read_with_formulas(Source& source, Diagnostics& diagnostics, const Limits& limits,
                                                    const ImportReader& imports) {
  return read_text_with_formulas(source, limits, diagnostics, {imports, text_maker(limits)});
}

std::optional<ReadScene> read_scene(Source& source, Diagnostics& diagnostics, const Limits& limits,
                                    const Definitions& definitions, const ImportReader& imports) {
  const auto size = static_cast<double>(source.text().size());
  if (size > limits.file_size) {
    diagnostics.error("E0008", {},
                      fmt::format("the file is {} bytes long; at most {} are read", size, limits.file_size), "",
                      {"move repeated parts to `nodes`", raise(&Limits::file_size, size)});
    return std::nullopt;
  }
  if (is_meant_as_text(source)) {
    auto read = read_text_scene(source, definitions, limits, diagnostics, {imports, text_maker(limits)});
    if (!read) return std::nullopt;
    return ReadScene{SceneFormat::Text, std::move(read->first), std::move(read->second)};
  }
  if (is_expression_list(source.text())) {
    std::optional<syntax::File> file = read_expression_list(source, diagnostics, limits);
    if (!file) return std::nullopt;
    return ReadScene{SceneFormat::ExpressionList, std::move(*file)};
  }
  std::optional<syntax::File> file = read_json(source, diagnostics, limits);
  if (!file) return std::nullopt;
  if (!is_nested_nodes(*file)) return ReadScene{SceneFormat::Scene, std::move(*file)};
  // Keep errors that are already reported, such as a duplicate property.
  if (diagnostics.has_errors()) return std::nullopt;
  std::optional<syntax::File> scene = from_nested_nodes(*file, diagnostics);
  if (!scene) return std::nullopt;
  return ReadScene{SceneFormat::NestedNodes, std::move(*scene)};
}

}  // namespace fathom::compiler
