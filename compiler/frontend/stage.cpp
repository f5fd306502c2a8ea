#include "compiler/frontend/stage.h"

#include <algorithm>
#include <variant>

#include "compiler/frontend/syntax/make_syntax.h"
#include "compiler/scene/lowest.h"

namespace fathom::compiler {
namespace {

// Light behind the camera's left shoulder: direction towards it, irradiance on a surface that faces it, and half the
// angle that its disc subtends, in degrees.
constexpr glm::dvec3 kToLamp{-0.4, 1, 0.7};
constexpr double kIrradiance = 2.5, kHalfDisc = 6;
constexpr double kGroundColor = 0.4;

syntax::Value* value_of(syntax::Record& record, std::string_view name) {
  const syntax::Property* found = record.find(name);
  return found ? found->value.get() : nullptr;
}

void add_stage(syntax::File& file, double ground) {
  auto& root = std::get<syntax::Record>(file.root.data);
  const Span whole = file.root.span;
  std::erase_if(root.properties, [](const syntax::Property& property) { return property.name == "camera"; });

  RecordMaker color(whole), lamp(whole), lights(whole), floor(whole);
  std::get<syntax::Record>(value_of(root, "materials")->data)
      .properties.push_back({"ground", whole,
                             std::make_unique<syntax::Value>(
                                 color.add("type", "diffuse").add("color", glm::dvec3(kGroundColor)).take())});
  floor.add("name", "ground").add("type", "plane").add("normal", glm::dvec3(0, 1, 0)).add("offset", ground);
  std::get<syntax::List>(value_of(root, "objects")->data).push_back(floor.add("material", "ground").take());
  lamp.add("type", "directional").add("toward", kToLamp).add("irradiance", glm::dvec3(kIrradiance));
  lights.add("lamp", lamp.add("angle", kHalfDisc).take());
  root.properties.push_back({"lights", whole, std::make_unique<syntax::Value>(lights.take())});
}

}  // namespace

bool wants_stage(const ReadScene& scene) {
  if (scene.format == SceneFormat::Scene || scene.format == SceneFormat::Text) return false;
  const auto& root = std::get<syntax::Record>(scene.file.root.data);
  const syntax::Property* camera = root.find("camera");
  return camera && !std::get<syntax::Record>(camera->value->data).find("type");
}

void set_stage(ReadScene& scene, const CompiledScene& compiled) {
  if (!wants_stage(scene) || compiled.extent.empty()) return;
  // For nested nodes `extent` is the bounding box of the primitives. For an expression list it is the fixed box of
  // the format, however little of it the solid fills, so search for the lowest point.
  const Box& box = compiled.extent;
  const double bottom = scene.format == SceneFormat::ExpressionList ? lowest(compiled.distance, box) : box.lo.y;
  add_stage(scene.file, bottom + compiled.origin.y);
}

}  // namespace fathom::compiler
