// The search for a ray's first root as a state machine. The search asks for the field at one point at a time and is
// given the value, so that many rays can be searched side by side and one evaluation answers all of them. certify.h
// defines the root and describes how a segment is proved free.
//
//     CertifiedSearch search(field, origin, direction, side, interval);
//     while (!search.done()) search.supply(field.evaluate(search.point(), ...), scratch);
//
// The search depends only on the field, the ray and the interval.
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

struct CertifiedResult {
  RayHit::Status status;
  int side;      // +1: searched outside, -1: inside a solid
  double t = 0;  // of the hit, in units of |direction|
  // Width of the interval that holds the first root. t is a root in this interval, bracketed far more narrowly.
  double width = 0;
  std::uint32_t evaluations = 0;
  std::uint64_t instructions = 0;  // of the field's program, over all evaluations
};

// The interval [begin, end] of a ray to be searched, with `end` finite.
struct RayInterval {
  double begin, end;
  // End of an interval [begin, hint] that is guessed to hold a root and may have to grow towards 0. 0: no guess.
  double hint;
};

// In a solid, g within kLevelRoundings rounding errors of 0 is a surface if it stays there for longer than
// kMinLevel max(1, |p|). Otherwise two parts of the solid touch there.
inline constexpr double kLevelRoundings = 4, kMinLevel = 0x1p-20;

inline constexpr std::uint32_t kSearchBudget = 1u << 14;  // evaluations at full resolution

class CertifiedSearch {
 public:
  CertifiedSearch() = default;  // done() is true
  CertifiedSearch(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, const RayInterval& interval);

  bool done() const { return done_; }
  // Returns the point at which f is needed next. Only while done() is false.
  glm::dvec3 point() const { return origin_ + requested_t_ * direction_; }
  // Continues with f at point(), which took so many instructions.
  void supply(double f, std::uint64_t instructions, RealScratch& scratch);

  const CertifiedResult& result() const { return result_; }  // only when done()

 private:
  struct Segment {
    double a, ga, b, gb;  // gb: NaN if not yet known
    double fall, rise;    // the slope of g is within [-fall, rise]
    double ra = 0, rb = 0;  // g >= 0 within these lengths of the ends, by the field's bounds in cells
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
  enum class Purpose : std::uint8_t { Begin, End, Split, Root };

  void request(double t, Purpose purpose);
  void begin(double g);
  bool split(double g);
  void advance(RealScratch& scratch);
  bool process_segment(RealScratch& scratch);
  bool pass_segment(const Segment& s);
  bool is_flat(const Segment& s) const;
  bool may_hide_end(const Segment& s) const;
  bool ends_solid(const Segment& s, bool flat);
  void leave_solid(double level);
  double split_point(const Segment& s, const Gap& gap) const;
  static Gap gap_of(const Segment& s);
  static bool is_free(const Segment& s, const Gap& gap);
  bool worth_narrowing(const Segment& s, const Gap& gap);
  enum class IntervalOutcome : std::uint8_t { Nothing, Slope, Free };
  IntervalOutcome narrow(Segment& s, RealScratch& scratch);
  void find_root(const Segment& s, double width);
  void continue_bracket();
  void narrow_bracket(double g);
  double scale(double t) const;
  double coarsened(double resolution, double t) const;
  void hit(double lo, double hi);
  void end(RayHit::Status status);

  const Field* field_ = nullptr;
  glm::dvec3 origin_{}, direction_{};
  int side_ = 0;
  double speed_ = 0;      // |direction|
  double max_slope_ = 0;  // largest |dg/dt|
  RayInterval interval_{};
  double backtrack_ = 0;          // distance by which `begin` moves back next, if the hint was wrong
  std::vector<Segment> pending_;  // in order along the ray, the nearest last
  Segment current_{};             // the nearest segment of all
  Bracket bracket_{};
  double slope_ = 0;     // slope of g over the last segment left behind
  double rounding_ = 0;  // rounding error of the field at the last point
  double radius_ = 0;    // length about the last point within which g >= 0, by the field's bounds in cells
  // Last end of a segment left behind at which g was above the rounding level of 0, and g there.
  double above_ = 0, g_above_ = 0;
  // Point at which a solid's g came down to the rounding level of 0, and g there.
  double level_begin_ = std::numeric_limits<double>::quiet_NaN(), g_level_ = 0;
  double root_level_ = 0;  // value that the search in the bracket looks for
  double width_ = 0;       // width of the interval that may hold the first root, if wider than its bracket
  double undefined_from_ = std::numeric_limits<double>::infinity();  // nearest t at which the field had no value
  double requested_t_ = 0;
  Purpose purpose_ = Purpose::Begin;
  bool near_miss_ = false, done_ = true;
  // Minimum length of a segment worth interval arithmetic, relative to the part that its near end excludes.
  double range_ratio_ = 0;
  double max_informative_ = 0;          // intervals are not expected to be informative for longer segments
  std::uint32_t interval_period_ = 0;   // number of evaluations between two intervals in a large scene; else 0
  std::uint32_t next_interval_at_ = 0;  // number of evaluations after which intervals are tried regardless
  CertifiedResult result_{};
};

}  // namespace fathom::runtime
