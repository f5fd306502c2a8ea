#include "runtime/base/stats.h"

#include <fmt/format.h>

#include <fstream>
#include <numeric>
#include <string_view>

namespace fathom::runtime {
namespace {

// Every count, in the order of the table: JSON name, label in the table, value.
struct Row {
  const char* name;
  const char* words;
  std::uint64_t Stats::*count;
  std::uint64_t MarchCounters::*march_count;
};
constexpr Row kRows[] = {
    {"primary_rays", "camera rays", &Stats::primary_rays, nullptr},
    {"primary_hits", "camera rays that hit", &Stats::primary_hits, nullptr},
    {"shadow_rays", "shadow rays", &Stats::shadow_rays, nullptr},
    {"bounce_rays", "rays after a bounce", &Stats::bounce_rays, nullptr},
    {"rays", "rays", nullptr, &MarchCounters::rays},
    {"hits", "rays that hit", nullptr, &MarchCounters::hits},
    {"misses", "rays that missed", nullptr, &MarchCounters::misses},
    {"near_misses", "near_misses", nullptr, &MarchCounters::near_misses},
    {"invalid_rays", "invalid rays", nullptr, &MarchCounters::invalid},
    {"clipped_rays", "rays past the bound", nullptr, &MarchCounters::clipped},
    {"certified_rays", "rays searched in double", nullptr, &MarchCounters::certified},
    {"exhausted_rays", "rays given up", nullptr, &MarchCounters::exhausted},
    {"evaluations", "field evaluations", nullptr, &MarchCounters::evaluations},
    {"certified_evaluations", "evaluations searching", nullptr, &MarchCounters::certified_evaluations},
    {"instructions", "instructions", nullptr, &MarchCounters::instructions},
    {"lanes", "lanes taken", nullptr, &MarchCounters::lanes},
    {"region_far", "evaluations far off", nullptr, &MarchCounters::region_far},
    {"region_programs", "evaluations of parts", nullptr, &MarchCounters::region_programs},
    {"dropped_samples", "samples dropped", &Stats::dropped_samples, nullptr},
    {"saturated_samples", "samples over full", &Stats::saturated, nullptr},
    {"lit_samples", "samples with light", &Stats::lit_samples, nullptr},
    {"faint_samples", "samples too faint", &Stats::faint_samples, nullptr},
};

std::uint64_t count_of(const Stats& stats, const Row& row) {
  return row.count ? stats.*row.count : stats.march.*row.march_count;
}
std::uint64_t& count_of(Stats& stats, const Row& row) {
  return row.count ? stats.*row.count : stats.march.*row.march_count;
}

// Values derived from the counts and the clock.
struct Rate {
  const char* name;
  const char* words;
  double (Stats::*value)() const;
  double scale;  // in the table
};
constexpr Rate kRates[] = {
    {"evaluations_per_ray", "evaluations per ray", &Stats::evaluations_per_ray, 1},
    {"instructions_per_evaluation", "instructions an evaluation", &Stats::instructions_per_evaluation, 1},
    {"utilisation", "lanes that held a ray, %", &Stats::utilisation, 100},
    {"rays_per_second", "million rays per second", &Stats::rays_per_second, 1e-6},
};

double ratio(std::uint64_t a, std::uint64_t b) { return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0; }

// Prints each stage's seconds and its share of all threads' time. The rest is a thread's time before its first ray
// and after its last.
std::string stage_table(const Stats& stats) {
  std::string text;
  const double all = stats.seconds * stats.threads;
  const auto row = [&](const char* name, double seconds) {
    text += fmt::format("{:<24}{:>16.3f}{:>7.1f} %\n", fmt::format("seconds of {}", name), seconds,
                        all > 0 ? 100 * seconds / all : 0);
  };
  for (std::size_t i = 0; i < stats.stages->size(); ++i) row(kStages[i], (*stats.stages)[i]);
  row("waiting", all - std::accumulate(stats.stages->begin(), stats.stages->end(), 0.0));
  return text;
}

std::string stage_json(const StageSeconds& stages) {
  std::string text;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    text += fmt::format("{}\"{}\": {:.6g}", i > 0 ? ", " : "", kStages[i], stages[i]);
  }
  return "{" + text + "}";
}

}  // namespace

void MarchCounters::note_invalid(glm::dvec3 at) {
  const auto key = [](const glm::dvec3& p) { return std::array{p.x, p.y, p.z}; };
  if (!invalid_at || key(at) < key(*invalid_at)) invalid_at = at;
}

void MarchCounters::merge(const MarchCounters& other) {
  if (other.invalid_at) note_invalid(*other.invalid_at);
  for (const Row& row : kRows) {
    if (row.march_count) this->*row.march_count += other.*row.march_count;
  }
}

void Stats::merge(const Stats& other) {
  for (const Row& row : kRows) count_of(*this, row) += count_of(other, row);
  if (other.march.invalid_at) march.note_invalid(*other.march.invalid_at);
  if (!other.stages) return;
  if (!stages) stages.emplace();
  for (std::size_t i = 0; i < stages->size(); ++i) (*stages)[i] += (*other.stages)[i];
}

double Stats::evaluations_per_ray() const { return ratio(march.evaluations, march.rays); }

double Stats::instructions_per_evaluation() const { return ratio(march.instructions, march.evaluations); }

double Stats::utilisation() const {
  return march.lanes > 0 ? ratio(march.evaluations - march.certified_evaluations, march.lanes) : 1;
}

double Stats::rays_per_second() const { return seconds > 0 ? static_cast<double>(march.rays) / seconds : 0; }

// ru_maxrss of getrusage() would not do: a program inherits it from the program that starts it.
std::uint64_t peak_memory() {
  constexpr std::string_view kKey = "VmHWM:";  // proc(5); KiB
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(kKey)) return std::stoull(line.substr(kKey.size())) << 10;
  }
  return 0;
}

std::string to_table(const Stats& stats) {
  std::string text;
  for (const Row& row : kRows) text += fmt::format("{:<24}{:>16}\n", row.words, count_of(stats, row));
  for (const Rate& rate : kRates) {
    text += fmt::format("{:<24}{:>16.3f}\n", rate.words, (stats.*rate.value)() * rate.scale);
  }
  if (stats.stages) text += stage_table(stats);
  if (stats.region_bytes > 0) {
    text += fmt::format("{:<24}{:>16.1f}\n", "memory of regions, MB", static_cast<double>(stats.region_bytes) * 1e-6);
    text += fmt::format("{:<24}{:>16.3f}\n", "seconds of regions", stats.region_seconds);
    if (stats.regions_reused > 0) text += fmt::format("{:<24}{:>16}\n", "regions kept", stats.regions_reused);
  }
  if (stats.peak_memory > 0) {
    text += fmt::format("{:<24}{:>16.1f}\n", "peak memory, MB", static_cast<double>(stats.peak_memory) * 1e-6);
  }
  if (stats.resumed_samples > 0) text += fmt::format("{:<24}{:>16}\n", "samples resumed", stats.resumed_samples);
  if (stats.checkpoints > 0) text += fmt::format("{:<24}{:>16}\n", "checkpoints written", stats.checkpoints);
  text += fmt::format("{:<24}{:>16.3f}\n", "seconds", stats.seconds);
  text += fmt::format("{:<24}{:>16}\n", "threads", stats.threads);
  text += fmt::format("{:<24}{:>16}\n", "ended by", kRenderEnds[static_cast<std::size_t>(stats.end)]);
  return text;
}

std::string to_json(const Stats& stats) {
  std::string text = "{\n";
  for (const Row& row : kRows) text += fmt::format("  \"{}\": {},\n", row.name, count_of(stats, row));
  for (const Rate& rate : kRates) text += fmt::format("  \"{}\": {:.6g},\n", rate.name, (stats.*rate.value)());
  if (stats.stages) text += fmt::format("  \"stage_seconds\": {},\n", stage_json(*stats.stages));
  text += fmt::format("  \"region_bytes\": {},\n", stats.region_bytes);
  text += fmt::format("  \"region_seconds\": {:.6g},\n", stats.region_seconds);
  text += fmt::format("  \"regions_reused\": {},\n", stats.regions_reused);
  text += fmt::format("  \"resumed_samples\": {},\n", stats.resumed_samples);
  text += fmt::format("  \"checkpoints\": {},\n", stats.checkpoints);
  text += fmt::format("  \"peak_memory\": {},\n", stats.peak_memory);
  text += fmt::format("  \"seconds\": {:.6g},\n", stats.seconds);
  text += fmt::format("  \"threads\": {},\n", stats.threads);
  text += fmt::format("  \"ended_by\": \"{}\",\n", kRenderEnds[static_cast<std::size_t>(stats.end)]);
  text += fmt::format("  \"cancelled\": {}\n}}\n", stats.end == RenderEnd::Cancelled ? "true" : "false");
  return text;
}

}  // namespace fathom::runtime
