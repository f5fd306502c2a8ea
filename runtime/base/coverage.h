// Which samples of which pixels a film has: blocks of pixels times samples.
//
// A block is a rectangle of pixels and a range of their samples: what a unit of work takes, what a sample range or a
// crop asks for, and what two films must not both have. tidy() brings blocks into the one form that depends only on
// what they cover: rows of the picture as high as they are alike, cut into columns as wide as they are alike, each
// with its ranges. So films that were made in different ways and have the same samples say so in the same bytes.
//
//     Coverage covered;
//     covered.add({{0, 0, 16, 16}, {0, 8}});
//     covered.tidy();
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

// What two blocks have in common; nothing when they are apart.
std::optional<SampleBlock> common(const SampleBlock& a, const SampleBlock& b);

class Coverage {
 public:
  // tidy() is due before anything is asked.
  void add(const SampleBlock& block) { blocks_.push_back(block); }
  void add(const Coverage& other);
  void tidy();
  bool is_tidy() const;  // in one look at each block, which may be any

  const std::vector<SampleBlock>& blocks() const { return blocks_; }
  bool empty() const { return blocks_.empty(); }
  std::uint64_t size() const;               // samples of all pixels together
  std::vector<SampleRange> ranges() const;  // of the samples that some pixel has, in order and apart

  // What of the block is not covered, in blocks that are apart.
  std::vector<SampleBlock> missing(const SampleBlock& block) const;
  bool covers(const SampleBlock& block) const { return missing(block).empty(); }
  // Some block that both have; nothing when they are apart.
  std::optional<SampleBlock> overlap(const Coverage& other) const;

  bool operator==(const Coverage&) const = default;

 private:
  std::vector<SampleBlock> blocks_;  // in order of y0, then x0, then samples once they are tidy
};

}  // namespace fathom::runtime
