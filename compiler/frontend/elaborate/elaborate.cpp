#include "compiler/frontend/elaborate/elaborate.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/frontend/elaborate/build.h"
#include "compiler/frontend/elaborate/check_node.h"
#include "compiler/frontend/elaborate/check_sorts.h"
#include "compiler/frontend/elaborate/lights.h"
#include "compiler/frontend/elaborate/materials.h"
#include "compiler/frontend/elaborate/name_order.h"
#include "compiler/frontend/elaborate/settings.h"
#include "compiler/frontend/records/record_reader.h"

namespace fathom::compiler {
namespace {

// Checked nodes of a scene, and facts about their names.
struct CheckedScene {
  Names material_names, node_names;
  std::vector<CheckedNode> named, objects;
  std::vector<std::vector<Use>> uses;  // [named node]
  std::vector<std::uint32_t> order;    // of `named`, as order_names() returns it
};

void check_version(const RecordReader& reader, Diagnostics& diagnostics) {
  const syntax::Value* version = reader.value("version");
  if (version == nullptr || std::get<double>(version->data) == kSceneVersion) return;
  diagnostics.error("E0105", version->span, fmt::format("unknown `version` {}", describe(*version)), "",
                    {fmt::format("this program reads \"version\": {}", kSceneVersion)});
}

// Returns, per named node, true if an object uses the node directly or indirectly.
std::vector<bool> reached(const CheckedScene& scene) {
  std::vector<bool> out(scene.named.size(), false);
  std::vector<std::uint32_t> pending;
  const auto reach = [&](const std::vector<Use>& uses) {
    for (const Use& use : uses) {
      if (out[use.target]) continue;
      out[use.target] = true;
      pending.push_back(use.target);
    }
  };
  for (const CheckedNode& object : scene.objects) reach(uses_of(object));
  while (!pending.empty()) {
    const std::uint32_t name = pending.back();
    pending.pop_back();
    reach(scene.uses[name]);
  }
  return out;
}

void warn_of_unused(const CheckedScene& scene, Diagnostics& diagnostics) {
  for (std::uint32_t i = 0; i < scene.material_names.size(); ++i) {
    if (scene.material_names.used(i)) continue;
    diagnostics.warning(
        "W0401", scene.material_names.span(i), fmt::format("unused material `{}`", scene.material_names.name(i)),
        "no node has it",
        {diagnostics.spelled(
            fmt::format("give it to a node with \"material\": \"{}\", or remove it", scene.material_names.name(i)),
            fmt::format("give it to a node with .material({}), or remove it", scene.material_names.name(i)))});
  }
  const std::vector<bool> in_scene = reached(scene);
  for (std::uint32_t i = 0; i < scene.node_names.size(); ++i) {
    if (in_scene[i]) continue;
    const bool elsewhere = scene.node_names.used(i);
    diagnostics.warning(
        "W0402", scene.node_names.span(i), fmt::format("unused node `{}`", scene.node_names.name(i)),
        elsewhere ? "only unused nodes use it" : "nothing uses it",
        {diagnostics.spelled(fmt::format("place it with {{\"use\": \"{}\"}}, or remove it", scene.node_names.name(i)),
                             fmt::format("place it with `object {}`, or remove it", scene.node_names.name(i)))});
  }
}

CheckedScene check_nodes(const RecordReader& reader, const Scope& parameters, Diagnostics& diagnostics) {
  CheckedScene scene;
  const auto add_names = [&](const char* property, Names& names) {
    const syntax::Value* value = reader.value(property);
    if (value == nullptr) return;
    for (const syntax::Property& named : std::get<syntax::Record>(value->data).properties) names.add(named);
  };
  add_names("materials", scene.material_names);
  add_names("nodes", scene.node_names);
  NodeChecker checker(scene.material_names, scene.node_names, parameters, diagnostics);
  if (const syntax::Value* nodes = reader.value("nodes")) {
    for (const syntax::Property& named : std::get<syntax::Record>(nodes->data).properties) {
      CheckedNode& node = scene.named.emplace_back(checker.check(*named.value));
      if (node.name.empty()) node.name = named.name;
      scene.uses.push_back(uses_of(node));
    }
  }
  if (const syntax::Value* objects = reader.value("objects"))
    scene.objects = checker.check_list(*objects, "`objects`");
  scene.order = order_names(scene.uses, scene.node_names, diagnostics);
  if (!diagnostics.has_errors()) check_sorts(scene.named, scene.order, scene.objects, diagnostics);
  return scene;
}

ElaboratedScene read_settings(const RecordReader& reader, const Scope& scope, Diagnostics& diagnostics) {
  ElaboratedScene out;
  const syntax::Value* camera = reader.value("camera");
  if (camera != nullptr) out.camera = read_camera(*camera, scope, diagnostics);
  out.camera.automatic = camera == nullptr;
  if (const syntax::Value* film = reader.value("film")) out.film = read_film(*film, scope, diagnostics);
  if (const syntax::Value* render = reader.value("render")) out.settings = read_render(*render, scope, diagnostics);
  if (const syntax::Value* background = reader.value("background")) {
    out.background = read_background(*background, scope, diagnostics);
  }
  if (const syntax::Value* lights = reader.value("lights")) out.lights = read_lights(*lights, scope, diagnostics);
  if (const syntax::Value* materials = reader.value("materials")) {
    MaterialTables tables = read_materials(*materials, scope, diagnostics);
    out.materials = std::move(tables.materials);
    out.textures = std::move(tables.textures);
    out.formulas = std::move(tables.formulas);
  }
  return out;
}

// Returns the span of a number that exceeds a limit: the value of `property` in the scene's record `part`, or the
// name of that record.
Span place_of(const syntax::Record& scene, std::string_view part, std::string_view property) {
  const syntax::Property* found = scene.find(part);
  if (found == nullptr) return {};
  const auto* record = std::get_if<syntax::Record>(&found->value->data);
  const syntax::Property* inner = record ? record->find(property) : nullptr;
  return inner ? inner->value->span : found->name_span;
}

// Checks the settings in the scene. The command line checks the settings that it overrides.
void check_render_limits(const syntax::Record& record, const ElaboratedScene& scene, const Limits& limits,
                         Diagnostics& diagnostics) {
  const auto check = [&](double value, double Limits::*limit, std::string_view part, std::string_view property,
                         const std::string& what) {
    if (value <= limits.*limit) return;
    diagnostics.error("E0312", place_of(record, part, property),
                      fmt::format("{}; at most {:.15g} are allowed", what, limits.*limit), "", {raise(limit, value)});
  };
  const double width = scene.film.width, height = scene.film.height;
  check(width, &Limits::image_side, "film", "width", fmt::format("a picture {} pixels wide", width));
  check(height, &Limits::image_side, "film", "height", fmt::format("a picture {} pixels high", height));
  check(width * height, &Limits::pixels, "film", "",
        fmt::format("a picture of {} by {} pixels has {}", width, height, width * height));
  check(scene.settings.spp, &Limits::samples, "render", "spp", fmt::format("{} samples a pixel", scene.settings.spp));
}

// Warns if the camera has a shutter but the scene does not depend on time.
void warn_of_shutter(const syntax::Record& record, const Camera& camera, const Scope& parameters,
                     Diagnostics& diagnostics) {
  if (!(camera.shutter > 0) || declares(parameters, kTimeParameter)) return;
  diagnostics.warning("W0517", place_of(record, "camera", "shutter"),
                      "the `shutter` blurs nothing: the scene has no parameter `time`", "",
                      {diagnostics.spelled("declare it, \"params\": {\"time\": 0}, and move what is to move with it",
                                           "declare it, param time = 0, and move what is to move with it")});
}

}  // namespace

std::optional<ElaboratedScene> elaborate(const syntax::File& file, Diagnostics& diagnostics,
                                         const Definitions& definitions, const Limits& limits,
                                         std::optional<Scope> read) {
  const auto* record = std::get_if<syntax::Record>(&file.root.data);
  if (record == nullptr) {
    diagnostics.error(
        "E0101", file.root.span, fmt::format("a scene must be an object {{...}}, not {}", describe(file.root)), "",
        {"the smallest scene is {\"version\": 1, \"objects\": [{\"type\": \"sphere\", \"radius\": 1}]}"});
    return std::nullopt;
  }
  const syntax::Property* params = record->find("params");
  const Scope parameters =
      read ? *std::move(read)
           : read_parameters(params ? params->value.get() : nullptr, definitions, limits, diagnostics);
  const RecordReader reader(scene_record(), *record, opening(file.root.span), parameters, diagnostics);
  check_version(reader, diagnostics);
  ElaboratedScene out = read_settings(reader, parameters, diagnostics);
  check_render_limits(*record, out, limits, diagnostics);
  const CheckedScene scene = check_nodes(reader, parameters, diagnostics);
  // After errors do not warn: a misspelt name may be meant to refer to an apparently unused definition.
  if (diagnostics.has_errors()) return std::nullopt;
  warn_of_unused(scene, diagnostics);
  warn_of_unused(parameters, diagnostics);
  warn_of_shutter(*record, out.camera, parameters, diagnostics);
  for (const Scope::Entry& entry : parameters.entries()) out.parameters.push_back(entry.parameter);

  SceneBuilder builder(scene.named, scene.uses, scene.order, out.materials, out.textures, limits, diagnostics);
  for (const CheckedNode& object : scene.objects) builder.add_object(object);
  if (diagnostics.has_errors()) return std::nullopt;
  out.scene = builder.finish();
  out.type_spans = builder.take_type_spans();
  out.surfaces = builder.take_surfaces();
  return out;
}

}  // namespace fathom::compiler
