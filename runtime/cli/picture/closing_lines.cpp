#include "runtime/cli/picture/closing_lines.h"

#include <fmt/format.h>

#include "runtime/cli/options/streams.h"

namespace fathom::cli {
namespace {

// Formats a count: "1836", "69.96 million".
std::string large(std::uint64_t count) {
  if (count < 1'000'000) return std::to_string(count);
  return fmt::format("{:.2f} million", static_cast<double>(count) * 1e-6);
}

// Describes the samples per pixel: the number if all pixels have the same, else the average.
std::string samples(const runtime::Film& film) {
  const std::uint64_t all = film.samples(), pixels = film.area().pixels();
  const runtime::PixelRect area = film.area();
  const std::uint32_t first = film.samples(area.x0, area.y0);
  bool alike = true;
  for (int y = area.y0; y < area.y1 && alike; ++y) {
    for (int x = area.x0; x < area.x1 && alike; ++x) alike = film.samples(x, y) == first;
  }
  if (alike) return count_of(first, "sample") + " per pixel";
  return fmt::format("{:.2f} samples per pixel on average", static_cast<double>(all) / static_cast<double>(pixels));
}

std::string drawn(std::string_view scene, const runtime::RenderResult& result) {
  const runtime::Film& film = result.film;
  const runtime::Stats& stats = result.stats;
  std::string line = fmt::format("drew {}: {}x{} pixels", scene, film.width(), film.height());
  if (film.width() != result.settings.width || film.height() != result.settings.height) {
    line += fmt::format(" of {}x{}", result.settings.width, result.settings.height);
  }
  line += ", " + samples(film);
  if (stats.resumed_samples > 0) line += fmt::format(", {} samples resumed", large(stats.resumed_samples));
  if (stats.end != runtime::RenderEnd::Done) {
    line += fmt::format(", ended by {}", runtime::kRenderEnds[static_cast<std::size_t>(stats.end)]);
  }
  return line;
}

std::string rays(const runtime::Stats& stats) {
  const runtime::MarchCounters& march = stats.march;
  std::string line = "rays: " + large(march.rays);
  if (march.rays > 0) {
    line += fmt::format(", {:.1f} % of them hit",
                        100 * static_cast<double>(march.hits) / static_cast<double>(march.rays));
  }
  const auto add = [&](std::uint64_t count, std::string_view what) {
    if (count > 0) line += fmt::format(", {} {}", large(count), what);
  };
  add(march.certified, "searched in double");
  add(march.exhausted, "given up");
  add(march.invalid, "invalid");
  add(stats.dropped_samples, "samples dropped");
  return line;
}

std::string seconds(double time) {
  return time < 100 ? fmt::format("{:.3g} s", time) : fmt::format("{:.0f} s", time);
}

std::string time(const runtime::Stats& stats) {
  std::string line =
      fmt::format("time: {} on {}, {:.2f} million rays per second", seconds(stats.seconds),
                  count_of(static_cast<std::size_t>(stats.threads), "thread"), stats.rays_per_second() * 1e-6);
  if (stats.peak_memory > 0) {
    line += fmt::format(", peak memory {:.1f} MB", static_cast<double>(stats.peak_memory) * 1e-6);
  }
  return line;
}

}  // namespace

std::string closing_lines(std::string_view scene, const runtime::RenderResult& result) {
  return fmt::format("{}\n{}\n{}\n", drawn(scene, result), rays(result.stats), time(result.stats));
}

std::string closing_line(std::string_view scene, const runtime::RenderResult& result,
                         const std::vector<std::string>& written) {
  std::string line = fmt::format("{}, {}", drawn(scene, result), seconds(result.stats.seconds));
  for (const std::string& file : written) line += ", " + file;
  return line + '\n';
}

}  // namespace fathom::cli
