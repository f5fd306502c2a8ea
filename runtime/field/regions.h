// Regions: an octree over the scene that knows what of its program matters where, so that a point of a scene of a
// hundred thousand objects meets the few that are near it.
//
// Distances in such a scene are rounded where nothing is near (runtime/field/far_levels.h), and with that regions
// give the whole program's bits at every point, in f32 and in double: a picture does not tell whether it was made
// with regions, nor which. A leaf is one of two kinds:
//
//     far       all distances in the cell round to one value
//     program   the part of the program that matters in the cell, up to the highest value there (vm/prune/specialise.h)
//
// Points in cells whose programs differ by their constants alone are evaluated together (vm/prune/skeleton.h).
//
// A step may leave the cell; the next point finds its own. A cell is split until its part is short, or it is as small
// as the scene's number of choices warrants. The top levels are a grid. Scenes of few choices have no regions: they
// would lose by them.
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
#include "vm/prune/skeleton.h"

namespace fathom::runtime {

struct RegionOptions {
  int threads = 1;
  std::size_t memory = 64u << 20;  // bytes; where they would take more, leaves are longer, or there are none
  // How often the field will be evaluated, roughly: building them is to take no longer than evaluating the whole
  // program so often. Where it would, leaves are longer, or there are none.
  double evaluations = std::numeric_limits<double>::infinity();
  bool always = false;  // of scenes that would be as fast whole, too
  int room = 0;         // the root is 2^room times as long as the scene's bounded parts
  float magnitude = 0;  // of the numbers that cancel in the field, scene units (compiler/shapes/bounds.h)
  // Asked before each cell is split, by any thread. Once it is true there will be no regions.
  std::function<bool()> interrupted = {};
};

// How often points were in leaves of each kind.
struct RegionCounters {
  std::uint64_t far = 0, specialised = 0;
};

// What a thread needs to evaluate regions.
struct RegionScratch {
  template <class T>
  using PerPoint = std::array<T, kMostPoints + 16>;  // whole registers are read and written
  PerPoint<std::uint32_t> point, ref;                // of those in no far leaf: which, the leaf
  PerPoint<float> limit;
  std::vector<std::vector<vm::SkeletonJob>> jobs;  // [skeleton]
  std::vector<std::uint32_t> met;                  // the skeletons that have any
  PerPoint<std::uint32_t> instructions;            // [point] evaluated for it
  RegionCounters counters;
};

class Regions;

// What a thread needs to evaluate in double, a point at a time.
struct RealScratch {
  vm::Workspace workspace;
  // The part that was asked last, which will be asked again: it is unpacked but once.
  const Regions* of = nullptr;
  std::uint32_t ref = 0;  // of its leaf
  vm::Part part;
};

class Regions {
 public:
  // Of a program whose bounded parts lie in `contents`; nothing when the scene is too small for regions
  // (runtime/field/region_plan.h), or they would take more than the options allow. The program must outlive them.
  static std::shared_ptr<const Regions> build(const vm::Code& program, const compiler::Box& contents,
                                              const RegionOptions& options);

  // How distances are rounded.
  const FarLevels& far_levels() const { return far_; }

  // The rounded distances of the whole program.
  void evaluate(vm::Points points, std::size_t count, float* distance, RegionScratch& scratch,
                vm::Workspace& workspace) const;
  // The same of one point in double, with the program's unrounded constants; adds to `instructions`.
  double evaluate(glm::dvec3 point, RealScratch& scratch, std::uint64_t& instructions) const;

  // The part of the program that holds at a point where its value is at most `limit`.
  struct Region {
    compiler::Box cell;  // may be unbounded
    const char* kind;
    double limit;   // of a far leaf what distances round to
    vm::Part part;  // empty of a far leaf
  };
  Region region(glm::dvec3 point) const;

  // Gradients and surfaces of points near the surface, as of the whole program; kMostHits at most at once.
  static constexpr std::size_t kMostHits = 256;
  void evaluate_surface(vm::Points points, std::size_t count, vm::SurfaceValues out, vm::Workspace& workspace) const;
  vm::SurfaceValue evaluate_surface(glm::dvec3 point, vm::Workspace& workspace) const;
  vm::SurfaceShares evaluate_shares(glm::dvec3 point, RealScratch& scratch) const;
  vm::SurfaceShares evaluate_placed_shares(glm::dvec3 point, RealScratch& scratch) const;
  vm::SurfacePlace evaluate_place(glm::dvec3 point, RealScratch& scratch) const;

  struct Facts {
    std::size_t far = 0, programs = 0;  // leaves
    std::size_t skeletons = 0;
    std::size_t bytes = 0;
    std::size_t building = 0;  // bytes of the parts of cells to be split, at most
    int levels = 0;
    double seconds = 0;  // to build
  };
  const Facts& facts() const { return facts_; }

  enum class Kind : std::uint32_t { Inner, Far, Program };
  struct Node {
    float value;  // of a leaf its limit; of a far one what all distances in the cell round to
    // Kind in the two high bits; below of Inner its first child's number, of Program where it begins in the pool, or
    // kWhole.
    std::uint32_t ref;

    Kind kind() const { return static_cast<Kind>(ref >> 30); }
    std::uint32_t payload() const { return ref & kRefPayload; }
  };
  static constexpr std::uint32_t kWhole = kRefPayload;  // the whole program

 private:
  friend class RegionBuilder;
  struct Found {
    Node node;
    int level;                          // of the cell; -1 outside the root
    std::array<std::uint32_t, 3> cell;  // in the finest cells; outside the root the face's number first
  };
  Found find(float x, float y, float z) const;
  void sort(vm::Points points, std::size_t near, RegionScratch& scratch) const;
  std::size_t settle_outside(vm::Points points, std::size_t near, float* distance, RegionScratch& scratch,
                             vm::Workspace& workspace) const;
  void evaluate_surfaces_of(std::span<const std::pair<std::uint32_t, std::uint32_t>> same, vm::Points points,
                            vm::SurfaceValues out, vm::Workspace& workspace) const;
  void part_of(const Node& node, vm::Part& part) const;
  vm::Code code_at(glm::dvec3 point, RealScratch& scratch) const;
  const vm::Part& part_of(const Node& node, RealScratch& scratch) const;

  vm::Code whole_;
  vm::Part whole_part_;
  RegionTree tree_{};
  FarLevels far_;
  std::vector<Node> nodes_;        // first those of the cells of the grid's level
  std::array<Node, 6> outside_{};  // below and above the root on each axis; x before y before z
  std::optional<vm::Constants> constants_;
  vm::Skeletons skeletons_;
  std::vector<std::uint32_t> pool_;  // of the leaves' programs
  Facts facts_;
};

}  // namespace fathom::runtime
