// Estimates the cost of a plan's units: renders a few frames small and with few samples, and adds the costs of their
// pixels over the tiles.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <variant>
#include <vector>

#include "runtime/cli/plan/pixel_costs.h"
#include "runtime/cli/plan/plan_frames.h"

namespace fathom::cli {

class Pilot {
 public:
  // Renders up to three frames: the first, the middle and the last. Returns an exit code after a message on failure.
  std::optional<ExitCode> run(PlanFrames& pictures, const PlanGrid& grid, const Streams& streams);

  double frame_seconds(const PlanGrid& grid) const;  // mean over the frames, for all samples
  double start_seconds() const { return start_; }    // mean seconds to compile a frame
  double seconds() const { return seconds_; }        // duration of the pilot
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
