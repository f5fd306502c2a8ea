#include "runtime/cli/picture/invalid_rays.h"

#include <fmt/format.h>

#include <optional>

#include "compiler/analysis/nan_regions.h"

namespace fathom::cli {
namespace {

// Finds the operation without a value at `at`, in the scene's program or in the program of one of its media.
std::optional<compiler::NanPlace> explain(const compiler::CompiledScene& scene, glm::dvec3 at) {
  if (auto place = compiler::explain_nan(scene.distance, at)) return place;
  for (const compiler::Medium& medium : scene.media) {
    if (auto place = compiler::explain_nan(medium.distance, at)) return place;
  }
  return std::nullopt;
}

}  // namespace

std::string invalid_text(const compiler::CompiledScene& scene, std::uint64_t invalid, std::uint64_t rays,
                         glm::dvec3 at) {
  const glm::dvec3 place = at + scene.origin;
  const double share = 100.0 * static_cast<double>(invalid) / static_cast<double>(rays);
  std::string text = fmt::format(
      "{} of {} rays ({:.2g} %) are black, for they met a place where the field is not a "
      "number, as at {:.4g},{:.4g},{:.4g}",
      invalid, rays, share, place.x, place.y, place.z);
  const std::optional<compiler::NanPlace> cause = explain(scene, at);
  if (!cause || cause->operation.empty()) return text;
  text += fmt::format(": the {}", cause->operation);
  if (cause->line > 0) text += fmt::format(" at {}:{}:{}", scene.source.name(), cause->line, cause->column);
  return text + fmt::format(" has no value there; {}", compiler::kNanRemedy);
}

}  // namespace fathom::cli
