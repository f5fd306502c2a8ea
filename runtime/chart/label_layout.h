// Places point labels: each label is next to its point and overlaps nothing, or is left out.
//
// The placement is greedy in the order of the calls and takes the first free one of eight positions around the point.
// Placing the maximum number of labels is NP-hard (M. Formann, F. Wagner, "A Packing Problem with Applications to
// Lettering of Maps", 1991). Greedy placement suffices because charts have few points and callers place the most
// important labels first.
// Tested by: tests/runtime/chart/chart_plot_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

namespace fathom::runtime {

// Pixels, y downwards.
struct Rectangle {
  glm::dvec2 lo{0}, hi{0};
};
bool overlap(const Rectangle& a, const Rectangle& b);
bool meets_segment(const Rectangle& rectangle, glm::dvec2 from, glm::dvec2 to);

class LabelLayout {
 public:
  // Labels stay within `bounds`.
  explicit LabelLayout(const Rectangle& bounds) : bounds_(bounds) {}

  void block(const Rectangle& area) { blocked_.push_back(area); }
  void avoid_segment(glm::dvec2 from, glm::dvec2 to) { segments_.push_back({from, to}); }

  // Returns the area of a label of `size`, `clearance` pixels from `point`, and blocks that area for later labels.
  // Returns nullopt if no position is free. An `important` label may cover the segments to avoid if every other
  // position is taken.
  std::optional<Rectangle> place(glm::dvec2 point, double clearance, glm::dvec2 size, bool important);

 private:
  struct Segment {
    glm::dvec2 from, to;
  };
  bool is_free(const Rectangle& area, bool over_segments) const;

  Rectangle bounds_;
  std::vector<Rectangle> blocked_;
  std::vector<Segment> segments_;
};

}  // namespace fathom::runtime
