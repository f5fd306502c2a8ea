#include "runtime/chart/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "runtime/chart/chart_a.h"
#include "runtime/chart/markup.h"
#include "runtime/chart/pareto.h"

namespace fathom::runtime {

const char* const kReadChartATime =
    "Points further left are faster, lower points are more accurate, and larger discs fail more often. The bold "
    "point "
    "is the default method. Points in the shaded area are slower and less accurate than a point that fails no more "
    "often than the default. Points on the line at 0 have no error: the reference, by definition.";
const char* const kReadChartAEvaluations =
    "The same errors over the number of evaluations of the field per ray, which does not depend on the machine. "
    "Methods with equal evaluations and unequal times pay for other work.";
const char* const kReadChartB =
    "An image with more samples is further right and lower. Without bias and with independent samples the slope is "
    "-1. A curve that bends to its dashed line is biased: more samples no longer help. The measured floor includes "
    "the noise of the mean over all seeds, so an unbiased method has a floor, too, far below its curve.";
const char* const kReadChartLight =
    "The same images by method of light sampling and by sampler. \"nee\": next-event estimation at every hit; "
    "\"bsdf\": paths hit lights by BSDF sampling; \"mis\": both, combined by MIS weights. Only BSDF sampling finds "
    "light through glass or from mirrors, so in scenes with both the curves meet where this light remains. The time "
    "to 1e-3 follows from the fitted law, and is extrapolated beyond the last point.";

namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1a1a1a; --soft: #5c5c5c; --paper: #ffffff; --line: #dddddd; --mark: #fff1e6; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e8e8; --soft: #a8a8a8; --paper: #16181a; --line: #3a3d40; --mark: #3a2a1c; }
}
body { margin: 0 auto; padding: 1rem; max-width: 62rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; margin: 0.5rem 0; } h2 { margin: 2.5rem 0 0.5rem; } h3 { margin: 1.5rem 0 0.5rem; }
figure { margin: 1.2rem 0; }
figcaption { margin-top: 0.6rem; }
figcaption, footer { color: var(--soft); font-size: 0.92rem; max-width: 46rem; }
.wide { overflow-x: auto; }
.wide svg { display: block; width: 100%; min-width: 44rem; height: auto; border-radius: 6px; }
.maps { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr)); gap: 1rem; }
.maps figure { margin: 0; }
.maps img { width: 100%; height: auto; border-radius: 6px; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.25rem 0.6rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th { vertical-align: bottom; font-weight: 600; }
th:nth-child(-n+3), td:nth-child(-n+3) { text-align: left; }
tr.default { background: var(--mark); font-weight: 600; }
footer { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: 0.8rem; max-width: none; }
code { overflow-wrap: anywhere; }
)";

// A column of the table of rows. `text` needs all rows of the scene for names and Pareto fronts.
struct TableColumn {
  const char* title;
  std::string (*text)(const RayMeasurement& row, const std::vector<RayMeasurement>& scene);
};

template <double RayMeasurement::*number>
std::string number_of(const RayMeasurement& row, const std::vector<RayMeasurement>&) {
  return readable(row.*number);
}

std::string failures_of(const RayMeasurement& row, const std::vector<RayMeasurement>&) {
  const double failures = failures_ppm(row);
  return failures == 0 ? fmt::format("0 (< {})", readable(unseen_failures_ppm(row.rays))) : readable(failures);
}

using TableRows = std::vector<RayMeasurement>;
constexpr TableColumn kColumns[] = {
    {"rays", [](const RayMeasurement& row, const TableRows&) { return row.ray_class; }},
    {"method", [](const RayMeasurement& row, const TableRows& scene) { return name_of(row, scene); }},
    {"eps", [](const RayMeasurement& row, const TableRows&) { return row.eps > 0 ? scientific(row.eps) : "–"; }},
    {"ns / ray", number_of<&RayMeasurement::ns_med>},
    {"evaluations / ray", number_of<&RayMeasurement::evals_mean>},
    {"error p50", number_of<&RayMeasurement::terr_p50>},
    {"error p99", number_of<&RayMeasurement::terr_p99>},
    {"error max", number_of<&RayMeasurement::terr_max>},
    {"normal p99, rad", number_of<&RayMeasurement::nerr_p99>},
    {"failures, ppm", failures_of},
    {"near misses, ppm", number_of<&RayMeasurement::near_miss_ppm>},
    {"Pareto front",
     [](const RayMeasurement& row, const TableRows& scene) {
       if (row.reference) return std::string("reference");
       return std::string(on_pareto_front(row, scene, Cost::Time) ? "yes" : "");
     }},
};

std::string table_of(const TableRows& scene) {
  std::string html = "<div class=\"wide\"><table>\n<thead><tr>";
  for (const TableColumn& column : kColumns) html += fmt::format("<th scope=\"col\">{}</th>", escape_markup(column.title));
  html += "</tr></thead>\n<tbody>\n";
  for (const RayMeasurement& row : scene) {
    html += is_default(row) ? "<tr class=\"default\">" : "<tr>";
    for (const TableColumn& column : kColumns) html += fmt::format("<td>{}</td>", escape_markup(column.text(row, scene)));
    html += "</tr>\n";
  }
  return html + "</tbody>\n</table></div>\n";
}

std::string maps_of(const PageScene& scene) {
  if (scene.maps.empty()) return "";
  std::string html = "<div class=\"maps\">\n";
  for (const PageMap& map : scene.maps) {
    html += fmt::format(
        "<figure><img src=\"{}\" alt=\"{}\" loading=\"lazy\">\n<figcaption><strong>{}.</strong> "
        "{}</figcaption></figure>\n",
        escape_markup(map.file), escape_markup(map.title), escape_markup(map.title), escape_markup(map.reading));
  }
  return html + "</div>\n";
}

std::string section_of(const PageScene& scene, const Page& page) {
  std::string html = fmt::format("<section>\n<h2>{}</h2>\n", escape_markup(scene.name));
  for (const PageChart& chart : scene.charts) {
    html += fmt::format("<figure><div class=\"wide\">\n{}</div>\n<figcaption>{}</figcaption></figure>\n", chart.svg,
                        escape_markup(chart.reading));
  }
  html += maps_of(scene);
  TableRows rows;
  std::copy_if(page.rays.begin(), page.rays.end(), std::back_inserter(rows),
               [&](const RayMeasurement& row) { return row.scene == scene.name; });
  if (!rows.empty()) {
    html +=
        "<h3>All rows</h3>\n<p>Errors of the hit distance are in scene units. Where no ray failed, the bracket has "
        "what 95 % confidence does not rule out.</p>\n" +
        table_of(rows);
  }
  return html + "</section>\n";
}

std::string footer_of(const Page& page) {
  const Provenance& p = page.provenance;
  std::string html = "<footer>\n<p>";
  const std::pair<const char*, const std::string*> facts[] = {{"Commit", &p.commit},
                                                              {"processor", &p.cpu},
                                                              {"instructions", &p.isa},
                                                              {"compiler", &p.compiler},
                                                              {"date", &p.date}};
  for (const auto& [name, value] : facts) {
    if (value->empty()) continue;
    html += fmt::format("{}{} <code>{}</code>", value == &p.commit ? "" : ", ", name, escape_markup(*value));
  }
  html += fmt::format(". Every time is the median of {} rounds.</p>\n", p.rounds);
  if (!p.command.empty()) html += fmt::format("<p>Made by <code>{}</code>.</p>\n", escape_markup(p.command));
  if (!page.files.empty()) {
    html += "<p>The numbers:";
    for (const std::string& file : page.files) html += fmt::format(" <a href=\"{0}\">{0}</a>", escape_markup(file));
    html += "</p>\n";
  }
  return html + "</footer>\n";
}

}  // namespace

std::string page_html(const Page& page) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Speed against accuracy</title>\n<style>" +
      std::string(kStyle) +
      "</style>\n</head>\n<body>\n<h1>Speed against accuracy</h1>\n"
      "<p>What each way to trace a scene costs, and how far it is from the truth. Nothing that failed is left out: "
      "failures are counted in parts per million of the rays.</p>\n";
  for (const PageScene& scene : page.scenes) html += section_of(scene, page);
  return html + footer_of(page) + "</body>\n</html>\n";
}

}  // namespace fathom::runtime
