// What the units of a plan will cost: a few frames are rendered small, with few samples, and what each pixel cost is
// added up over the tiles.
// Tested by: tests/runtime/cli_plan_test.cpp
#pragma once

#include <variant>
#include <vector>

#include "runtime/cli/planned_picture.h"
#include "runtime/float_image.h"

namespace fathom::cli {

class Pilot {
 public:
  // Renders up to three frames: the first, the one in the middle and the last. An ExitCode after a message.
  std::optional<ExitCode> run(PlannedPictures& pictures, const PlanGrid& grid, const Streams& streams);

  double frame_seconds(const PlanGrid& grid) const;  // of all samples of a frame, on average
  double start_seconds() const { return start_; }    // of compiling a frame, on average
  double seconds() const { return seconds_; }        // that the pilot took
  std::size_t frames() const { return samples_.size(); }

  struct UnitCost {
    double mean, longest;  // seconds
  };
  UnitCost unit_cost(const PlanGrid& grid) const;

 private:
  // Seconds that a sample of each pixel takes, of a small picture.
  struct Costs {
    int width, height;
    std::vector<double> seconds;

    double sum(const runtime::PixelRect& area, const PlanGrid& grid) const;
  };

  std::vector<Costs> samples_;
  double start_ = 0, seconds_ = 0;
};

// Cuts such that a unit takes about so many seconds: tiles first, which add nothing to what is written, down to 64
// pixels a side, unless they are given; blocks of samples then, each of which is written as a film of its own.
void cut(PlanGrid& grid, bool tiles_given, double frame_seconds, double unit_seconds);

}  // namespace fathom::cli
