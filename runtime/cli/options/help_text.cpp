#include "runtime/cli/options/help_text.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "runtime/cli/options/values.h"

namespace fathom::cli {
namespace {

constexpr int kMinColumns = 40, kUsualColumns = 80, kMaxColumns = 120;
constexpr int kDocColumn = 30;    // column at which an option's description begins
constexpr int kMinDoc = 30;       // with fewer columns for it, the description gets lines of its own
constexpr int kNarrowIndent = 6;  // indentation of such a description

// Returns the width in code points.
int width_of(std::string_view text) {
  return static_cast<int>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string blanks(int count) { return std::string(static_cast<std::size_t>(std::max(0, count)), ' '); }

std::string usage(const OptionTable& table) {
  std::string line = fmt::format("Usage: fathom {} [OPTIONS]", table.verb);
  for (const OptionRow& row : table.positionals) {
    line += fmt::format(" {}{}{}{}", row.required ? "" : "[", row.names, row.repeated ? "..." : "",
                        row.required ? "" : "]");
  }
  return line;
}

// Formats an example line, "command   # comment". In a line that is too long, the comment goes above the command, and
// the command is split into lines that a shell joins.
std::string example(std::string_view line, int columns) {
  constexpr int kIndent = 2;
  if (kIndent + width_of(line) <= columns) return blanks(kIndent) + std::string(line) + '\n';
  const std::size_t mark = line.find("  # ");
  std::string text;
  if (mark != std::string_view::npos) {
    std::string_view comment = line.substr(line.find('#', mark) + 2);
    for (const std::string& each : wrap(comment, columns - kIndent - 2)) {
      text += fmt::format("{}# {}\n", blanks(kIndent), each);
    }
    line = line.substr(0, line.find_last_not_of(' ', mark) + 1);
  }
  const std::vector<std::string> pieces = wrap(line, columns - kIndent - 6);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const bool last = i + 1 == pieces.size();
    text += fmt::format("{}{}{}\n", blanks(i == 0 ? kIndent : kIndent + 4), pieces[i], last ? "" : " \\");
  }
  return text;
}

std::string examples(std::string_view all, int columns) {
  std::string text = "\nExamples:\n";
  const std::size_t prose = all.find("\n\n");
  std::string_view rest = all.substr(0, prose);
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    text += example(rest.substr(0, end), columns);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  if (prose != std::string_view::npos) text += '\n' + paragraph(all.substr(prose + 2), 0, columns);
  return text;
}

}  // namespace

int terminal_columns() {
  winsize size{};
  int columns = kUsualColumns;
  std::int64_t given = 0;
  const char* variable = std::getenv("COLUMNS");
  if (variable != nullptr && !read_whole(variable, 1, 10000, given)) {
    columns = static_cast<int>(given);
  } else if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    columns = size.ws_col;
  }
  return std::clamp(columns, kMinColumns, kMaxColumns);
}

std::vector<std::string> wrap(std::string_view text, int width) {
  std::vector<std::string> lines;
  std::string line;
  while (true) {
    const std::size_t begin = text.find_first_not_of(" \n");
    if (begin == std::string_view::npos) break;
    const std::string_view word = text.substr(begin, text.find_first_of(" \n", begin) - begin);
    text.remove_prefix(begin + word.size());
    if (!line.empty() && width_of(line) + 1 + width_of(word) > width) lines.push_back(std::exchange(line, ""));
    if (!line.empty()) line += ' ';
    line += word;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

std::string paragraph(std::string_view text, int indent, int columns) {
  std::string lines;
  for (const std::string& line : wrap(text, columns - indent)) lines += blanks(indent) + line + '\n';
  return lines;
}

std::string hanging(std::string_view name, std::string_view doc, int indent, int columns) {
  const bool narrow = columns - indent < kMinDoc;
  if (narrow) indent = kNarrowIndent;
  const bool fits = 2 + width_of(name) <= columns;
  std::string text = fits ? blanks(2) + std::string(name) + '\n' : paragraph(name, 2, columns);
  std::string lines = paragraph(doc, indent, columns);
  if (narrow || width_of(name) + 4 > indent || lines.empty()) return text + lines;
  text.pop_back();
  return text + lines.substr(static_cast<std::size_t>(2 + width_of(name)));
}

std::string help_text(const OptionTable& table, int columns) {
  std::string text = paragraph(table.description, 0, columns) + '\n' + paragraph(usage(table), 0, columns);
  if (!table.positionals.empty()) text += "\nArguments:\n";
  for (const OptionRow& row : table.positionals) text += hanging(row.names, row.doc, kDocColumn, columns);
  std::string group;
  for (const OptionRow& row : table.options) {
    if (row.group != group) text += '\n' + paragraph(row.group + ":", 0, columns);
    group = row.group;
    text += hanging(row.value.empty() ? row.names : row.names + " " + row.value, row.doc, kDocColumn, columns);
  }
  return text + examples(table.examples, columns);
}

}  // namespace fathom::cli
