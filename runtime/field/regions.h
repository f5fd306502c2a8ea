// Regions: an octree over the scene. Each cell knows which part of the scene's program matters there, so that a point
// of a scene of a hundred thousand objects is evaluated against the few objects near it.
//
// Distances in such a scene are rounded where no surface is near (runtime/field/far_levels.h). With that rounding,
// regions give the whole program's bits at every point, in f32 and in double. An image does not depend on regions
// being used, nor on their layout. A leaf is one of two kinds:
//
//     far       all distances in the cell round to one value
//     program   the part of the program that matters in the cell, up to the highest value there
//               (vm/prune/specialise.h)
//
// Points in cells whose programs differ only in their constants are evaluated together (vm/prune/program_template.h).
//
// A step may leave the cell, and the next point then finds its own cell. The builder splits a cell until its part is
// short, or until the cell is as small as the scene's number of choices warrants. A grid replaces the top levels.
// Scenes of few choices have no regions, because regions would make them slower.
//
// Sources: Frisken et al., "Adaptively Sampled Distance Fields", 2000; Barbier et al., "Lipschitz Pruning", 2025.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "compiler/geometry/box.h"
#include "runtime/field/far_levels.h"
#include "runtime/field/region_find.h"
#include "vm/prune/program_template.h"

namespace fathom::runtime {

struct RegionOptions {
  int threads = 1;
  // Maximum size of the regions, bytes. If the regions would be larger, leaves are longer or there are no regions.
  std::size_t memory = 128u << 20;
  // Approximate number of evaluations of the field. Building the regions may not take longer than so many evaluations
  // of the whole program. If building would, leaves are longer or there are no regions.
  double evaluations = std::numeric_limits<double>::infinity();
  bool always = false;  // build regions of scenes that are as fast without, too
  int room = 0;         // the root is 2^room times as long as the scene's bounded parts
  float cancellation = 0;  // size of the numbers that cancel in the field, scene units (compiler/shapes/bounds.h)
  // Called before each cell is split, by any thread. Once the function returns true, there will be no regions.
  std::function<bool()> interrupted = {};
};

// Number of evaluations in leaves of each kind.
struct RegionCounters {
  std::uint64_t far = 0, specialised = 0;
};

// Memory that a thread needs to evaluate regions.
struct RegionScratch {
  template <class T>
  using PerPoint = std::array<T, kMaxPoints + 16>;   // whole registers are read and written
  PerPoint<std::uint32_t> point, ref;                // of the points in no far leaf: index, word of the leaf
  PerPoint<float> limit;
  std::vector<std::vector<vm::TemplateJob>> jobs;  // [template]
  std::vector<std::uint32_t> active;               // the templates that have jobs
  PerPoint<std::uint32_t> instructions;            // [point] number evaluated for the point
  RegionCounters counters;
};

class Regions;

// Memory that a thread needs to evaluate in double, one point at a time.
struct RealScratch {
  vm::Workspace workspace;
  // Parts evaluated lately, by the leaf's word. The next point often needs the same part, or another one of the same
  // ray, which is then unpacked only once.
  struct Slot {
    const Regions* of = nullptr;
    std::uint32_t ref = 0;  // word of the part's leaf
    vm::PrunedProgram part;
  };
  static constexpr int kSlotBits = 6;
  std::array<Slot, 1 << kSlotBits> slots;  // by the high bits of a product (Knuth, TAOCP 3, 1973, 6.4)
};

class Regions {
 public:
  // Builds the regions of a program whose bounded parts lie in `contents`. Returns null if the scene is too small for
  // regions (runtime/field/region_plan.h), or if they would exceed the limits of the options. The program must
  // outlive the regions.
  static std::shared_ptr<const Regions> build(const vm::Code& program, const compiler::Box& contents,
                                              const RegionOptions& options);

  // Returns the rounding of distances.
  const FarLevels& far_levels() const { return far_; }

  // Computes the rounded distances of the whole program.
  void evaluate(vm::Points points, std::size_t count, float* distance, RegionScratch& scratch,
                vm::Workspace& workspace) const;
  // Computes the rounded distance of one point in double, with the program's unrounded constants. Adds the number of
  // instructions to `instructions`.
  double evaluate(glm::dvec3 point, RealScratch& scratch, std::uint64_t& instructions) const;

  // The leaf of a point, and the part that equals the whole program there for values up to `limit`.
  struct Region {
    compiler::Box cell;  // may be unbounded
    const char* kind;
    double limit;   // for a far leaf the value to which distances round
    vm::PrunedProgram part;  // empty for a far leaf
  };
  Region region(glm::dvec3 point) const;

  // Compute gradients and surfaces of points near the surface, equal to the whole program's. At most kMaxHits points
  // per call.
  static constexpr std::size_t kMaxHits = 256;
  void evaluate_surface(vm::Points points, std::size_t count, vm::SurfaceValues out, vm::Workspace& workspace) const;
  vm::SurfaceValue evaluate_surface(glm::dvec3 point, vm::Workspace& workspace) const;
  vm::SurfaceShares evaluate_shares(glm::dvec3 point, RealScratch& scratch) const;
  vm::SurfaceShares evaluate_placed_shares(glm::dvec3 point, RealScratch& scratch) const;
  vm::SurfacePlace evaluate_place(glm::dvec3 point, RealScratch& scratch) const;

  struct Summary {
    std::size_t far = 0, programs = 0;  // numbers of leaves
    std::size_t program_templates = 0;
    std::size_t bytes = 0;
    std::size_t building = 0;  // maximum size of the parts of cells still to be split, bytes
    int levels = 0;
    double seconds = 0;  // time to build
  };
  const Summary& summary() const { return summary_; }

  enum class Kind : std::uint32_t { Inner, Far, Program };
  struct Node {
    float value;  // a leaf's limit; for a far leaf the value to which all distances in the cell round
    // Kind in the two high bits. The payload below is, for Inner, the index of the first child and, for Program, the
    // program's place in the pool or kWhole.
    std::uint32_t ref;

    Kind kind() const { return static_cast<Kind>(ref >> 30); }
    std::uint32_t payload() const { return ref & kRefPayload; }
  };
  static constexpr std::uint32_t kWhole = kRefPayload;  // payload of a leaf that needs the whole program

 private:
  friend class RegionBuilder;
  struct RegionLookup {
    Node node;
    int level;                          // the cell's level; -1 outside the root
    std::array<std::uint32_t, 3> cell;  // position in finest cells; outside the root, the face's index comes first
  };
  RegionLookup find(float x, float y, float z) const;
  void sort(vm::Points points, std::size_t near, RegionScratch& scratch) const;
  std::size_t evaluate_outside(vm::Points points, std::size_t near, float* distance, RegionScratch& scratch,
                               vm::Workspace& workspace) const;
  void evaluate_surfaces_of(const vm::PrunedProgram& part,
                            std::span<const std::pair<std::uint32_t, std::uint32_t>> same, vm::Points points,
                            vm::SurfaceValues out, vm::Workspace& workspace) const;
  void part_of(const Node& node, vm::PrunedProgram& part) const;
  vm::Code code_at(glm::dvec3 point, RealScratch& scratch) const;
  const vm::PrunedProgram& part_of(const Node& node, RealScratch& scratch) const;

  vm::Code whole_;
  vm::PrunedProgram whole_part_;
  RegionTree tree_{};
  FarLevels far_;
  std::vector<Node> nodes_;        // the nodes of the grid's cells come first
  std::array<Node, 6> outside_{};  // below and above the root on each axis, x before y before z
  std::optional<vm::Constants> constants_;
  vm::ProgramTemplates templates_;
  std::vector<std::uint32_t> pool_;  // programs of the leaves
  Summary summary_;
};

}  // namespace fathom::runtime
