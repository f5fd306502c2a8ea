// The path integrator: camera paths followed from hit to hit until they end.
//
// One Integrator per thread keeps its marchers full of rays (ray_queues.h). The rays that have ended go through the
// stages in batches:
//
//   camera rays  begin paths                                            camera_rays.h
//   hits         positions, surfaces and materials                      hits.h
//   media        transmittance, and the media on both sides             medium_interface.h
//   emission     light of emitters and of the background that rays hit  emission.h
//   scattering   BSDF samples, the next rays, Russian roulette          scatter.h
//   direct light next-event estimation by shadow rays                   direct_light.h
//
// A stage is a function that loops over a span of paths (path_state.h), of their vertices (vertex_batch.h) or of a
// marcher's results. Stages do not call each other: run_stages() lists them in order, and what one stage leaves to
// the next stands in the states. Light is found in two ways, by shadow rays and by the paths' own rays, with weights
// whose sum is 1 (mis.h).
//
//     Integrator integrator(context, source, sink);
//     integrator.run();
//
// Source: Kajiya, "The Rendering Equation", 1986; Veach, "Robust Monte Carlo Methods for Light Transport Simulation",
// 1997, chapters 8 and 9. Stages over batches: Laine, Karras and Aila, "Megakernels Considered Harmful: Wavefront
// Path Tracing on GPUs", 2013. Tested by: tests/runtime/render_test.cpp, tests/runtime/light/light_transport_test.cpp
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/base/stats.h"
#include "runtime/field/field.h"
#include "runtime/film/film.h"
#include "runtime/march/ray.h"
#include "runtime/path/hits.h"
#include "runtime/path/path_state.h"
#include "runtime/path/ray_queues.h"
#include "runtime/path/render_context.h"
#include "runtime/path/vertex_batch.h"

namespace fathom::runtime {

// Gives the paths to be followed.
class PathSource {
 public:
  virtual ~PathSource() = default;
  // Fills `keys` from the front with the next paths and returns their number. A smaller number than asked for means
  // that there are no more paths.
  virtual std::size_t next(std::span<PathKey> keys) = 0;
  // True if the paths under way are to be abandoned. Called between evaluations of the field.
  virtual bool is_abandoned() { return false; }
};

// Takes the samples of paths that have ended, in no order.
class SampleSink {
 public:
  virtual ~SampleSink() = default;
  // False if a sum is full.
  virtual bool add(const PathKey& key, const PathSample& sample) = 0;
};

class Integrator {
 public:
  Integrator(const RenderContext& context, PathSource& source, SampleSink& sink);

  // Follows all paths of the source to their end, unless it abandons them.
  void run();
  Stats stats() const;

 private:
  // False when the source has no more paths.
  bool start_paths();
  void process_ray_hits(std::size_t field);
  void shade_hits(std::size_t field, std::span<const RayHit> ray_hits);
  void process_shadow_hits(std::size_t field, std::span<const RayHit> ray_hits);
  void run_stages();
  void run_shadow_stages();

  // Traces the shadow rays of the batch. Paths without one continue.
  void trace_next_rays();
  void trace_path(std::uint32_t id);
  void continue_path(std::uint32_t id);  // or end it
  void retire_path(std::uint32_t id);    // and free the id

  const RenderContext& context_;
  PathSource& source_;
  SampleSink& sink_;
  RayQueues queues_;
  std::vector<PathState> paths_;        // [id]
  std::vector<ShadowRay> shadow_rays_;  // [id], if surfaces may let light straight through; else empty
  std::vector<std::uint32_t> free_ids_, ended_ids_;
  std::vector<RayHit> ray_hits_, grouped_;  // scratch
  std::unique_ptr<VertexBatch> batch_;      // scratch
  RealScratch scratch_;
  Stats stats_;
};

}  // namespace fathom::runtime
