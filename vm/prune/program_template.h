// Program templates: programs without their constants.
//
// The interpreter runs one instruction for many points. If every cell of a scene has its own program
// (runtime/field/regions.h), few points share a program. But programs pruned from one scene differ in little else
// than their constants, and without these many programs are the same. So each lane takes a point and the constants of
// the point's own program, and the lanes are full again.
//
//     const Constants constants(whole);                       // of all programs that are pruned from `whole`
//     std::uint32_t at = templates.pack(part, constants, pool);
//     evaluate_template(templates[pool[at]], constants, pool.data(), jobs, distance, workspace);
//     templates.unpack(whole, constants, pool.data(), at, part);  // restores the part
//
// A template has only what distances need: it has no tags, its unions are sorted by opcode, and all small shapes
// become one instruction that evaluates a different shape in every lane, with the affine map of its point. The rest
// of a pruned program is its remainder.
//
// Tested by: tests/vm/prune/program_template_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "vm/interpret/points.h"
#include "vm/interpret/workspace.h"
#include "vm/prune/specialise.h"

namespace fathom::vm {

// Hash of words, to find equal words.
inline std::uint64_t hash_of(std::span<const std::uint32_t> words) {
  std::uint64_t hash = words.size();
  for (const std::uint32_t word : words) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 29;
  }
  return hash;
}

inline constexpr std::size_t kQuad = 4;  // floats; a row of constants is an integer number of quads

// True if a shape can be laid out as a polymorphic shape (kPolymorphic): its translation, up to
// kPolymorphicImmediates immediates, its opcode. A shape that costs nothing is a number of a formula.
inline constexpr std::size_t kPolymorphicImmediates = 4;
constexpr bool can_be_polymorphic(std::string_view immediates, int cost) {
  constexpr int kMaxCost = 64;  // expensive shapes are excluded, because all lanes would wait for them
  const auto count = static_cast<std::size_t>(count_names(immediates));
  return count > 0 && count <= kPolymorphicImmediates && !has_integers(immediates) && cost > 0 && cost <= kMaxCost;
}

// Constants of a whole program by instruction, in the layout that lanes load. In a program with both spheres and
// boxes, these are laid out as round boxes, which have the same distances bit for bit (except for the sign of a
// zero). In a program many of whose small shapes have affine maps, the first row is the identity, the map of the
// other small shapes.
class Constants {
 public:
  static constexpr std::uint32_t kIdentity = 0;  // its row

  explicit Constants(const Code& whole);

  // True if templates have placed shapes (kPlaced).
  bool placed() const { return placed_; }

  // Converts the offset of an opcode word to the row of its constants, in quads, and back.
  std::uint32_t row(std::uint32_t source) const { return row_at_[source]; }
  std::uint32_t source(std::uint32_t row) const { return source_of_[row]; }
  const float* values() const { return values_.data(); }
  std::size_t bytes() const;
  void forget_rows() { row_at_ = {}; }  // frees memory; call after the last pack()

 private:
  Opcode laid_out(Opcode opcode) const;
  void append_identity();
  void append_polymorphic(std::uint32_t word, const std::uint32_t* immediates);

  bool round_boxes_ = false, placed_ = false;
  std::vector<float> values_;
  std::vector<std::uint32_t> row_at_;     // [word]
  std::vector<std::uint32_t> source_of_;  // [quad]
};

struct ProgramTemplate {
  std::vector<std::uint32_t> words;  // without float immediates, except those beside integers, which are 0
  std::vector<double> doubles;       // [word] constants of outlines, which belong to the template; else empty
  std::uint32_t locals, max_values, max_points, choices, instructions;
  std::vector<std::uint8_t> quads;  // number of quads of each row of constants, in the order of the instructions

  operator Code() const {
    return {words.data(), doubles.data(), words.size(), locals, max_values, max_points, choices};
  }
};

// Returns the template of a whole program without tags. Programs that differ in nothing but constants have one
// template.
ProgramTemplate template_of(const VerifiedProgram& program);
// Returns the number of constants of a row, and the constants of a program for its template, one row: each
// instruction's begin at a multiple of kQuad.
std::size_t constants_in(const ProgramTemplate& program_template);
std::vector<float> constants_of(const Code& program);

// Distance between the constants' rows of evaluate_rows(), in floats: a cache line more than the lanes, because rows
// a power of two apart would compete for the same few cache lines.
inline constexpr std::size_t kMaxRowLanes = 768, kRowStride = kMaxRowLanes + 16;
// Computes the distance of each point, at most kMaxRowLanes of them, by the template with the point's own constants:
// [constant][point]. All arrays are read and written in whole registers.
void evaluate_rows(const ProgramTemplate& program_template, Points points, std::size_t count, const float* constants,
                   float* distance, Workspace& workspace);

// Templates and remainders of many pruned programs. A part in a pool consists of its template's number, its
// remainder's number, the rows of constants of the template's instructions that have constants (two of a placed
// shape, its map's and its own), and the offsets in the whole program of the part's other instructions.
class ProgramTemplates {
 public:
  // Appends the part to the pool. Returns the index of its first entry.
  std::uint32_t pack(const PrunedProgram& part, const Constants& constants, std::vector<std::uint32_t>& pool);
  void unpack(const Code& whole, const Constants& constants, const std::uint32_t* pool, std::uint32_t at,
              PrunedProgram& out) const;
  // Renumbers a part that `others` packed, so that it refers to the templates and remainders of this object.
  void renumber(const ProgramTemplates& others, std::uint32_t* pool, std::uint32_t at);

  // Prefetches the constants of the part that evaluate_template() will read.
  void prefetch(const Constants& constants, const std::uint32_t* pool, std::uint32_t at) const {
    const std::size_t rows = templates_[pool[at]].quads.size();
    for (std::size_t i = 0; i < rows; ++i) __builtin_prefetch(constants.values() + kQuad * pool[at + 2 + i]);
  }

  const ProgramTemplate& operator[](std::uint32_t number) const { return templates_[number]; }
  std::size_t size() const { return templates_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Remainder {
    std::vector<std::uint32_t> words;  // the part's, without what the whole program knows, as in the template
    std::vector<double> doubles;       // [word] constants of outlines; empty without outlines
    std::vector<std::uint32_t> place;  // [instruction] index of its entry in the pool, after the two numbers
    std::uint32_t entries;             // in the pool, after the two numbers
    std::uint32_t program_template, locals, max_values, max_points, choices;
  };
  using Index = std::unordered_multimap<std::uint64_t, std::uint32_t>;  // by hash of the words
  std::uint32_t remainder_of(const PrunedProgram& part, bool placed);
  std::uint32_t add(Remainder&& remainder);
  std::uint32_t number_of(ProgramTemplate&& program_template);

  std::vector<ProgramTemplate> templates_;
  std::vector<Remainder> remainders_;
  Index template_at_, remainder_at_;
  std::size_t bytes_ = 0;
  Remainder wanted_;
};

// A point to evaluate, and its program.
struct alignas(32) TemplateJob {
  float x, y, z, most;
  std::uint32_t at, point;  // index of the program in the pool; index of the result in `distance`
};
// Computes distance[job.point] = min(distance of the job's program at x, y, z, job.most). All programs have the
// template `program_template`.
void evaluate_template(const ProgramTemplate& program_template, const Constants& constants, const std::uint32_t* pool,
                       std::span<const TemplateJob> jobs, float* distance, Workspace& workspace);

}  // namespace fathom::vm
