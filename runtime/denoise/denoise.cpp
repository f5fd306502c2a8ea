#include "runtime/denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vm/program/check.h"
#ifdef FATHOM_OIDN
#include <OpenImageDenoise/oidn.hpp>
#else
#include "runtime/denoise/nl_means.h"
#endif

namespace fathom::runtime {
namespace {

std::size_t pixels_of(const DenoiseInput& input) {
  return static_cast<std::size_t>(input.width) * static_cast<std::size_t>(input.height);
}

#ifdef FATHOM_OIDN

// Open Image Denoise 1.4 to 2: radiance, albedo and normals in, radiance out, in memory of the library's device.
std::vector<float> filter(const DenoiseInput& input, int threads, const std::function<bool()>&) {
  oidn::DeviceRef device = oidn::newDevice(oidn::DeviceType::CPU);
  device.set("numThreads", threads);
  device.commit();
  const std::size_t pixels = pixels_of(input), bytes = 3 * pixels * sizeof(float);
  oidn::FilterRef filter = device.newFilter("RT");
  const auto image = [&](const char* name) {
    oidn::BufferRef buffer = device.newBuffer(bytes);
    filter.setImage(name, buffer, oidn::Format::Float3, static_cast<std::size_t>(input.width),
                    static_cast<std::size_t>(input.height));
    return static_cast<float*>(buffer.getData());
  };
  float* const color = image("color");
  for (std::size_t i = 0; i < 3 * pixels; ++i) {
    const float mean = (input.first[i] + input.second[i]) / 2;
    color[i] = std::isfinite(mean) ? mean : 0;
  }
  std::copy(input.albedo.begin(), input.albedo.end(), image("albedo"));
  std::copy(input.normal.begin(), input.normal.end(), image("normal"));
  const float* const output = image("output");
  filter.set("hdr", true);
  filter.commit();
  filter.execute();
  const char* problem = nullptr;
  CHECK(device.getError(problem) == oidn::Error::None, "Open Image Denoise failed");
  return {output, output + 3 * pixels};
}

#else

// Light is smoother than the texture it falls on, so radiance is filtered per albedo, except on black surfaces.
constexpr float kMinAlbedo = 0.05f;
float divisor(float albedo) { return std::isfinite(albedo) ? std::max(albedo, kMinAlbedo) : 1; }

float finite(float value) { return std::isfinite(value) ? value : 0; }

NlMeansInput plane_by_plane(const DenoiseInput& input) {
  NlMeansInput planes{input.width, input.height, {}, {}, {}, {}};
  const std::size_t pixels = pixels_of(input);
  for (std::size_t i = 0; i < pixels; ++i) {
    bool valid = true;
    for (std::size_t c = 0; c < 3; ++c) valid &= std::isfinite(input.first[3 * i + c] + input.second[3 * i + c]);
    planes.valid.push_back(valid ? 1 : 0);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = 3 * i + c;
      const float scale = divisor(input.albedo[at]);
      planes.copies[0][c].push_back(valid ? input.first[at] / scale : 0);
      planes.copies[1][c].push_back(valid ? input.second[at] / scale : 0);
      planes.features[c].push_back(finite(input.albedo[at]));
      planes.features[3 + c].push_back(finite(input.normal[at]));
    }
    planes.depth.push_back(finite(input.depth[i]));
  }
  return planes;
}

std::vector<float> filter(const DenoiseInput& input, int threads, const std::function<bool()>& is_cancelled) {
  const std::array<Plane, 3> light = nl_means(plane_by_plane(input), threads, is_cancelled);
  std::vector<float> radiance(3 * pixels_of(input));
  for (std::size_t at = 0; at < radiance.size(); ++at)
    radiance[at] = light[at % 3][at / 3] * divisor(input.albedo[at]);
  return radiance;
}

#endif

std::vector<float> checked_filter(const DenoiseInput& input, int threads, const std::function<bool()>& is_cancelled) {
  const std::size_t pixels = pixels_of(input);
  CHECK(input.first.size() == 3 * pixels && input.second.size() == 3 * pixels && input.albedo.size() == 3 * pixels &&
            input.normal.size() == 3 * pixels && input.depth.size() == pixels,
        "the denoiser's pictures differ in size");
  return filter(input, threads, is_cancelled);
}

}  // namespace

std::vector<float> denoise(const DenoiseInput& input, int threads) { return checked_filter(input, threads, nullptr); }

bool denoise(Film& film, int threads, const std::function<bool()>& is_cancelled) {
  CHECK(film.layers().first_hit && film.layers().halves, "the film lacks what the denoiser needs");
  std::vector<float> first, second, albedo, normal, depth;
  const auto append = [](std::vector<float>& to, glm::dvec3 value) {
    for (int i = 0; i < 3; ++i) to.push_back(static_cast<float>(value[i]));
  };
  const PixelRect area = film.area();
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const PixelMeans pixel = film.means(x, y);
      append(first, pixel.halves[0]);
      append(second, pixel.halves[1]);
      const double missed = pixel.samples > 0 ? 1 - static_cast<double>(pixel.hits) / pixel.samples : 1;
      append(albedo, pixel.albedo + missed);
      append(normal, pixel.normal);
      depth.push_back(static_cast<float>(pixel.depth));
    }
  }
  std::vector<float> radiance =
      checked_filter({film.width(), film.height(), first, second, albedo, normal, depth}, threads, is_cancelled);
  if (is_cancelled && is_cancelled()) return false;
  film.set_denoised(std::move(radiance));
  return true;
}

}  // namespace fathom::runtime
