#include "runtime/cli/view/pixel_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "compiler/lower/lower.h"
#include "runtime/field/field.h"
#include "runtime/march/march.h"
#include "runtime/sampling/camera.h"
#include "vm/interpret/evaluate.h"

namespace fathom::cli {
namespace {

using nlohmann::json;
using runtime::RayHit;

constexpr int kMaxSteps = 256;
// Distances below this share of the way are at the surface as far as a plot can show.
constexpr double kNear = 1e-5;
// Share of the distance that a step takes in a field without a Lipschitz constant.
constexpr double kGuessedStep = 0.3;

json list(glm::dvec3 v) { return {v.x, v.y, v.z}; }

// Returns [distance along the ray, field] for the steps of sphere tracing (Hart, "Sphere Tracing", 1996), which shows
// the field along the ray better than the renderer's few and long steps. Ends at `end`, where the ray hits.
json steps_along(const compiler::CompiledScene& scene, const runtime::CameraRay& ray, double end) {
  json steps = json::array();
  vm::Workspace workspace;
  const double share = std::isfinite(scene.lipschitz) ? 1 / std::max(scene.lipschitz, 1e-6) : kGuessedStep;
  double t = 0;
  for (int i = 0; i < kMaxSteps && t < end; ++i) {
    const double f = vm::evaluate_surface(scene.distance, ray.origin + t * ray.direction, workspace).distance;
    if (!std::isfinite(f)) break;
    steps.push_back({t, f});
    const double step = std::abs(f) * share;
    if (step < kNear * (1 + t)) break;
    t += step;
  }
  if (!std::isfinite(end)) return steps;
  const double f = vm::evaluate_surface(scene.distance, ray.origin + end * ray.direction, workspace).distance;
  steps.push_back({end, f});
  return steps;
}

// Returns how a hit is known.
std::string certificate(const compiler::CompiledScene& scene, const RayHit& hit) {
  std::string text;
  if (hit.status == RayHit::Status::Hit) {
    text = fmt::format("the field changes its sign within {:.3g} scene units", static_cast<double>(hit.width));
    text +=
        hit.certified > 0 ? fmt::format("; {} of the evaluations were in double", hit.certified) : "; float decided";
  } else if (hit.status == RayHit::Status::NearMiss) {
    text = "a miss that comes nearer to a surface than double resolves";
  } else if (hit.status == RayHit::Status::Invalid) {
    text = "the field is not a number on the ray";
  } else {
    text = "the ray meets nothing";
  }
  return text + (scene.certified ? "; no surface before it can have been missed: the field's slope is proved"
                                 : "; the field's slope is an estimate, so that a surface before it may be missed");
}

// Returns the source position of a surface: of its `tag`, or of the last instruction of a program without tags.
// Null if it is not in the scene's own file.
const vm::DebugEntry* find_surface(const compiler::CompiledScene& scene, std::uint32_t surface) {
  const vm::Program& code = scene.surface.program();
  const vm::DebugEntry* found = nullptr;
  bool has_tags = false;
  for (const vm::DebugEntry& entry : code.debug) {
    const std::uint32_t word = code.words[entry.offset];
    const bool is_tag = vm::find_opcode(word & 0xff)->mnemonic == "tag";
    has_tags |= is_tag;
    if (entry.line == 0 || is_in_import(entry, scene.source)) continue;
    if (is_tag && vm::operand_of(word) == surface) return &entry;
    found = &entry;
  }
  return has_tags ? nullptr : found;
}

void add_surface(json& answer, const compiler::CompiledScene& scene, glm::dvec3 point, int side) {
  vm::Workspace workspace;
  const vm::SurfaceValue value = vm::evaluate_surface(scene.surface, point, workspace);
  const double length = glm::length(value.gradient);
  answer["position"] = list(point + scene.origin);
  answer["normal"] = list(length > 0 ? value.gradient * (side / length) : glm::dvec3(0));
  answer["slope"] = length;
  if (value.surface >= scene.surfaces.size()) return;
  const compiler::Surface& surface = scene.surfaces[value.surface];
  answer["object"] = surface.name;
  answer["material"] = scene.materials[surface.material].name;
  if (const vm::DebugEntry* entry = find_surface(scene, value.surface)) {
    answer["line"] = entry->line, answer["column"] = entry->column;
  }
}

}  // namespace

json pixel_answer(const compiler::CompiledScene& scene, const compiler::Camera& camera, int width, int height,
                  double x, double y) {
  const runtime::CameraRay ray = runtime::Camera(camera, width, height).ray(x, y);
  const runtime::Field field = runtime::make_field(scene, scene.settings.far);
  const runtime::Ray rays[] = {{ray.origin, ray.direction}};
  const RayHit hit = runtime::march(field, rays).ray_hits.front();
  const bool is_hit = hit.status == RayHit::Status::Hit;
  json answer = {{"hit", is_hit},
                 {"origin", list(ray.origin + scene.origin)},
                 {"direction", list(ray.direction)},
                 {"steps", steps_along(scene, ray, is_hit ? hit.t : std::numeric_limits<double>::infinity())},
                 {"certificate", certificate(scene, hit)},
                 {"evaluations", hit.evaluations},
                 {"instructions", hit.instructions}};
  answer["lipschitz"] = std::isfinite(scene.lipschitz) ? json(scene.lipschitz) : json(nullptr);
  answer["exactness"] = scene.certified ? "proved" : "estimate";
  if (!is_hit) return answer;
  answer["distance"] = hit.t;
  add_surface(answer, scene, ray.origin + hit.t * ray.direction, hit.side);
  return answer;
}

}  // namespace fathom::cli
