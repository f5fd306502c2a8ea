#include "runtime/live/live_surfaces.h"

#include <algorithm>
#include <string_view>

#include "compiler/analysis/report.h"
#include "compiler/compile.h"
#include "runtime/field/field.h"
#include "runtime/march/march.h"
#include "runtime/sampling/camera.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {
namespace {

using compiler::CompiledScene;
using compiler::Exactness;

constexpr int kColumns = 64, kRows = 36;  // of the rays that see textures

std::vector<Ray> rays_of(const compiler::Camera& camera) {
  const Camera view(camera, kColumns, kRows);
  std::vector<Ray> rays;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const CameraRay ray = view.ray(x + 0.5, y + 0.5);
      rays.push_back({ray.origin, ray.direction});
    }
  }
  return rays;
}

// Returns the surfaces below an object, by its Paint nodes.
std::vector<std::size_t> surfaces_below(const compiler::FieldGraph& field, compiler::NodeId object) {
  std::vector<std::size_t> surfaces;
  std::vector<compiler::NodeId> open = {object};
  std::vector<bool> seen(field.graph().size(), false);
  while (!open.empty()) {
    const compiler::NodeId id = open.back();
    open.pop_back();
    if (seen[id]) continue;
    seen[id] = true;
    if (field.graph().kind(id) == compiler::Kind::Paint) {
      surfaces.push_back(static_cast<std::size_t>(field.graph().params(id)[0]));
    }
    for (const compiler::NodeId child : field.children(id)) open.push_back(child);
  }
  return surfaces;
}

std::optional<compiler::Scene> graph_of(const CompiledScene& scene) {
  compiler::Scene graph;
  compiler::CompileOptions options;
  options.stop_after = "graph";
  options.stage = true;
  options.file_at_hand = scene.background.image.file;
  for (const compiler::Parameter& row : scene.parameters) options.definitions.emplace_back(row.name, row.value);
  options.on_pass = [&](std::string_view, const compiler::Scene& stage) { graph = stage; };
  compiler::Diagnostics diagnostics;
  if (!compile(scene.source, diagnostics, options)) return std::nullopt;
  return graph;
}

}  // namespace

std::vector<MaterialPoint> mean_materials(const CompiledScene& scene, const compiler::Camera& camera) {
  const Materials materials(scene);
  std::vector<MaterialPoint> means;
  for (const compiler::Surface& surface : scene.surfaces) means.push_back(materials.untextured(surface.material));
  const auto is_textured = [&](const compiler::Surface& surface) { return materials.is_textured(surface.material); };
  if (std::ranges::none_of(scene.surfaces, is_textured)) return means;

  const std::vector<Ray> rays = rays_of(camera);
  std::vector<float> seen(means.size(), 0);
  vm::Workspace workspace;
  for (const RayHit& hit : march(make_field(scene, scene.settings.far), rays).ray_hits) {
    if (hit.status != RayHit::Status::Hit) continue;
    const glm::dvec3 point = rays[hit.id].origin + hit.t * rays[hit.id].direction;
    const vm::SurfacePlace found = vm::evaluate_place(scene.surface, point, workspace);
    if (found.surface >= means.size() || !is_textured(scene.surfaces[found.surface])) continue;
    const compiler::Surface& surface = scene.surfaces[found.surface];
    const MaterialPoint here = materials.at(surface.material, point, found.place + surface.shift, workspace);
    means[found.surface] = mix(means[found.surface], here, 1 / ++seen[found.surface]);
  }
  return means;
}

std::vector<Exactness> exactness_of_surfaces(const CompiledScene& scene) {
  std::vector<Exactness> all(scene.surfaces.size(), scene.certified ? Exactness::Bound : Exactness::Estimate);
  if (scene.source.text().empty()) return all;
  const std::optional<compiler::Scene> graph = graph_of(scene);
  if (!graph) return all;
  const compiler::FieldGraph field(*graph);
  const bool in_cells = field.in_cells();
  for (const compiler::NodeId object : field.objects(scene.surfaces)) {
    const std::string_view name = class_of(field.known(object), in_cells);
    const Exactness exactness = name == "exact"      ? Exactness::Exact
                                : name == "estimate" ? Exactness::Estimate
                                                     : Exactness::Bound;
    for (const std::size_t surface : surfaces_below(field, object)) {
      if (surface < all.size()) all[surface] = exactness;
    }
  }
  return all;
}

}  // namespace fathom::runtime
