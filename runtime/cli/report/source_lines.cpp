#include "runtime/cli/report/source_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "compiler/lower/lower.h"
#include "runtime/chart/markup.h"

namespace fathom::cli {
namespace {

using runtime::escape_markup;

// Returns the cost of each line of the scene's own file, as a share of the program's, in [0,1].
std::map<std::uint32_t, double> cost_by_line(const compiler::CompiledScene& scene) {
  const vm::VerifiedProgram& program = scene.surface;
  std::map<std::uint32_t, double> shares;
  for (const vm::DebugEntry& entry : program.program().debug) {
    if (is_in_import(entry, scene.source)) continue;
    const double cost = static_cast<double>(vm::instruction_cost(program.program().words[entry.offset]));
    shares[entry.line] += cost / std::max(1.0, static_cast<double>(program.cost()));
  }
  return shares;
}

std::string in_class(const char* name, std::string_view text) {
  return fmt::format("<span class=\"{}\">{}</span>", name, escape_markup(text));
}

// Returns the end of the text in quotes that begins at `at`.
std::size_t end_of_text(std::string_view line, std::size_t at) {
  for (std::size_t i = at + 1; i < line.size(); ++i) {
    if (line[i] == '\\')
      ++i;
    else if (line[i] == '"')
      return i + 1;
  }
  return line.size();
}

// Returns the end of the comment at `at`, or `at` if there is none. `is_open`: a comment /* */ goes on from line to
// line.
std::size_t end_of_comment(std::string_view line, std::size_t at, bool& is_open) {
  if (!is_open && line.substr(at, 2) == "//") return line.size();
  if (!is_open && line.substr(at, 2) != "/*") return at;
  const std::size_t end = line.find("*/", is_open ? at : at + 2);
  is_open = end == std::string_view::npos;
  return is_open ? line.size() : end + 2;
}

// Colours comments, and texts in quotes.
std::string highlighted(std::string_view line, bool& is_open) {
  std::string html;
  std::size_t plain = 0, at = 0;
  while (at < line.size()) {
    std::size_t end = end_of_comment(line, at, is_open);
    const char* const name = end > at ? "comment" : "text";
    if (end == at && line[at] == '"') end = end_of_text(line, at);
    if (end == at) {
      ++at;
      continue;
    }
    html += escape_markup(line.substr(plain, at - plain)) + in_class(name, line.substr(at, end - at));
    plain = at = end;
  }
  return html + escape_markup(line.substr(plain));
}

}  // namespace

std::string source_lines(const compiler::CompiledScene& scene) {
  const std::map<std::uint32_t, double> shares = cost_by_line(scene);
  std::string_view rest = scene.source.text();
  std::string html;
  bool is_open = false;
  for (std::uint32_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const auto share = shares.find(number);
    const std::string cost = share == shares.end() ? "" : fmt::format("{:.1f} %", 100 * share->second);
    const std::string bar =
        share == shares.end() ? "" : fmt::format("<meter value=\"{:.4f}\"></meter>", share->second);
    html += fmt::format("<tr><td>{}<td>{}{}<td>{}\n", number, bar, cost, highlighted(rest.substr(0, end), is_open));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return html;
}

}  // namespace fathom::cli
