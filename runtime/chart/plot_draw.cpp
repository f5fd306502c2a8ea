#include "runtime/chart/plot_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/chart/markup.h"
#include "vm/number/decimal.h"

namespace fathom::runtime {
namespace {

constexpr double kLargestDisc = 15;  // pixels; radius at a million ppm

std::string text_attributes(glm::dvec2 at, const TextStyle& style) {
  return fmt::format(
      R"( x="{}" y="{}" font-size="{}" fill="{}" text-anchor="{}"{}{})", coordinate(at.x), coordinate(at.y),
      coordinate(style.size), style.color, style.anchor, style.bold ? R"( font-weight="600")" : "",
      style.halo ? R"( stroke="#ffffff" stroke-width="3" stroke-linejoin="round" paint-order="stroke")" : "");
}

}  // namespace

double disc_radius(double failures_ppm) {
  if (!(failures_ppm > 0)) return 0;
  return kLargestDisc * std::sqrt(vm::real::log10(1 + std::min(failures_ppm, 1e6)) / vm::real::log10(1e6 + 1));
}

double text_width(std::string_view text, double size, bool bold) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  return (bold ? 0.68 : 0.61) * size * static_cast<double>(std::count_if(text.begin(), text.end(), begins));
}

std::string draw_text(glm::dvec2 at, std::string_view text, const TextStyle& style) {
  return fmt::format("<text{}>{}</text>\n", text_attributes(at, style), escape_markup(text));
}

std::string draw_tick_label(glm::dvec2 at, const TickLabel& label, const TextStyle& style) {
  if (label.power.empty()) return draw_text(at, label.text, style);
  return fmt::format("<text{}>{}<tspan dy=\"-4.5\" font-size=\"{}\">{}</tspan></text>\n", text_attributes(at, style),
                     escape_markup(label.text), coordinate(0.76 * style.size), escape_markup(label.power));
}

std::string draw_line(glm::dvec2 from, glm::dvec2 to, std::string_view color, double width,
                      std::string_view attributes) {
  return fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"{}\"{}{}/>\n",
                     coordinate(from.x), coordinate(from.y), coordinate(to.x), coordinate(to.y), color,
                     coordinate(width), attributes.empty() ? "" : " ", attributes);
}

std::string draw_circle(glm::dvec2 at, double radius, std::string_view attributes) {
  return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", coordinate(at.x), coordinate(at.y),
                     coordinate(radius), attributes);
}

std::string draw_disc(glm::dvec2 at, double failures_ppm, std::string_view color) {
  return draw_circle(
      at, disc_radius(failures_ppm),
      fmt::format(
          R"(class="disc" fill="{0}" fill-opacity="0.17" stroke="{0}" stroke-opacity="0.45" stroke-width="0.8")",
          color));
}

std::string draw_ring(glm::dvec2 at) {
  return draw_circle(at, kRingRadius,
                     fmt::format(R"(class="ring" fill="none" stroke="{}" stroke-width="1.1")", kInk));
}

std::string draw_marker(const PlotSeries& series, glm::dvec2 at, bool zero) {
  const double radius = series.emphasised ? kBoldMarkerRadius : kMarkerRadius;
  const std::string paint =
      fmt::format(R"(class="marker" fill="{}" stroke="{}" stroke-width="{}")",
                  series.hollow ? "#ffffff" : series.color, series.color, series.hollow ? "1.6" : "1");
  if (!zero) return draw_circle(at, radius, paint);
  const double side = 1.35 * radius;
  return fmt::format("<path d=\"M{0} {1}L{2} {3}L{0} {4}L{5} {3}Z\" {6}/>\n", coordinate(at.x),
                     coordinate(at.y - side), coordinate(at.x + side), coordinate(at.y), coordinate(at.y + side),
                     coordinate(at.x - side), paint);
}

}  // namespace fathom::runtime
