// Where labels of points go: beside their point, over nothing else, or nowhere.
//
// Greedy, in the order asked: the first of eight places round the point that is free. Finding the most labels that
// fit is NP-hard (M. Formann, F. Wagner, "A Packing Problem with Applications to Lettering of Maps", 1991); charts
// have few points, and whoever asks first matters most. Tested by: tests/runtime/chart/chart_plot_test.cpp
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

  // The area for a label of this size round `point`, `clearance` pixels from it; it is blocked from then on. An
  // `important` label may lie over the segments to avoid where there is no other place.
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
