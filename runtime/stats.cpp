#include "runtime/stats.h"

#include <fmt/format.h>

namespace fathom::runtime {
namespace {

// Every count, in the order of the table: the name in JSON, the words in the table, the value.
struct Row {
  const char* name;
  const char* words;
  std::uint64_t Stats::*count;
  std::uint64_t MarchCounters::*march_count;
};
constexpr Row kRows[] = {
    {"primary_rays", "camera rays", &Stats::primary_rays, nullptr},
    {"primary_hits", "camera rays that hit", &Stats::primary_hits, nullptr},
    {"rays", "rays", nullptr, &MarchCounters::rays},
    {"hits", "rays that hit", nullptr, &MarchCounters::hits},
    {"misses", "rays that missed", nullptr, &MarchCounters::misses},
    {"contacts", "contacts", nullptr, &MarchCounters::contacts},
    {"invalid_rays", "invalid rays", nullptr, &MarchCounters::invalid},
    {"clipped_rays", "rays past the bound", nullptr, &MarchCounters::clipped},
    {"certified_rays", "rays searched in double", nullptr, &MarchCounters::certified},
    {"exhausted_rays", "rays given up", nullptr, &MarchCounters::exhausted},
    {"evaluations", "field evaluations", nullptr, &MarchCounters::evaluations},
    {"certified_evaluations", "evaluations searching", nullptr, &MarchCounters::certified_evaluations},
    {"dropped_samples", "samples dropped", &Stats::dropped_samples, nullptr},
    {"saturated_samples", "samples over full", &Stats::saturated, nullptr},
};

std::uint64_t count_of(const Stats& stats, const Row& row) {
  return row.count ? stats.*row.count : stats.march.*row.march_count;
}
std::uint64_t& count_of(Stats& stats, const Row& row) {
  return row.count ? stats.*row.count : stats.march.*row.march_count;
}

}  // namespace

void MarchCounters::merge(const MarchCounters& other) {
  for (const Row& row : kRows) {
    if (row.march_count) this->*row.march_count += other.*row.march_count;
  }
}

void Stats::merge(const Stats& other) {
  for (const Row& row : kRows) count_of(*this, row) += count_of(other, row);
}

double Stats::evaluations_per_ray() const {
  return march.rays ? static_cast<double>(march.evaluations) / static_cast<double>(march.rays) : 0;
}

double Stats::rays_per_second() const { return seconds > 0 ? static_cast<double>(march.rays) / seconds : 0; }

std::string to_table(const Stats& stats) {
  std::string text;
  for (const Row& row : kRows) text += fmt::format("{:<24}{:>16}\n", row.words, count_of(stats, row));
  text += fmt::format("{:<24}{:>16.2f}\n", "evaluations per ray", stats.evaluations_per_ray());
  text += fmt::format("{:<24}{:>16.3f}\n", "million rays per second", stats.rays_per_second() * 1e-6);
  text += fmt::format("{:<24}{:>16.3f}\n", "seconds", stats.seconds);
  text += fmt::format("{:<24}{:>16}\n", "threads", stats.threads);
  if (stats.cancelled) text += "stopped before the end\n";
  return text;
}

std::string to_json(const Stats& stats) {
  std::string text = "{\n";
  for (const Row& row : kRows) text += fmt::format("  \"{}\": {},\n", row.name, count_of(stats, row));
  text += fmt::format("  \"evaluations_per_ray\": {:.6g},\n", stats.evaluations_per_ray());
  text += fmt::format("  \"rays_per_second\": {:.6g},\n", stats.rays_per_second());
  text += fmt::format("  \"seconds\": {:.6g},\n", stats.seconds);
  text += fmt::format("  \"threads\": {},\n", stats.threads);
  text += fmt::format("  \"cancelled\": {}\n}}\n", stats.cancelled ? "true" : "false");
  return text;
}

}  // namespace fathom::runtime
