// Options of a render in addition to the scene, each with its default.
//
// An empty option takes the scene file's value. resolve() returns the values that a render uses.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/base/pixel_rect.h"
#include "runtime/film/film.h"
#include "runtime/film/partial_render.h"
#include "runtime/light/environment_file.h"
#include "runtime/march/method.h"

namespace fathom::runtime {

class RegionStore;

// State of a moving scene during a range of each pixel's samples.
struct Moment {
  const compiler::CompiledScene* scene;  // with the same origin as the image's own scene
  SampleRange samples;
};

struct Progress {
  double fraction;     // share of the camera paths that are done, in [0,1]
  double resumed;      // share that was already done when a resumed render began
  std::uint64_t rays;  // rays marched so far
  double seconds;      // time since the render began
};

// How paths find light: by next-event estimation (Lights), by hitting lights (Hits), or by both with MIS weights
// (Both). Lights and Hits are for comparisons. All three find lights without a size by next-event estimation, because
// no path can hit them.
enum class LightSampling { Both, Lights, Hits };
inline constexpr std::array<std::string_view, 3> kLightSamplingNames = {"both", "lights", "hits"};  // [LightSampling]

struct RenderOptions {
  int threads = 0;                   // 0: one per processor
  std::optional<int> width, height;  // pixels
  std::optional<PixelRect> crop;     // part of the image to render, not empty; default: the whole image
  std::optional<int> spp, bounces, tile;
  std::optional<std::uint64_t> seed;
  std::optional<double> far;  // max length of a ray, scene units
  std::optional<compiler::SamplerKind> sampler;
  std::optional<compiler::FilterKind> filter;
  std::optional<double> filter_width;  // pixels; empty while `filter` is set: that filter's own width
  // Ends paths after this number of bounces instead of by Russian roulette: biased, but many renderers do this.
  std::optional<int> cut_after;
  // Enables adaptive sampling (runtime/film/adaptive.h): noisy tiles get more samples, tiles with noise below this
  // threshold (0 or more) get no more, and `spp` is the average. Only for whole images, because a pixel's samples
  // depend on all other pixels.
  std::optional<double> noise_threshold;
  // Takes the same number of samples for all pixels, ignoring the scene's threshold.
  bool uniform = false;
  LightSampling light_sampling = LightSampling::Both;
  // Max radiance of each contribution from a light found after two bounces or more. Reduces noise, but is biased,
  // because light is lost.
  std::optional<double> clamp;
  Marching marching;
  bool regions = true;                    // build regions if they make the scene faster (runtime/field/regions.h)
  std::size_t region_memory = 64u << 20;  // max size of the regions, bytes
  FilmLayers layers;
  bool profile = false;  // measure the times of stages (Stats::stages)

  // Image that the scene's background names, if its type is Background::Type::Image.
  std::shared_ptr<const EnvironmentImage> environment;

  // Takes only these samples of the `spp` samples of each pixel. Films of the other ranges add up to the film of all
  // samples. Not allowed with a noise threshold.
  std::optional<SampleRange> sample_range;
  // Scenes that replace the image's own scene for ranges of samples, in order and covering all samples. The ranges
  // sample the shutter's time. Film and settings come from the image's own scene. Not allowed with a noise threshold,
  // which would let some pixels see only the first moments.
  std::vector<Moment> moments;
  // Store in which a render looks for regions before building them, and keeps regions for the next render.
  std::shared_ptr<RegionStore> region_store;
  // State of an earlier render with equal settings, except threads and tile. render() moves the state out and leaves
  // it empty, because a film is large.
  std::shared_ptr<PartialRender> resume_from;
  // Seconds after which the render begins no unit of work, except for a pixel's first sample, and returns the samples
  // so far. The render leaves out regions that are not built by then, unless it keeps the cost layer, which depends
  // on regions.
  std::optional<double> time_limit;

  // Called by one rendering thread at a time, when a unit of work is done or the number of samples left becomes
  // known.
  std::function<void(const Progress&)> on_progress;
  // Called every kTickSeconds from a thread of its own. A Look calls its argument with the render so far, which does
  // not change during the call: threads that have finished a unit wait.
  using Look = std::function<void(const std::function<void(const PartialRender&)>&)>;
  std::function<void(const Look&)> on_tick;
  // When true, the render begins no unit of work and returns the samples so far.
  const std::atomic<bool>* cancel = nullptr;
};

inline constexpr double kTickSeconds = 0.05;

// Settings that a render uses: the options' values, else the scene's.
struct Settings {
  int width, height;  // of the whole image, pixels
  PixelRect crop;     // part of the image that is rendered
  int spp, bounces;
  SampleRange samples;  // part of the spp samples that is taken
  int tile;             // max side of a tile, pixels
  int threads;
  std::uint64_t seed;
  compiler::SamplerKind sampler;
  compiler::FilterKind filter;
  std::optional<double> filter_width;
  std::optional<double> far;
  std::optional<int> cut_after;
  std::optional<double> noise_threshold;  // sets layers.variance; empty if spp is below kMinAdaptiveSpp
  LightSampling light_sampling;
  std::optional<double> clamp;  // max radiance
  Marching marching;
  bool regions;
  std::size_t region_memory;  // max size of the regions, bytes
  FilmLayers layers;
  bool profile;
};

// Returns the number of stages that the film may get (runtime/film/film.h).
inline std::size_t stages_of(const Settings& settings) {
  return settings.noise_threshold ? adaptive_stages(*settings.noise_threshold) : 1;
}

Settings resolve(const compiler::CompiledScene& scene, const RenderOptions& options);

}  // namespace fathom::runtime
