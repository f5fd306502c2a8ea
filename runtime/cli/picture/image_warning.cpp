#include "runtime/cli/picture/image_warning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "runtime/film/film_layers.h"
#include "runtime/image/image.h"
#include "runtime/sampling/camera.h"
#include "vm/interpret/evaluate.h"
#include "vm/number/real.h"

namespace fathom::cli {
namespace {

constexpr const char* kFrameRemedy = "turn the camera to the scene; --frame shows the whole scene";

// Tells where a finite box outside the view lies: "behind the camera", "to the left of the view". Empty if a camera
// ray might hit the box.
std::string place_out_of_view(const compiler::Box& box, const runtime::Camera& camera, const compiler::Film& film) {
  if (camera.projection() == compiler::Camera::Projection::Panorama || camera.has_lens()) return {};
  if (box.empty() || !box.finite()) return {};
  const bool perspective = camera.projection() == compiler::Camera::Projection::Perspective;
  const double margin = film.filter_width.value_or(4);  // pixels beyond the image that the filter may cover
  const glm::dvec2 half = camera.half_extent() * (1.0 + 2 * margin / glm::dvec2(film.width, film.height));
  bool behind = true, left = true, right = true, above = true, below = true;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner((i & 1) ? box.hi.x : box.lo.x, (i & 2) ? box.hi.y : box.lo.y,
                            (i & 4) ? box.hi.z : box.lo.z);
    const glm::dvec3 way = corner - camera.position();
    const double x = glm::dot(way, camera.right()), y = glm::dot(way, camera.up()),
                 z = glm::dot(way, camera.forward());
    const glm::dvec2 edge = perspective ? half * z : half;
    behind = behind && z < 0;
    left = left && x < -edge.x;
    right = right && x > edge.x;
    below = below && y < -edge.y;
    above = above && y > edge.y;
  }
  if (behind) return "behind the camera";
  if (left) return "to the left of the view";
  if (right) return "to the right of the view";
  if (above) return "above the view";
  return below ? "below the view" : "";
}

std::string place_of_scene(const compiler::CompiledScene& scene) {
  const compiler::Film& film = scene.film;
  return place_out_of_view(scene.bound, runtime::Camera(scene.camera, film.width, film.height), film);
}

// Properties that all pixels of the image share.
struct Summary {
  bool hit = false;                     // some ray hit a solid
  bool lit = false;                     // some pixel has nonzero radiance
  bool alike = true;                    // all pixels are displayed in one color
  double brightest = 0;                 // maximum radiance of any channel
  std::array<std::uint8_t, 3> color{};  // displayed color of the first pixel
};

Summary summarize(const compiler::CompiledScene& scene, const runtime::Film& film) {
  Summary summary;
  const runtime::PixelRect area = film.area();
  const runtime::DisplayImage shown(runtime::layer_of(film, runtime::Layer::Beauty),
                                    {scene.film.exposure, scene.film.tone});
  std::vector<std::uint8_t> row(3 * static_cast<std::size_t>(film.width()));
  for (int y = area.y0; y < area.y1; ++y) {
    shown.row(y - area.y0, std::span<std::uint8_t>(row));
    if (y == area.y0) std::copy_n(row.begin(), 3, summary.color.begin());
    for (int x = area.x0; x < area.x1; ++x) {
      const runtime::PixelMeans means = film.means(x, y);
      const auto at = row.begin() + 3 * (x - area.x0);
      summary.hit = summary.hit || means.hits > 0;
      summary.lit = summary.lit || means.radiance != glm::dvec3(0);
      summary.brightest = std::max({summary.brightest, means.radiance.x, means.radiance.y, means.radiance.z});
      summary.alike = summary.alike && std::equal(summary.color.begin(), summary.color.end(), at);
    }
    if (summary.hit && !summary.alike) break;
  }
  return summary;
}

// Returns the name of the solid around the camera, nullopt if there is none.
std::optional<std::string> solid_around_camera(const compiler::CompiledScene& scene) {
  if (scene.camera.projection == compiler::Camera::Projection::Orthographic) return std::nullopt;
  vm::Workspace workspace;
  const vm::SurfaceValue value = vm::evaluate_surface(scene.surface, scene.camera.position, workspace);
  if (!(value.distance < 0) || value.surface >= scene.surfaces.size()) return std::nullopt;
  return scene.surfaces[value.surface].name;
}

// Returns the exposure, in stops, that brings the brightest channel to one half.
double stops_to_show(double brightest) {
  return std::clamp(std::round(vm::real::log(0.5 / brightest) / std::numbers::ln2), -100.0, 100.0);
}

}  // namespace

void warn_of_empty_view(const compiler::CompiledScene& scene, compiler::Diagnostics& diagnostics) {
  const std::string place = place_of_scene(scene);
  if (place.empty()) return;
  diagnostics.warning("W0516", {}, fmt::format("nothing is in view: the whole scene is {}", place), "",
                      {kFrameRemedy});
}

std::optional<std::string> image_warning(const compiler::CompiledScene& scene, const runtime::RenderResult& result) {
  if (result.film.area().pixels() < 2) return std::nullopt;
  const Summary seen = summarize(scene, result.film);
  if (!seen.hit) {
    const std::string place = place_of_scene(scene);
    return fmt::format("nothing is in view: every camera ray missed{}; {}",
                       place.empty() ? "" : ", for the whole scene is " + place, kFrameRemedy);
  }
  if (!seen.alike) return std::nullopt;
  const std::optional<std::string> solid = solid_around_camera(scene);
  if (solid) {
    return fmt::format(
        "the picture is {} throughout: the camera is inside `{}`; move its `position` out, or give "
        "--position",
        seen.lit ? "one color" : "black", *solid);
  }
  if (!seen.lit) {
    return "the picture is black throughout: no light reached the camera; move the lights to where what is in view "
           "is not in their shadow, or give the scene a `background`";
  }
  const auto is = [&](std::uint8_t value) { return seen.color == std::array{value, value, value}; };
  if ((is(0) || is(255)) && seen.brightest > 0) {
    return fmt::format(
        "the picture is {} throughout: its brightest light is {:.3g}, at an exposure of {:g} stops; try "
        "--exposure {:g}",
        is(0) ? "black" : "white", seen.brightest, scene.film.exposure, stops_to_show(seen.brightest));
  }
  return fmt::format(
      "the picture is one color throughout, #{:02x}{:02x}{:02x}: what is in view is lit evenly, or the "
      "camera is too close; move the camera back, or add `lights`",
      seen.color[0], seen.color[1], seen.color[2]);
}

}  // namespace fathom::cli
