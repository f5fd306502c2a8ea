#include "runtime/cli/plan_pilot.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "runtime/render.h"

namespace fathom::cli {
namespace {

constexpr int kPilotWidth = 160;  // pixels
constexpr std::uint32_t kPilotSamples = 4;
constexpr double kSampleEvaluations = 8;  // that a sample costs beside its own, for shading and the film
constexpr int kLeastTile = 64;            // pixels a side

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

std::optional<ExitCode> Pilot::run(PlannedPictures& pictures, const PlanGrid& grid, const Streams&) {
  const double begin = now();
  const auto last = static_cast<int>(grid.frame_count()) - 1;
  std::vector<int> frames = {0, last / 2, last};
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  for (const int frame : frames) {
    const double before = now();
    const auto found = pictures.at(frame);
    if (const auto* code = std::get_if<ExitCode>(&found)) return *code;
    start_ += (now() - before) / static_cast<double>(frames.size());
    const Picture& picture = *std::get<Picture*>(found);
    runtime::RenderOptions options = picture.request.options;
    options.width = std::min(grid.width, kPilotWidth);
    options.height =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(grid.height) * *options.width / grid.width)));
    options.sample_range = {0, std::min(grid.spp, kPilotSamples)};
    options.layers.cost = true;
    const double start = now();
    const runtime::RenderResult result = runtime::render(picture.scene, options);
    const double seconds = now() - start;
    Costs costs{*options.width, *options.height, {}};
    double sum = 0;
    for (int y = 0; y < costs.height; ++y) {
      for (int x = 0; x < costs.width; ++x) {
        costs.seconds.push_back(result.film.means(x, y).evaluations + kSampleEvaluations);
        sum += costs.seconds.back();
      }
    }
    for (double& cost : costs.seconds) cost *= seconds / (sum * options.sample_range->size());
    samples_.push_back(std::move(costs));
  }
  seconds_ = now() - begin;
  return std::nullopt;
}

// Of a sample of all pixels in the area.
double Pilot::Costs::sum(const runtime::PixelRect& area, const PlanGrid& grid) const {
  const double across = static_cast<double>(width) / grid.width, down = static_cast<double>(height) / grid.height;
  const auto range = [](double from, double to, int length) {
    const int first = std::min(static_cast<int>(from), length - 1);
    return std::pair(first, std::clamp(static_cast<int>(std::ceil(to)), first + 1, length));
  };
  const auto [x0, x1] = range(area.x0 * across, area.x1 * across, width);
  const auto [y0, y1] = range(area.y0 * down, area.y1 * down, height);
  double sum = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x)
      sum += seconds[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  return sum / ((x1 - x0) * (y1 - y0)) * static_cast<double>(area.pixels());
}

double Pilot::frame_seconds(const PlanGrid& grid) const {
  double sum = 0;
  for (const Costs& costs : samples_) sum += costs.sum({0, 0, grid.width, grid.height}, grid);
  return sum * grid.spp / static_cast<double>(samples_.size());
}

Pilot::UnitCost Pilot::unit_cost(const PlanGrid& grid) const {
  double longest = 0;
  for (const Costs& costs : samples_) {
    for (std::uint64_t unit = 0; unit < grid.units_of_frame(); unit += grid.blocks()) {
      longest = std::max(longest, costs.sum(unit_of(grid, unit).area, grid) * grid.block);
    }
  }
  return {frame_seconds(grid) / static_cast<double>(grid.units_of_frame()), longest};
}

void cut(PlanGrid& grid, bool tiles_given, double frame_seconds, double unit_seconds) {
  const double wanted = std::max(1.0, frame_seconds / unit_seconds);
  if (!tiles_given) {
    const double most_columns = std::max(1, grid.width / kLeastTile),
                 most_rows = std::max(1, grid.height / kLeastTile);
    grid.columns =
        static_cast<int>(std::clamp(std::round(std::sqrt(wanted * grid.width / grid.height)), 1.0, most_columns));
    grid.rows = static_cast<int>(std::clamp(std::round(wanted / grid.columns), 1.0, most_rows));
  }
  const double blocks = std::round(wanted / grid.columns / grid.rows);
  grid.block =
      static_cast<std::uint32_t>(std::ceil(grid.spp / std::clamp(blocks, 1.0, static_cast<double>(grid.spp))));
}

}  // namespace fathom::cli
