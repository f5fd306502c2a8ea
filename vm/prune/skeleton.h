// Skeletons: programs without their constants.
//
// The machine runs one instruction for many points. Where every cell of a scene has a program of its own
// (runtime/field/regions.h) few points share one; but programs cut from one scene differ in little else than their
// constants. Without those many are the same, and so a lane takes a point, with the constants of the point's own
// program, and the lanes are full again.
//
//     const Constants constants(whole);                       // of all programs that are cut from it
//     std::uint32_t at = skeletons.pack(part, constants, pool);
//     evaluate_skeleton(skeletons[pool[at]], constants, pool.data(), jobs, points, distance, workspace);
//     skeletons.unpack(whole, constants, pool.data(), at, part);  // the part again
//
// A skeleton is what distances take: it has no tags, its unions are in the order of their opcodes, and small shapes
// are all one, which is another in every lane. What a part has beside that is its frame.
//
// Tested by: tests/vm/prune/skeleton_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "vm/interpret/workspace.h"
#include "vm/prune/specialise.h"

namespace fathom::vm {

// Of words that may be equal to others.
inline std::uint64_t hash_of(std::span<const std::uint32_t> words) {
  std::uint64_t hash = words.size();
  for (const std::uint32_t word : words) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 29;
  }
  return hash;
}

inline constexpr std::size_t kQuad = 4;  // floats; a row of constants is a whole number of quads

// Whether a shape is laid out as any shape: where it is moved to, its immediates, its opcode.
inline constexpr std::size_t kAnyShapeImmediates = 4;
constexpr bool can_be_any_shape(Opcode opcode, std::string_view immediates, int cost) {
  constexpr int kMostCost = 64;  // of a dear one the other lanes should be spared
  const auto count = static_cast<std::size_t>(count_names(immediates));
  return count > 0 && count <= kAnyShapeImmediates && immediates.find(':') == std::string_view::npos &&
         opcode != Opcode::Constant && cost <= kMostCost;
}

// The constants of a whole program by instruction, as the lanes want them. Where there are both spheres and boxes
// they are laid out as round boxes, which have the same distances bit for bit (but for the sign of a zero).
class Constants {
 public:
  explicit Constants(const Code& whole);

  std::uint32_t row(std::uint32_t source) const { return row_at_[source]; }  // in quads
  std::uint32_t source(std::uint32_t row) const { return source_of_[row]; }
  const float* values() const { return values_.data(); }
  std::size_t bytes() const;
  void forget_rows() { row_at_ = {}; }  // once all is packed

 private:
  Opcode laid_out(Opcode opcode) const;
  void append_any_shape(std::uint32_t word, const std::uint32_t* immediates);

  bool round_boxes_ = false;
  std::vector<float> values_;
  std::vector<std::uint32_t> row_at_;     // [word]
  std::vector<std::uint32_t> source_of_;  // [quad]
};

struct Skeleton {
  std::vector<std::uint32_t> words;  // float immediates are 0
  std::vector<double> wide;          // [word]; of one with outlines, whose constants are its own
  std::uint32_t locals, max_values, max_points, choices, instructions;
  std::vector<std::uint8_t> quads;  // of each instruction that has constants

  operator Code() const { return {words.data(), wide.data(), words.size(), locals, max_values, max_points, choices}; }
};

// The skeletons of many parts, and their frames. A part in a pool is its skeleton's number, its frame's, the rows of
// the constants of its skeleton's instructions that have any, and the places in the whole program of the others.
class Skeletons {
 public:
  // Appends the part to the pool; where it begins.
  std::uint32_t pack(const Part& part, const Constants& constants, std::vector<std::uint32_t>& pool);
  void unpack(const Code& whole, const Constants& constants, const std::uint32_t* pool, std::uint32_t at,
              Part& out) const;
  // A part that others have packed becomes one of these.
  void adopt(const Skeletons& others, std::uint32_t* pool, std::uint32_t at);

  // Asks for what evaluate_skeleton() will read of the part.
  void prefetch(const Constants& constants, const std::uint32_t* pool, std::uint32_t at) const {
    const std::size_t rows = skeletons_[pool[at]].quads.size();
    for (std::size_t i = 0; i < rows; ++i) __builtin_prefetch(constants.values() + kQuad * pool[at + 2 + i]);
  }

  const Skeleton& operator[](std::uint32_t number) const { return skeletons_[number]; }
  std::size_t size() const { return skeletons_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Frame {
    std::vector<std::uint32_t> words;  // the part's, but float immediates and tags' surfaces are 0
    std::vector<double> wide;          // [word]; of one with outlines
    std::vector<std::uint32_t> place;  // [instruction] in the pool, after the two numbers
    std::uint32_t skeleton, locals, max_values, max_points, choices;
    std::uint64_t cost;
  };
  using Index = std::unordered_multimap<std::uint64_t, std::uint32_t>;  // by hash of the words
  std::uint32_t frame_of(const Part& part);
  std::uint32_t add(Frame&& frame);
  std::uint32_t number_of(Skeleton&& skeleton);

  std::vector<Skeleton> skeletons_;
  std::vector<Frame> frames_;
  Index skeleton_at_, frame_at_;
  std::size_t bytes_ = 0;
  Frame looked_for_;
};

// A point in a program of a pool.
struct alignas(32) SkeletonJob {
  float x, y, z, most;
  std::uint32_t at, point;  // the program in the pool; which of the distances
};
// distance[job.point] = the lesser of the program's distance there and job.most, for programs of one skeleton.
void evaluate_skeleton(const Skeleton& skeleton, const Constants& constants, const std::uint32_t* pool,
                       std::span<const SkeletonJob> jobs, float* distance, Workspace& workspace);

}  // namespace fathom::vm
