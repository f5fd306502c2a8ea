#include "runtime/field/region_forecast.h"

#include <algorithm>
#include <glm/common.hpp>

#include "runtime/sampling/even_steps.h"

namespace fathom::runtime {
namespace {

constexpr std::size_t kSamples = vm::kEnclosedBoxes;
// Leaves may be n times longer than normal if the whole program has at least n times this many choices.
constexpr std::size_t kWorthShorter = 64;
// Regions must save at least this share of the evaluations' cost.
constexpr double kLeastGain = 0.5;

}  // namespace

RegionSurvey::RegionSurvey(const vm::PrunedProgram& whole, const SplitRules& rules, RegionBudget& budget)
    : options_(rules.options),
      levels_(rules.tree.levels),
      choices_(std::max(1.0, static_cast<double>(whole.choices))),
      instructions_(static_cast<double>(whole.sources.size())),
      cells_(static_cast<std::size_t>(levels_) + 1) {
  RegionSplitter splitter(rules, budget);
  std::array<glm::dvec3, kSamples> points;
  for (std::size_t i = 0; i < kSamples; ++i) points[i] = glm::fract((static_cast<double>(i) + 0.5) * kEvenSteps);
  for (int level = 0; level <= levels_; ++level) {
    const RegionSplitter::CellFacts facts = splitter.bound_cells(whole, points, level);
    for (std::size_t i = 0; i < kSamples; ++i) {
      cells_[static_cast<std::size_t>(level)][i] = {facts.far[i], facts.choices[i]};
    }
  }
}

double RegionSurvey::cost(const RegionTree& tree, std::size_t instructions) {
  return static_cast<double>(tree.levels + 1) * static_cast<double>(instructions);
}

double RegionSurvey::length_of(std::uint32_t choices) const {
  return std::max(1.0, instructions_ * (choices + 1.0) / (choices_ + 1.0));
}

// Follows each sample point down to its leaf, by the rules of the splitter.
RegionForecast RegionSurvey::forecast(std::uint32_t choice_factor) const {
  RegionForecast result{choice_factor, 0, 0};
  double leaves = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    int unshortened = 0;
    double cells = 1.0 / kSamples, parent = instructions_;  // cells: that the sample stands for
    for (int level = 0; level <= levels_; ++level, cells *= 8) {
      const Cell& cell = cells_[static_cast<std::size_t>(level)][i];
      if (cell.far) break;
      const double length = length_of(cell.choices);
      unshortened = length < kShorterPart * parent || level <= options_.room ? 0 : unshortened + 1;
      parent = length;
      if (cell.choices <= choice_factor * kLeafChoices || level == levels_ || unshortened > kMaxIdle) {
        result.length += length, ++leaves;
        break;
      }
      result.work += cells * length;
    }
  }
  if (leaves > 0) result.length /= leaves;
  return result;
}

bool allows_leaves(std::uint32_t choice_factor, std::size_t choices) {
  return choice_factor == 1 || choice_factor * kWorthShorter <= choices;
}

// Returns the cost of building and evaluating, or that of an evaluation if building does not count.
double RegionSurvey::cost_of(const RegionForecast& forecast) const {
  const double each = kLookupCost + kLeafCost * forecast.length;
  return is_limited() ? kCutCost * forecast.work + options_.evaluations * each : each;
}

bool RegionSurvey::pays(const RegionForecast& forecast) const {
  return !is_limited() || cost_of(forecast) <= (1 - kLeastGain) * options_.evaluations * instructions_;
}

std::optional<RegionForecast> RegionSurvey::best() const {
  std::optional<RegionForecast> best;
  for (std::uint32_t factor = 1; allows_leaves(factor, static_cast<std::size_t>(choices_)); factor *= 2) {
    const RegionForecast found = forecast(factor);
    if (!best || cost_of(found) < cost_of(*best)) best = found;
  }
  return best && pays(*best) ? best : std::nullopt;
}

}  // namespace fathom::runtime
