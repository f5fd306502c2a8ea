// What the units of a plan will cost: a few frames are rendered small, with few samples, and what each pixel cost is
// added up over the tiles.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <variant>
#include <vector>

#include "runtime/cli/plan/pixel_costs.h"
#include "runtime/cli/plan/planned_picture.h"

namespace fathom::cli {

class Pilot {
 public:
  // Renders up to three frames: the first, the one in the middle and the last. An ExitCode after a message.
  std::optional<ExitCode> run(PlannedPictures& pictures, const PlanGrid& grid, const Streams& streams);

  double frame_seconds(const PlanGrid& grid) const;  // of all samples of a frame, on average
  double start_seconds() const { return start_; }    // of compiling a frame, on average
  double seconds() const { return seconds_; }        // that the pilot took
  std::size_t frames() const { return costs_.size(); }

  struct UnitCost {
    double mean, longest;  // seconds
  };
  UnitCost unit_cost(const PlanGrid& grid) const;

 private:
  std::vector<PixelCosts> costs_;
  double start_ = 0, seconds_ = 0;
};

}  // namespace fathom::cli
