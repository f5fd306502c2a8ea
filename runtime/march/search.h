// The search for a ray's first root as a state machine. The search asks for the field at one point at a time and is
// given the value, so that many rays can be searched side by side and one evaluation answers all of them. certify.h
// defines the root and describes how a segment is proved free.
//
//     Search search(field, origin, direction, side, stretch);
//     while (!search.done()) search.give(field.evaluate(search.point(), ...), scratch);
//
// The search depends on nothing but the field, the ray and the stretch.
// Tested by: tests/runtime/march/certify_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "runtime/field/field.h"
#include "runtime/march/ray.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

struct Certified {
  RayHit::Status status;
  int side;      // +1: searched outside, -1: inside a solid
  double t = 0;  // of the hit, in units of |direction|
  // Width of the interval that holds the first root. t is a root in this interval, bracketed far more narrowly.
  double width = 0;
  std::uint32_t evaluations = 0;
  std::uint64_t instructions = 0;  // of the field's program, over all evaluations
};

// The interval [begin, end] of a ray to be searched, with `end` finite.
struct Stretch {
  double begin, end;
  // End of an interval [begin, hint] that is guessed to hold a root and may have to grow towards 0. 0: no guess.
  double hint;
};

inline constexpr std::uint32_t kSearchBudget = 1u << 14;  // evaluations at full resolution

class Search {
 public:
  Search() = default;  // done() is true
  Search(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, const Stretch& stretch);

  bool done() const { return done_; }
  // Returns the point at which f is needed next. Only while done() is false.
  glm::dvec3 point() const { return origin_ + wanted_ * direction_; }
  // Continues with f at point(), which took so many instructions.
  void give(double f, std::uint64_t instructions, RealScratch& scratch);

  const Certified& result() const { return result_; }  // only when done()

 private:
  struct Segment {
    double a, ga, b, gb;  // gb: NaN if not yet known
    double fall, rise;    // the slope of g is within [-fall, rise]
  };
  // The part of a segment in which its end values do not exclude g < 0.
  struct Gap {
    double lo, hi;
  };
  // The bracket of a root, while it is being narrowed.
  struct Bracket {
    double lo, hi, g_lo, g_hi;
    int kept;  // +1: the last sample replaced lo; -1: hi
    int rounds;
  };
  // The purpose of the next value.
  enum class Purpose : std::uint8_t { Begin, End, Cut, Root };

  void ask(double t, Purpose purpose);
  void begin(double g);
  bool cut(double g);
  void go_on(RealScratch& scratch);
  bool settle(RealScratch& scratch);
  bool leave_behind(const Segment& s);
  bool is_still(const Segment& s) const;
  bool hides_end(const Segment& s) const;
  bool ends_solid(const Segment& s, bool still);
  void leave_solid(double level);
  double place_to_cut(const Segment& s, const Gap& gap) const;
  static Gap gap_of(const Segment& s);
  static bool is_free(const Segment& s, const Gap& gap);
  bool worth_narrowing(const Segment& s, const Gap& gap);
  enum class Told : std::uint8_t { Nothing, Slope, Free };
  Told narrow(Segment& s, RealScratch& scratch);
  void find_root(const Segment& s, double width);
  void next_of_bracket();
  void narrow_bracket(double g);
  double scale(double t) const;
  double coarsened(double resolution, double t) const;
  void hit(double lo, double hi);
  void end(RayHit::Status status);

  const Field* field_ = nullptr;
  glm::dvec3 origin_{}, direction_{};
  int side_ = 0;
  double speed_ = 0;  // largest |dg/dt|
  Stretch stretch_{};
  double back_ = 0;               // distance by which `begin` moves back next, if the hint was wrong
  std::vector<Segment> pending_;  // in order along the ray, the nearest last
  Segment now_{};                 // the nearest segment of all
  Bracket bracket_{};
  double slope_ = 0;     // slope of g over the last segment left behind
  double rounding_ = 0;  // rounding error of the field at the last point
  // Last end of a segment left behind at which g was above the rounding level of 0, and g there.
  double above_ = 0, g_above_ = 0;
  // Point at which a solid's g came down to the rounding level of 0, and g there.
  double level_from_ = std::numeric_limits<double>::quiet_NaN(), g_level_ = 0;
  double root_level_ = 0;  // value that the search in the bracket looks for
  double width_ = 0;       // width of the interval that may hold the first root, if wider than its bracket
  double wanted_ = 0;
  Purpose purpose_ = Purpose::Begin;
  bool contact_ = false, done_ = true;
  // Minimum length of a segment worth interval arithmetic, relative to the part that its near end excludes.
  double range_ratio_ = 0;
  double hopeless_ = 0;       // intervals are not expected to be informative for longer segments
  std::uint32_t dear_ = 0;    // number of evaluations between two intervals in a large scene; else 0
  std::uint32_t ask_at_ = 0;  // number of evaluations after which intervals are tried regardless
  Certified result_{};
};

}  // namespace fathom::runtime
