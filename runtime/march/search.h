// The search for a ray's first root as a machine that asks for one value of the field at a time and is given it, so
// that many rays can be searched side by side and all their questions answered in one evaluation (certify.h, which
// says what is searched, and how a segment is proved free).
//
//     Search search(field, origin, direction, side, stretch);
//     while (!search.done()) search.give(field.evaluate(search.point(), ...), scratch);
//
// What it does depends on nothing but the field, the ray and the stretch. Tested by:
// tests/runtime/march/certify_test.cpp
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
  Arrival::Status status;
  int side;          // of the space searched, +1 or -1
  double t = 0;      // of the hit, in units of |direction|
  double width = 0;  // of what holds the first root; t is one of those in it, bracketed far more narrowly
  std::uint32_t evaluations = 0;
  std::uint64_t instructions = 0;  // of the field's program, over them
};

// Where to search: [begin, end] of a ray, `end` finite.
struct Stretch {
  double begin, end;
  double hint;  // of a root that is guessed to lie in [begin, hint], which may have to grow towards 0; else 0
};

inline constexpr std::uint32_t kSearchBudget = 1u << 14;  // evaluations at full resolution

class Search {
 public:
  Search() = default;  // done
  Search(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, const Stretch& stretch);

  bool done() const { return done_; }
  // Where f is wanted next, unless it is done.
  glm::dvec3 point() const { return origin_ + wanted_ * direction_; }
  // Goes on with f there, which took so many instructions.
  void give(double f, std::uint64_t instructions, RealScratch& scratch);

  const Certified& result() const { return result_; }  // once it is done

 private:
  struct Segment {
    double a, ga, b, gb;  // gb: NaN when it is not known yet
    double fall, rise;    // the slope of g is within [-fall, rise]
  };
  // The part of a segment that g > 0 at its ends does not exclude.
  struct Gap {
    double lo, hi;
  };
  // Of a root, as it is narrowed.
  struct Bracket {
    double lo, hi, g_lo, g_hi;
    int kept;  // +1: the last sample replaced lo; -1: hi
    int rounds;
  };
  // What the value is wanted for.
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
  void end(Arrival::Status status);

  const Field* field_ = nullptr;
  glm::dvec3 origin_{}, direction_{};
  int side_ = 0;
  double speed_ = 0;  // largest |dg/dt|
  Stretch stretch_{};
  double back_ = 0;               // how far before a hint to look next
  std::vector<Segment> pending_;  // in order along the ray, the nearest last
  Segment now_{};                 // the nearest of all
  Bracket bracket_{};
  double slope_ = 0;                // of g, over the segment that was left behind last
  double rounding_ = 0;             // of the field, at the last place that was asked for
  double above_ = 0, g_above_ = 0;  // the last end of a segment left behind where g was not level with 0, and g there
  // Where a solid's g became level with 0, and g there.
  double level_from_ = std::numeric_limits<double>::quiet_NaN(), g_level_ = 0;
  double root_level_ = 0;  // the value that is looked for within the bracket
  double width_ = 0;       // of what may hold the first root, where that is more than its bracket
  double wanted_ = 0;
  Purpose purpose_ = Purpose::Begin;
  bool contact_ = false, done_ = true;
  double range_ratio_ = 0;    // how long a segment is worth an interval
  double hopeless_ = 0;       // intervals are expected to tell nothing of longer segments
  std::uint32_t dear_ = 0;    // evaluations, between two intervals of a large scene; else 0
  std::uint32_t ask_at_ = 0;  // evaluations, at which they are asked all the same
  Certified result_{};
};

}  // namespace fathom::runtime
