#include <algorithm>
#include <vector>

#include "compiler/analysis/lints.h"
#include "compiler/analysis/report.h"
#include "vm/interpret/evaluate.h"

namespace fathom::compiler {
namespace {

bool is_black(const Background& background) {
  switch (background.type) {
    case Background::Type::Gradient:
      return background.bottom == glm::dvec3(0) && background.top == glm::dvec3(0);
    case Background::Type::Sky:
      return background.sky.strength == 0;
    case Background::Type::Image:
      return background.image.strength == 0;
  }
  return false;
}

bool uses_emission(const Scene& scene, const SceneTables& tables) {
  const FieldGraph field(scene);
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (scene.graph.kind(id) != Kind::Paint || !field.reached(id)) continue;
    const auto surface = static_cast<std::size_t>(scene.graph.params(id)[0]);
    if (surface < tables.surfaces.size() && emits(tables.materials[tables.surfaces[surface].material])) return true;
  }
  return false;
}

// True if a point is inside an opaque solid.
bool is_buried(glm::dvec3 place, const SceneTables& tables, const vm::VerifiedProgram& surface,
               vm::Workspace& workspace) {
  const vm::SurfaceValue value = vm::evaluate_surface(surface, place, workspace);
  if (!(value.distance < 0)) return false;
  const std::size_t number = value.surface < tables.surfaces.size() ? value.surface : 0;
  return !transmits(tables.materials[tables.surfaces[number].material]);
}

}  // namespace

void lint_light(const Scene& scene, const SceneTables& tables, const vm::VerifiedProgram& surface,
                Diagnostics& diagnostics) {
  if (!is_black(tables.background) || uses_emission(scene, tables)) return;
  vm::Workspace workspace;
  // A camera in the same solid may see surfaces that the enclosed light shines on.
  const bool outside = !is_buried(tables.camera.position, tables, surface, workspace);
  std::size_t buried = 0;
  for (const Light& light : tables.lights) {
    if (light.intensity == glm::dvec3(0)) continue;
    const bool placed = light.type != Light::Type::Directional;
    if (!outside || !placed || !is_buried(light.position, tables, surface, workspace)) return;
    ++buried;
  }
  Span span = scene.graph.origin(scene.root).span;
  if (span.end == 0 && !scene.graph.children(scene.root).empty()) {
    span = scene.graph.origin(scene.graph.children(scene.root)[0]).span;
  }
  if (buried > 0) {
    diagnostics.warning("W0515", span, "no light reaches the camera: the picture will be black",
                        "every light is inside a solid that no light passes",
                        {"move the lights out of the solids, or give the scene a `background`"});
    return;
  }
  const bool none = tables.lights.empty();
  diagnostics.warning("W0515", span, "there is no light: the picture will be black",
                      none ? "no lights, no emissive material in use, and a black background"
                           : "every light has an intensity of 0, no emissive material is in use, and the background "
                             "is black",
                      {"give the scene a `background`, as [1, 1, 1], or `lights`, or an emissive material"});
}

}  // namespace fathom::compiler
