// Coverage: which samples of which pixels a film has, as blocks of pixels times samples.
//
// A block is a rectangle of pixels and a range of their samples. A unit of work takes a block, a sample range or a
// crop asks for a block, and no block may be in two films that are merged. canonicalise() brings blocks into a
// canonical form, which depends only on the samples they cover: rows of the image as high as they are alike, cut into
// columns as wide as they are alike, each with its ranges. Films with the same samples therefore have the same bytes,
// however they were made.
//
//     Coverage covered;
//     covered.add({{0, 0, 16, 16}, {0, 8}});
//     covered.canonicalise();
//     for (const SampleBlock& rest : covered.missing({{0, 0, 32, 16}, {0, 8}})) ...   // x from 16 on
//
// Tested by: tests/runtime/base/coverage_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/base/pixel_rect.h"

namespace fathom::runtime {

// Samples [first, last) of a pixel, by their numbers in the plan that draws them.
struct SampleRange {
  std::uint32_t first = 0, last = 0;

  std::uint32_t size() const { return last - first; }
  bool operator==(const SampleRange&) const = default;
};

struct SampleBlock {
  PixelRect area;
  SampleRange samples;

  std::uint64_t size() const { return static_cast<std::uint64_t>(area.pixels()) * samples.size(); }
  bool operator==(const SampleBlock&) const = default;
};

// Returns the intersection of two blocks; nothing when they are disjoint.
std::optional<SampleBlock> intersection(const SampleBlock& a, const SampleBlock& b);

class Coverage {
 public:
  // Every query needs a canonicalise() after the last add().
  void add(const SampleBlock& block) { blocks_.push_back(block); }
  void add(const Coverage& other);
  void canonicalise();
  bool is_canonical() const;  // looks once at each block; any blocks are allowed

  const std::vector<SampleBlock>& blocks() const { return blocks_; }
  bool empty() const { return blocks_.empty(); }
  std::uint64_t size() const;               // samples of all pixels together
  std::vector<SampleRange> ranges() const;  // samples that some pixel has, in order and disjoint

  // Returns the part of the block that is not covered, as disjoint blocks.
  std::vector<SampleBlock> missing(const SampleBlock& block) const;
  bool covers(const SampleBlock& block) const { return missing(block).empty(); }
  // Returns some block that both cover; nothing when they are disjoint.
  std::optional<SampleBlock> overlap(const Coverage& other) const;

  bool operator==(const Coverage&) const = default;

 private:
  std::vector<SampleBlock> blocks_;  // ordered by y0, then x0, then samples, once they are canonical
};

}  // namespace fathom::runtime
