#include "runtime/cli/picture/render_identity.h"

#include <fmt/format.h>

#include <span>
#include <type_traits>
#include <utility>

#include "compiler/artefact/compiled_file.h"
#include "runtime/cli/options/version.h"
#include "runtime/cli/picture/image_attributes.h"
#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"

namespace fathom::cli {
namespace {

std::string number(double value) { return fmt::format("{}", value); }

template <typename T>
std::string setting_text(const T& value, std::string_view) {
  if constexpr (std::is_enum_v<T>) {
    return std::string(compiler::words_of(value)[static_cast<std::size_t>(value)]);
  } else {
    return fmt::format("{}", value);
  }
}

template <typename T>
std::string setting_text(const std::optional<T>& value, std::string_view absent) {
  return value ? setting_text(*value, absent) : std::string(absent);
}

// Adds the rows of compiler/scene/settings.def.
void add_settings(const runtime::Settings& settings, runtime::Identity& identity) {
  compiler::for_each_setting([&](const auto& setting) {
    if (setting.identity.row.empty()) return;
    std::string text = setting_text(settings.*setting.member, setting.identity.absent);
    if (!text.empty()) identity.emplace_back(setting.identity.row, std::move(text));
  });
}

// Returns the horizontal field of view, or "the scene's" where the command line cannot change the field of view.
std::string view_of(const compiler::Camera& camera) {
  if (camera.projection != compiler::Camera::Projection::Perspective) return "the scene's";
  if (camera.vertical_fov || camera.focal_length) return "the scene's";
  return number(camera.fov) + " rad";
}

// Returns the camera's position and target, which depend on the command line and on the image's size.
std::string place_of(const compiler::CompiledScene& scene) {
  const glm::dvec3 from = scene.camera.position + scene.origin, to = scene.camera.target + scene.origin;
  return fmt::format("{},{},{} to {},{},{}", from.x, from.y, from.z, to.x, to.y, to.z);
}

std::string environment_of(const runtime::RenderOptions& options) {
  if (!options.environment) return "none";
  const runtime::EnvironmentMap& map = *options.environment;
  return fmt::format("{}x{} {}", map.width, map.height, map.digest.text());
}

std::string marching_of(const runtime::Marching& marching) {
  const runtime::MethodInfo& method = runtime::info(marching.method);
  std::string text(method.name);
  text += marching.precision == runtime::Precision::Double ? " f64" : " f32";
  if (method.uses_epsilon) text += fmt::format(" epsilon {} steps {}", marching.epsilon, marching.steps);
  if (marching.method == runtime::Method::Relaxed) text += fmt::format(" relaxation {}", marching.relaxation);
  return text;
}

// Returns a digest of the scenes and the cameras at all moments. The command line may change the cameras.
std::string moments_of(const std::vector<runtime::Moment>& moments) {
  vm::ByteWriter bytes;
  for (const runtime::Moment& moment : moments) {
    for (const std::string& text : {compiler::scene_digest(*moment.scene, false).text(), place_of(*moment.scene),
                                    view_of(moment.scene->camera)})
      bytes.text(text);
    bytes.u32(moment.samples.last);
  }
  return vm::digest(bytes.bytes()).text();
}

std::string layers_of(const runtime::Settings& settings) {
  const runtime::FilmLayers& kept = settings.layers;
  std::string text = "radiance";
  const auto add = [&](bool wanted, const char* name) {
    if (wanted) text += fmt::format(" {}", name);
  };
  add(kept.first_hit, "albedo depth normal");
  add(kept.position, "position");
  add(kept.ids, "ids");
  add(kept.variance, "variance");
  add(kept.halves, "halves");
  add(kept.cost, "cost");
  // Regions affect only the cost of rays: large scenes round distances alike without regions.
  if (kept.cost) text += settings.regions ? fmt::format(" (regions of {} MB)", settings.region_memory >> 20) : "";
  return text;
}

}  // namespace

runtime::Identity render_identity(const compiler::CompiledScene& scene, const runtime::Settings& settings,
                                  const runtime::RenderOptions& options) {
  runtime::Identity identity = {
      {"fathom", std::string(kVersion)},
      {"renderer", std::to_string(kRendererBits)},
      {"scene", compiler::scene_digest(scene, false).text()},
      {"program", compiler::program_digest(scene).text()},
      {"size", fmt::format("{}x{}", settings.width, settings.height)},
      {"camera", place_of(scene)},
      {"field of view", view_of(scene.camera)},
      {"background picture", environment_of(options)},
  };
  add_settings(settings, identity);
  identity.emplace_back("marching", marching_of(settings.marching));
  identity.emplace_back("layers", layers_of(settings));
  if (!scene.pieces.empty() && settings.pieces) identity.emplace_back("pieces", std::to_string(scene.pieces.size()));
  // The rows appear only with moments, so that older films without motion blur keep their identity.
  if (!options.moments.empty()) {
    identity.emplace_back("shutter times", std::to_string(options.moments.size()));
    identity.emplace_back("moments", moments_of(options.moments));
  }
  return identity;
}

runtime::FilmHeader film_header(const compiler::CompiledScene& scene, const runtime::Settings& settings,
                                const runtime::RenderOptions& options, std::optional<int> frame) {
  runtime::Identity identity = render_identity(scene, settings, options);
  if (frame) identity.emplace_back(kFrameRow, std::to_string(*frame));
  return {std::move(identity),
          image_attributes(scene, settings),
          settings.width,
          settings.height,
          settings.samples,
          scene.origin};
}

}  // namespace fathom::cli
