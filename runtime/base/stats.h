// What a render counted, and how to print it.
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

// Counts of marching alone; each worker has its own.
struct MarchCounters {
  std::uint64_t rays = 0;
  // How they ended.
  std::uint64_t hits = 0;
  std::uint64_t misses = 0;
  std::uint64_t contacts = 0;  // misses that came nearer to a surface than double resolves
  std::uint64_t invalid = 0;   // rays that saw a distance that is not finite, or had no direction
  // Which tier said so; the others were decided in float.
  std::uint64_t clipped = 0;                // never came into the scene's bound
  std::uint64_t certified = 0;              // decided in double (runtime/march/certify.h)
  std::uint64_t exhausted = 0;              // misses of a method that gives rays up (runtime/march/method.h)
  std::uint64_t evaluations = 0;            // of the field, float and double
  std::uint64_t certified_evaluations = 0;  // those in double, part of `evaluations`
  std::uint64_t instructions = 0;           // of the field's program, over all evaluations
  std::uint64_t lanes = 0;                  // of the machine, taken by the other evaluations: whole registers
  // Of the evaluations in float, those in each kind of region (runtime/field/regions.h).
  std::uint64_t region_far = 0, region_programs = 0;

  // Of the places where the distance was not finite, in the programs' coordinates, the least in the order of x, y, z:
  // the same for any number of threads.
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
  std::uint64_t primary_hits = 0;      // those that met a surface
  std::uint64_t shadow_rays = 0;       // towards lights that were looked for
  std::uint64_t bounce_rays = 0;       // by which paths go on after a hit: all the others
  std::uint64_t dropped_samples = 0;   // paths whose radiance was not finite; they count as black
  std::uint64_t saturated = 0;         // paths that overfilled a pixel's sum
  std::uint64_t lit_samples = 0;       // paths that brought light
  std::uint64_t faint_samples = 0;     // those of them that the film cannot hold to a hundredth (kFaintLight)
  std::optional<StageSeconds> stages;  // of all threads together; when asked for (RenderOptions::profile)
  std::uint64_t peak_memory = 0;       // bytes, of the whole process until now; 0: not known
  std::uint64_t region_bytes = 0;      // that the scene's regions take; 0: it has none
  double region_seconds = 0;           // to build them, part of `seconds`
  std::uint64_t regions_kept = 0;      // how often they were those of a render or a moment before
  double seconds = 0;                  // wall clock
  int threads = 0;
  std::uint64_t resumed_samples = 0;  // of all pixels, that the render went on from
  std::uint64_t checkpoints = 0;      // written
  RenderEnd end = RenderEnd::Done;

  void merge(const Stats& other);  // the counts and stages; not memory, regions, seconds, threads
  double evaluations_per_ray() const;
  double instructions_per_evaluation() const;
  // The share of the machine's lanes that held a ray, in [0,1]; 1 when none was taken. The search in double is no
  // part of it.
  double utilisation() const;
  double rays_per_second() const;
};

// The most memory the process has held at once so far, bytes; 0 where the system does not say.
std::uint64_t peak_memory();

std::string to_table(const Stats& stats);  // for people; lines end with '\n'
std::string to_json(const Stats& stats);   // one object; ends with '\n'

}  // namespace fathom::runtime
