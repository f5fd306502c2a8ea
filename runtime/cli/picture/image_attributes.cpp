#include "runtime/cli/picture/image_attributes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "compiler/artefact/compiled_file.h"
#include "runtime/cli/options/version.h"
#include "runtime/sampling/camera.h"

namespace fathom::cli {
namespace {

// Columns of a matrix that acts on row vectors: column_along() gives the coordinate of p - eye along an axis.
using Column = glm::dvec4;
Column column_along(glm::dvec3 axis, glm::dvec3 eye) { return {axis, -glm::dot(axis, eye)}; }

runtime::Matrix4 matrix_of(const Column (&columns)[4]) {
  runtime::Matrix4 rows;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      rows[static_cast<std::size_t>(4 * row + column)] = static_cast<float>(columns[column][row]);
    }
  }
  return rows;
}

}  // namespace

runtime::Attributes image_attributes(const compiler::CompiledScene& scene, const runtime::Settings& settings) {
  const runtime::Camera camera(scene.camera, settings.width, settings.height);
  const glm::dvec3 eye = camera.position() + scene.origin;
  const Column x = column_along(camera.right(), eye), y = column_along(camera.up(), eye),
               z = column_along(camera.forward(), eye);
  using Projection = compiler::Camera::Projection;
  const bool orthographic = camera.projection() == Projection::Orthographic;
  const Column one{0, 0, 0, 1}, w = orthographic ? one : z;
  const glm::dvec2 half = camera.half_extent();
  // worldToNDC maps x and y to 0 to 1 from the left and from the bottom. In perspective the depth becomes 1 -
  // 1/depth, which is below 1 for every finite depth.
  const Column depth = orthographic ? z : z - one;
  runtime::Attributes attributes = {
      {"worldToCamera", matrix_of({x, y, z, one})},
      {"fathom.version", std::string(kVersion)},
      {"fathom.sceneHash", compiler::scene_digest(scene, false).text()},
      {"fathom.programHash", compiler::program_digest(scene).text()},
      {"fathom.seed", std::to_string(settings.seed)},
      {"fathom.exposure", static_cast<float>(scene.film.exposure)},
      {"fathom.tone", std::string(compiler::kToneCurves[static_cast<std::size_t>(scene.film.tone)])},
  };
  // A panorama has no linear projection.
  if (camera.projection() != Projection::Panorama) {
    attributes["worldToNDC"] = matrix_of({0.5 * (x / half.x + w), 0.5 * (y / half.y + w), depth, w});
  }
  std::vector<std::string> objects, materials;
  for (const compiler::Surface& surface : scene.surfaces) objects.push_back(surface.name);
  for (const compiler::Material& material : scene.materials) materials.push_back(material.name);
  attributes["fathom.objects"] = std::move(objects);
  attributes["fathom.materials"] = std::move(materials);
  return attributes;
}

void describe_samples(const runtime::PartialRender& render, runtime::Attributes& attributes) {
  const auto pixels = static_cast<double>(render.film.area().pixels());
  const int mean = static_cast<int>(std::lround(static_cast<double>(render.film.samples()) / pixels));
  attributes["samplesPerPixel"] = mean;
  attributes["fathom.sampleRange"] = fmt::format("0:{}", mean);
  if (render.covered.size() != 1) return;
  std::vector<std::string> ranges;
  for (const runtime::SampleRange range : render.covered.front().ranges()) {
    ranges.push_back(fmt::format("{}:{}", range.first, range.last));
  }
  attributes["fathom.sampleRange"] = fmt::format("{}", fmt::join(ranges, ","));
}

runtime::ToneMapping tone_in(const runtime::Attributes& attributes) {
  runtime::ToneMapping tone;
  if (const auto found = attributes.find("fathom.exposure"); found != attributes.end()) {
    if (const float* stops = std::get_if<float>(&found->second)) tone.exposure = static_cast<double>(*stops);
  }
  if (const auto found = attributes.find("fathom.tone"); found != attributes.end()) {
    const std::string* name = std::get_if<std::string>(&found->second);
    const auto& names = compiler::kToneCurves;
    const auto curve = name ? std::find(names.begin(), names.end(), *name) : names.end();
    if (curve != names.end()) tone.curve = static_cast<compiler::ToneCurve>(curve - names.begin());
  }
  return tone;
}

}  // namespace fathom::cli
