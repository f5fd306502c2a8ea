#include "runtime/cli/report/report_page.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "runtime/chart/colormap.h"
#include "runtime/chart/markup.h"
#include "runtime/cli/dump/check_report.h"
#include "runtime/cli/dump/operation_table.h"
#include "runtime/cli/options/version.h"
#include "runtime/cli/picture/cost_map.h"
#include "runtime/cli/plan/base64.h"
#include "runtime/cli/report/report_files.h"
#include "runtime/cli/report/source_lines.h"
#include "runtime/film/film_layers.h"
#include "runtime/image/image_io.h"
#include "runtime/live/live_page.h"
#include "vm/encoding/disassemble.h"

namespace fathom::cli {
namespace {

using runtime::escape_markup;

std::string data_address(const char* type, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", type, to_base64(bytes));
}

std::string figure(const runtime::ByteImage& image, std::string_view caption) {
  const std::vector<std::uint8_t> bytes = encode_image(image, runtime::ImageFormat::Png);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return fmt::format(
      "<figure><img alt=\"{0}\" width=\"{1}\" height=\"{2}\" src=\"{3}\"><figcaption>{0}</figcaption>"
      "</figure>\n",
      escape_markup(caption), image.width, image.height, data_address("image/png", text));
}

// Returns the maps of counts per sample, with their scales.
std::string cost_figures(const runtime::Film& film) {
  std::string html;
  for (const CostMap& map : kCostMaps) {
    const std::vector<float> values = cost_values(film, map);
    const runtime::ColorScale scale = runtime::scale_for(values, true);
    html += figure(draw_map(values, film.width(), film.height(), scale), fmt::format("{} per sample", map.name));
  }
  return html;
}

std::string pre(std::string_view text) { return fmt::format("<pre tabindex=\"0\">{}</pre>\n", escape_markup(text)); }

struct Section {
  const char* id;
  const char* title;
  std::string html;
};

std::vector<Section> sections_of(const ReportContents& contents) {
  using runtime::Layer;
  const compiler::CompiledScene& scene = contents.scene;
  const runtime::Film& film = contents.render.film;
  const auto layer = [&](Layer which, const char* name) { return figure(layer_image(film, which), name); };
  std::vector<Section> sections = {
      {"picture", "Picture",
       figure(layer_image(film, Layer::Beauty, {scene.film.exposure, scene.film.tone}),
              fmt::format("{} samples per pixel", contents.render.settings.spp))},
      {"live", "Live",
       fmt::format("<iframe title=\"The scene, live\" sandbox=\"allow-scripts\" srcdoc=\"{}\"></iframe>\n",
                   escape_markup(runtime::live_page(scene)))},
      {"source", "Scene",
       "<div class=\"scroll\" tabindex=\"0\"><table>\n" + source_lines(scene) + "</table></div>\n"},
      {"check", "Check", pre(contents.messages + report_text(scene, contents.report, true))},
      {"layers", "Layers",
       "<div class=\"pictures\">\n" + layer(Layer::Albedo, "albedo") + layer(Layer::Normal, "normal") +
           layer(Layer::Depth, "depth") + "</div>\n"},
      {"cost", "Cost", "<div class=\"pictures\">\n" + cost_figures(film) + "</div>\n"},
      {"profile", "Profile", pre(to_table(contents.render.stats))},
      {"operations", "Operations", pre(operation_table(scene.surface) + "\n" + cost_by_node(scene.surface))},
      {"program", "Program", pre(vm::disassemble(scene.surface, {.few = true}))}};
  if (contents.chart) {
    sections.push_back({"chart", "Chart",
                        fmt::format("<img alt=\"speed against accuracy\" src=\"{}\">\n",
                                    data_address("image/svg+xml", *contents.chart))});
  }
  return sections;
}

constexpr std::string_view kPage = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; script-src 'unsafe-inline'; style-src 'unsafe-inline'">
<title>{title}</title>
<style>
{style}</style>
<h1>{title}</h1>
<p>{summary}</p>
<p><code>{command}</code>, fathom {version}</p>
<nav aria-label="Sections">{links}</nav>
{sections}</html>
)";

}  // namespace

std::string report_page(const ReportContents& contents) {
  std::string links, html;
  for (const Section& section : sections_of(contents)) {
    links += fmt::format("<a href=\"#{}\">{}</a>\n", section.id, section.title);
    html += fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", section.id, section.title, section.html);
  }
  const std::string version = fmt::format("{}{}{}", kVersion, kCommit.empty() ? "" : " ", kCommit);
  return fmt::format(fmt::runtime(kPage), fmt::arg("title", escape_markup(contents.scene.source.name())),
                     fmt::arg("style", report_files().front().text), fmt::arg("summary", escape_markup(contents.scene.summary)),
                     fmt::arg("command", escape_markup(contents.command)), fmt::arg("version", version),
                     fmt::arg("links", links), fmt::arg("sections", html));
}

}  // namespace fathom::cli
