// What can be asked of a render beside the scene: every knob with its default.
//
// A knob left empty takes the scene file's value; resolve() says which values a render uses.
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

// A scene that moves, as it is while some samples of each pixel are taken.
struct Moment {
  const compiler::CompiledScene* scene;  // about the origin of the picture's own scene
  SampleRange samples;
};

struct Progress {
  double fraction;     // of the camera paths that are done, in [0,1]
  double resumed;      // the same before the render began: of what it goes on from
  std::uint64_t rays;  // marched so far
  double seconds;      // since the render began
};

// How paths find light: by looking for lights from every hit and by hitting them, weighted so that both add up; or by
// one of the two alone, to compare. Lights without a size can only be looked for.
enum class LightSampling { Both, Lights, Hits };
inline constexpr std::array<std::string_view, 3> kLightSamplingNames = {"both", "lights", "hits"};  // [LightSampling]

struct RenderOptions {
  int threads = 0;                   // 0: one per processor
  std::optional<int> width, height;  // pixels
  std::optional<PixelRect> crop;     // the part of the picture to render, not empty; the whole when not given
  std::optional<int> spp, bounces, tile;
  std::optional<std::uint64_t> seed;
  std::optional<double> far;  // scene units
  std::optional<compiler::SamplerKind> sampler;
  std::optional<compiler::FilterKind> filter;
  std::optional<double> filter_width;  // pixels; not given beside `filter`: that filter's own
  // Paths end in the dark after so many bounces, and none by roulette: biased, but what many renderers do.
  std::optional<int> cut_after;
  // Samples shared out by noise, `spp` per pixel on average, and no more for tiles whose noise is below this
  // threshold, 0 or more (runtime/film/adaptive.h). Of the whole image only: a pixel's samples depend on all other
  // pixels.
  std::optional<double> noise_threshold;
  // The same number of samples for all pixels, in place of the scene's threshold.
  bool uniform = false;
  LightSampling light_sampling = LightSampling::Both;
  // The most radiance that a light found after two bounces or more may bring, each for itself: less noise, but
  // biased, for light is lost.
  std::optional<double> clamp;
  Marching marching;
  bool regions = true;                    // build them where the scene gains by them (runtime/field/regions.h)
  std::size_t region_memory = 64u << 20;  // bytes they may take
  FilmLayers layers;
  bool profile = false;  // measure the stages' times (Stats::stages)

  // The picture that the scene's background names, when it names one (Background::Type::Image).
  std::shared_ptr<const EnvironmentImage> environment;

  // Of each pixel these samples alone, of the `spp` there are in all; films of other ranges add up to the whole. Not
  // with a noise threshold.
  std::optional<SampleRange> sample_range;
  // The scene in place of the picture's own for runs of samples, in order, which together are all there are: how a
  // shutter's time is sampled. Film and settings are those of the picture's own scene. Not with a noise
  // threshold, by which some pixels would see the first moments alone.
  std::vector<Moment> moments;
  // Where regions are looked for before they are built, and left for the next render.
  std::shared_ptr<RegionStore> region_store;
  // What an earlier render with the same settings, but for threads and tile, has done. render() takes it, and leaves
  // it empty: a film is large.
  std::shared_ptr<PartialRender> resume_from;
  // After so many seconds no unit of work is begun, except for a pixel's first sample, and render() returns what
  // there is. Regions that are not built by then are left out, except where the costs are kept, which depend on them.
  std::optional<double> time_limit;

  // Called when a unit of work is done and when it shows how much is left, by one thread at a time, from the threads
  // that render.
  std::function<void(const Progress&)> on_progress;
  // Called every kTickSeconds from a thread of its own. What it is given calls its argument with what is done so far,
  // which does not change meanwhile: threads that have finished a unit wait.
  using Look = std::function<void(const std::function<void(const PartialRender&)>&)>;
  std::function<void(const Look&)> on_tick;
  // When it becomes true, no unit of work is begun and render() returns what there is.
  const std::atomic<bool>* cancel = nullptr;
};

inline constexpr double kTickSeconds = 0.05;

// What a render uses: the scene's values under the options'.
struct Settings {
  int width, height;  // of the whole picture, pixels
  PixelRect crop;     // what of it is rendered
  int spp, bounces;
  SampleRange samples;  // of the spp
  int tile;             // pixels a side
  int threads;
  std::uint64_t seed;
  compiler::SamplerKind sampler;
  compiler::FilterKind filter;
  std::optional<double> filter_width;
  std::optional<double> far;
  std::optional<int> cut_after;
  std::optional<double> noise_threshold;  // only if spp suffices; the film then keeps layers.variance
  LightSampling light_sampling;
  std::optional<double> clamp;  // radiance
  Marching marching;
  bool regions;
  std::size_t region_memory;  // bytes
  FilmLayers layers;
  bool profile;
};

// How many stages the film may come to have (runtime/film/film.h).
inline std::size_t stages_of(const Settings& settings) {
  return settings.noise_threshold ? adaptive_stages(*settings.noise_threshold) : 1;
}

Settings resolve(const compiler::CompiledScene& scene, const RenderOptions& options);

}  // namespace fathom::runtime
