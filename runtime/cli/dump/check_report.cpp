#include "runtime/cli/dump/check_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "runtime/cli/options/streams.h"

namespace fathom::cli {
namespace {

using compiler::Place;
using compiler::ProbeRow;
using ReportJson = nlohmann::ordered_json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Lays out a table whose columns are as wide as their widest cell and two blanks apart. The first row is the heading.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  const auto width_of = [](const std::string& cell) {  // in code points
    return std::count_if(cell.begin(), cell.end(),
                         [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  };
  std::vector<std::ptrdiff_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += ' ' + row[i] + std::string(static_cast<std::size_t>(widths[i] - width_of(row[i])) + 1, ' ');
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return out;
}

// Describes a place: `twist "column" at scene.json:6:5`.
std::string text(const Place& place, const compiler::Source& source) {
  if (place.span.end == 0) return describe(place);
  return fmt::format("{} at {}", describe(place), source.place(place.span.begin));
}

ReportJson json(const Place& place, const compiler::Source& source) {
  ReportJson json = {{"type", place.type}, {"name", place.name}};
  if (place.span.end == 0) return json;
  const compiler::Position at = source.locate(place.span.begin);
  json["file"] = source.file(place.span.begin).name();
  json["line"] = at.line;
  json["column"] = at.column;
  return json;
}

// Infinite components become null, because JSON has no infinity.
ReportJson json(const glm::dvec3& v) {
  ReportJson list = ReportJson::array();
  for (int i = 0; i < 3; ++i) list.push_back(std::isfinite(v[i]) ? ReportJson(v[i]) : ReportJson(nullptr));
  return list;
}

std::string line(const ReportJson& json) { return json.dump(-1, ' ', false, ReportJson::error_handler_t::replace) + "\n"; }

std::string describe_program(std::string_view name, const vm::VerifiedProgram& program) {
  return fmt::format("  {} program: {}, {}, stacks of {} and {}, about {} a point\n", name,
                     count_of(program.instructions(), "instruction"),
                     count_of(program.program().words.size(), "word"), count_of(program.max_values(), "value"),
                     count_of(program.max_points(), "point"), count_of(program.cost(), "multiply-add"));
}

// Lists the parameters, one per line, in the form that -D takes.
std::string describe_parameters(const std::vector<compiler::Parameter>& parameters) {
  std::string out;
  for (const compiler::Parameter& parameter : parameters) {
    out += fmt::format("  -D {}={}", parameter.name, parameter.value);
    if (parameter.min > -kInfinity || parameter.max < kInfinity) {
      out += fmt::format("  [{}, {}]", parameter.min, parameter.max);
    }
    out += (parameter.doc.empty() ? "" : "  " + parameter.doc) + "\n";
  }
  return out;
}

// Says of how many objects the distances are exact, bounds, ...
std::string count_classes(const compiler::Report& report) {
  std::map<std::string_view, std::size_t> classes;
  for (const compiler::ObjectReport& object : report.objects) ++classes[class_of(object.facts, report.in_cells)];
  std::vector<std::string> counts;
  for (const auto& [name, count] : classes) counts.push_back(fmt::format("{} {}", count, name));
  return fmt::format("  {}: {}", count_of(report.objects.size(), "object"), fmt::join(counts, ", "));
}

// Lists the objects: if they are more than kMaxObjects, those that make steps the shortest, unless `all` is true.
std::string objects_table(const compiler::Report& report, const compiler::Source& source, bool all) {
  constexpr std::size_t kMaxObjects = 40, kShown = 10;
  std::vector<std::vector<std::string>> rows = {{"object", "distance", "Lipschitz", "step", "box", "costs most"}};
  std::vector<const compiler::ObjectReport*> objects;
  for (const compiler::ObjectReport& object : report.objects) objects.push_back(&object);
  std::string heading;
  if (objects.size() > kMaxObjects && !all) {
    std::ranges::stable_sort(objects, std::greater(), &compiler::ObjectReport::lipschitz);
    objects.resize(kShown);
    heading = fmt::format("{}; the {} with the shortest steps (-v lists all):\n", count_classes(report), kShown);
  }
  for (const compiler::ObjectReport* each : objects) {
    const compiler::ObjectReport& object = *each;
    std::string costs;
    if (object.costliest) {
      costs = fmt::format("{} makes steps {:.3g}x shorter", text(object.costliest->place, source),
                          object.costliest->times);
    }
    rows.push_back({object.name, std::string(class_of(object.facts, report.in_cells)),
                    fmt::format("{:.4g}", object.lipschitz), fmt::format("{:.3g}", 1 / object.lipschitz),
                    describe(object.facts.box), costs});
  }
  return heading + table(rows);
}

// Returns the text of a span, truncated to kMost bytes.
std::string excerpt(compiler::Span span, const compiler::Source& source) {
  constexpr std::size_t kMost = 60;
  std::string written(source.excerpt(span));
  return written.size() > kMost ? written.substr(0, kMost) + "..." : written;
}

// Describes an operation: `  no bound on the slope of `floor(x)` at scene.json:4:70`.
std::string describe_operation(compiler::Span span, const compiler::Source& source) {
  return fmt::format("  no bound on the slope of `{}` at {}\n", excerpt(span, source), source.place(span.begin));
}

std::string certificate(const compiler::Report& report, const compiler::Source& source) {
  if (report.certified && !report.in_cells) return "certified: every step length is proved\n";
  std::string nodes, operations;
  std::size_t listed = 0;
  for (const compiler::Estimate& estimate : report.estimates) {
    if (++listed > compiler::Report::kMaxSearched) continue;
    nodes += fmt::format("{}the {}", listed > 1 ? ", " : "", text(estimate, source));
    if (estimate.operation) operations += describe_operation(*estimate.operation, source);
  }
  if (listed > compiler::Report::kMaxSearched) {
    nodes += fmt::format(", and {} more", listed - compiler::Report::kMaxSearched);
  }
  if (report.in_cells) {
    return fmt::format("certified: every step length is proved, cell by cell within {}\n{}", nodes, operations);
  }
  return fmt::format("not certified: nothing is proved of {}\n{}", nodes, operations);
}

std::string_view word(ProbeRow::What what) {
  return what == ProbeRow::What::Scene ? "scene" : what == ProbeRow::What::Object ? "object" : "node";
}

std::string verdict(const ProbeRow& row) { return row.broken() ? "BROKEN" : row.certified ? "holds" : "estimate"; }

}  // namespace

std::string report_text(const compiler::CompiledScene& scene, const compiler::Report& report, bool all_objects) {
  return fmt::format("{}: no errors\n  {}\n", scene.source.name(), scene.summary) +
         describe_program("distance", scene.distance) + describe_program("surface", scene.surface) +
         fmt::format("  {}, {}\n", count_of(scene.materials.size(), "material"),
                     count_of(scene.surfaces.size(), "surface")) +
         describe_parameters(scene.parameters) + objects_table(report, scene.source, all_objects) +
         certificate(report, scene.source);
}

std::string report_json(const compiler::CompiledScene& scene, const compiler::Report& report) {
  std::string out;
  for (const compiler::ObjectReport& object : report.objects) {
    ReportJson costliest = nullptr;
    if (object.costliest) {
      costliest = json(object.costliest->place, scene.source);
      costliest["times"] = object.costliest->times;
    }
    const compiler::NodeFacts& known = object.facts;
    out += line({{"object", object.name},
                 {"class", class_of(known, report.in_cells)},
                 {"certified", known.certified || report.in_cells},
                 {"lipschitz", object.lipschitz},
                 {"step", 1 / object.lipschitz},
                 {"box", {{"lo", json(known.box.lo)}, {"hi", json(known.box.hi)}}},
                 {"costliest", costliest}});
  }
  ReportJson estimates = ReportJson::array();
  for (const compiler::Estimate& estimate : report.estimates) {
    estimates.push_back(json(static_cast<const Place&>(estimate), scene.source));
    if (estimate.operation) {
      const compiler::Position at = scene.source.locate(estimate.operation->begin);
      estimates.back()["operation"] = {
          {"text", excerpt(*estimate.operation, scene.source)}, {"line", at.line}, {"column", at.column}};
    }
  }
  ReportJson parameters = ReportJson::object();
  for (const compiler::Parameter& parameter : scene.parameters) parameters[parameter.name] = parameter.value;
  out += line({{"scene", scene.source.name()},
               {"certified", report.certified},
               {"estimates", estimates},
               {"lipschitz", scene.lipschitz},
               {"summary", scene.summary},
               {"instructions", scene.distance.instructions()},
               {"cost", scene.distance.cost()},
               {"parameters", parameters}});
  return out;
}

std::string probe_text(const compiler::Source& source, const std::vector<ProbeRow>& rows,
                       const std::vector<const ProbeRow*>& culprits) {
  std::vector<std::vector<std::string>> cells = {
      {"probed", "points", "declared", "gradient", "quotient", "seen/declared", "", "where"}};
  for (const ProbeRow& row : rows) {
    const bool scene = row.what == ProbeRow::What::Scene;
    cells.push_back({std::string(word(row.what)), std::to_string(row.points), fmt::format("{:.6g}", row.declared),
                     fmt::format("{:.6g}", row.gradient), fmt::format("{:.6g}", row.quotient),
                     fmt::format("{:.4f}", row.ratio()), verdict(row), scene ? "" : text(row.place, source)});
    if (row.invalid > 0) cells.back().back() += fmt::format("; no number at {}", count_of(row.invalid, "point"));
  }
  std::string out = table(cells);
  for (const ProbeRow* row : culprits) {
    out += fmt::format("{} breaks its constant: {:.6g} seen near {},{},{} of its own space, {:.6g} declared\n",
                       text(row->place, source), row->seen(), row->at.x, row->at.y, row->at.z, row->declared);
  }
  return out + (culprits.empty() ? "no constant broken\n" : "");
}

std::string probe_json(const compiler::Source& source, const std::vector<ProbeRow>& rows,
                       const std::vector<const ProbeRow*>& culprits) {
  std::string out;
  for (const ProbeRow& row : rows) {
    out += line({{"probed", word(row.what)},
                 {"node", json(row.place, source)},
                 {"points", row.points},
                 {"certified", row.certified},
                 {"declared", row.declared},
                 {"gradient", row.gradient},
                 {"quotient", row.quotient},
                 {"ratio", row.ratio()},
                 {"at", json(row.at)},
                 {"invalid", row.invalid},
                 {"broken", row.broken()},
                 {"culprit", std::find(culprits.begin(), culprits.end(), &row) != culprits.end()}});
  }
  return out;
}

}  // namespace fathom::cli
