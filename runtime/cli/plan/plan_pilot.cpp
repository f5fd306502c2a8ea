#include "runtime/cli/plan/plan_pilot.h"

#include <algorithm>
#include <chrono>

namespace fathom::cli {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

std::optional<ExitCode> Pilot::run(PlanFrames& pictures, const PlanGrid& grid, const Streams&) {
  const double begin = now();
  const auto last = static_cast<int>(grid.frame_count()) - 1;
  std::vector<int> frames = {0, last / 2, last};
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  for (const int frame : frames) {
    const double before = now();
    const auto found = pictures.at(frame);
    if (const auto* code = std::get_if<ExitCode>(&found)) return *code;
    start_ += (now() - before) / static_cast<double>(frames.size());
    const PreparedRender& picture = *std::get<PreparedRender*>(found);
    costs_.emplace_back(picture.scene, picture.request.options, grid.width, grid.height, grid.spp);
  }
  seconds_ = now() - begin;
  return std::nullopt;
}

double Pilot::frame_seconds(const PlanGrid& grid) const {
  double sum = 0;
  for (const PixelCosts& costs : costs_) sum += costs.sum({0, 0, grid.width, grid.height});
  return sum * grid.spp / static_cast<double>(costs_.size());
}

Pilot::UnitCost Pilot::unit_cost(const PlanGrid& grid) const {
  double longest = 0;
  for (const PixelCosts& costs : costs_) {
    for (std::uint64_t unit = 0; unit < grid.units_of_frame(); unit += grid.blocks()) {
      longest = std::max(longest, costs.sum(unit_of(grid, unit).area) * grid.block);
    }
  }
  return {frame_seconds(grid) / static_cast<double>(grid.units_of_frame()), longest};
}

}  // namespace fathom::cli
