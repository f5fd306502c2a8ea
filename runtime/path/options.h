// Options of a render in addition to the scene, and the settings that resolve() makes of both.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "runtime/base/pixel_rect.h"
#include "runtime/film/film.h"
#include "runtime/film/partial_render.h"
#include "runtime/light/environment_map.h"
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

using compiler::kLightSamplingNames;
using compiler::LightSampling;

// How the renderer computes, and which layers and measurements it keeps. Scene files have no such settings.
struct Execution {
  int threads = 0;  // in RenderOptions 0: one per processor
  Marching marching;
  bool regions = true;                    // build regions if they make the scene faster (runtime/field/regions.h)
  std::size_t region_memory = 128u << 20;  // max size of the regions, bytes
  bool native_code = true;                // compile programs to machine code where that pays
  // Rays meet the scene's pieces one by one (runtime/field/pieces.h), if the scene has them. The picture is then as
  // near the truth, but has other bits.
  bool pieces = true;
  FilmLayers layers;
  bool profile = false;  // measure the times of stages (Stats::stages)
};

// An empty setting takes the scene's value.
struct RenderOptions : compiler::SettingsOverrides, Execution {
  std::optional<PixelRect> crop;  // part of the image to render, not empty; default: the whole image
  // Takes the same number of samples for all pixels, ignoring the noise threshold.
  bool uniform = false;

  // Map of the image that the scene's background names, if its type is Background::Type::Image.
  std::shared_ptr<const EnvironmentMap> environment;

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
  // Seconds after which the render begins no unit of work, except for a pixel's first sample. A second later it
  // abandons the units under way, and returns the samples so far. The render leaves out regions that are not built by then, unless it keeps the cost layer, which depends
  // on regions.
  std::optional<double> time_limit;

  // Called by one rendering thread at a time, when a unit of work is done or the number of samples left becomes
  // known.
  std::function<void(const Progress&)> on_progress;
  // Called every kTickSeconds from a thread of its own. A SnapshotReader calls its argument with the render so far,
  // which does not change during the call: threads that have finished a unit wait.
  using SnapshotReader = std::function<void(const std::function<void(const PartialRender&)>&)>;
  std::function<void(const SnapshotReader&)> on_tick;
  // When true, the render begins no unit of work, abandons those under way a second later, and returns the samples so
  // far.
  const std::atomic<bool>* cancel = nullptr;
};

inline constexpr double kTickSeconds = 0.05;

// Settings that a render uses: the options' values, else the scene's. `noise_threshold` sets layers.variance, and is
// empty if spp is below kMinAdaptiveSpp.
struct Settings : compiler::Film, compiler::RenderSettings, Execution {
  PixelRect crop;       // part of the image that is rendered
  SampleRange samples;  // part of the spp samples that is taken
};

// Returns the number of stages that the film may get (runtime/film/film.h).
inline std::size_t stages_of(const Settings& settings) {
  return settings.noise_threshold ? adaptive_stages(*settings.noise_threshold) : 1;
}

Settings resolve(const compiler::CompiledScene& scene, const RenderOptions& options);

}  // namespace fathom::runtime
