// Counts of a render, and how to print them.
// Tested by: tests/runtime/base/stats_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/base/stage_clock.h"

namespace fathom::runtime {

// Counts of marching alone. Each worker has its own.
struct MarchCounters {
  std::uint64_t rays = 0;
  // Outcomes of the rays.
  std::uint64_t hits = 0;
  std::uint64_t misses = 0;
  std::uint64_t near_misses = 0;  // misses that came nearer to a surface than double resolves
  std::uint64_t invalid = 0;   // rays that met a distance that is not finite, or had no direction
  // Tiers that decided rays. All other rays were decided in float.
  std::uint64_t clipped = 0;                // never came into the scene's bound
  std::uint64_t certified = 0;              // decided in double (runtime/march/certify.h)
  std::uint64_t exhausted = 0;              // misses of a method that gives rays up (runtime/march/method.h)
  std::uint64_t evaluations = 0;            // of the field, float and double
  std::uint64_t certified_evaluations = 0;  // in double, part of `evaluations`
  std::uint64_t instructions = 0;           // of the field's program, over all evaluations
  std::uint64_t lanes = 0;                  // of the machine, in whole registers, used by the evaluations in float
  // Float evaluations in each kind of region (runtime/field/regions.h).
  std::uint64_t region_far = 0, region_programs = 0;

  // Least of the points, in the order of x, y, z, where the distance was not finite. The order makes it the same for
  // any number of threads. In the programs' coordinates.
  std::optional<glm::dvec3> invalid_at;

  void note_invalid(glm::dvec3 at);
  void merge(const MarchCounters& other);
};

// Why a render ended.
enum class RenderEnd : std::uint8_t { Done, Noise, TimeLimit, Cancelled };
inline constexpr std::array<std::string_view, 4> kRenderEnds = {"all samples taken", "noise below limit",
                                                                "time limit", "interrupted"};  // [RenderEnd]

struct Stats {
  MarchCounters march;
  std::uint64_t primary_rays = 0;      // camera rays
  std::uint64_t primary_hits = 0;      // camera rays that hit a surface
  std::uint64_t shadow_rays = 0;       // of next-event estimation
  std::uint64_t bounce_rays = 0;       // all other rays: they continue paths after a hit
  std::uint64_t dropped_samples = 0;   // paths whose radiance was not finite; they count as black
  std::uint64_t saturated = 0;         // paths that overfilled a pixel's sum
  std::uint64_t lit_samples = 0;       // paths that carry light
  std::uint64_t faint_samples = 0;     // lit paths that the film cannot hold to a hundredth (kFaintLight)
  std::optional<StageSeconds> stages;  // of all threads together; only with RenderOptions::profile
  std::uint64_t peak_memory = 0;       // bytes, of the whole process until now; 0: not known
  std::uint64_t region_bytes = 0;      // bytes of the scene's regions; 0: no regions
  double region_seconds = 0;           // time to build the regions, part of `seconds`
  std::uint64_t regions_reused = 0;    // how often an earlier render or moment's regions were used again
  double seconds = 0;                  // wall clock
  int threads = 0;
  std::uint64_t resumed_samples = 0;  // samples of all pixels that a resumed render began with
  std::uint64_t checkpoints = 0;      // number of checkpoints written
  RenderEnd end = RenderEnd::Done;

  void merge(const Stats& other);  // adds the counts and stages; not memory, regions, seconds, threads
  double evaluations_per_ray() const;
  double instructions_per_evaluation() const;
  // Share of the machine's lanes that held a ray, in [0,1]; 1 when no lane was used. Excludes the search in double.
  double utilisation() const;
  double rays_per_second() const;
};

// Returns the peak memory of the process so far, bytes; 0 where the system does not say.
std::uint64_t peak_memory();

std::string to_table(const Stats& stats);  // for people; lines end with '\n'
std::string to_json(const Stats& stats);   // one object; ends with '\n'

}  // namespace fathom::runtime
