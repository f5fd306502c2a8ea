#include "compiler/source/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "vm/encoding/printable.h"

namespace fathom::compiler {
namespace {

// maximum of printed errors, and of printed warnings: a person reads as many in one go
constexpr std::size_t kMaxPrinted = 20;
constexpr std::size_t kWidestQuote = 140;  // columns of a quoted line, which is cut around the carets if longer
constexpr std::size_t kLead = 50;          // columns kept before the carets of a cut line
constexpr std::size_t kTabWidth = 4;

// Maximum bytes of a message, a label or a line of help: names and numbers can be as long as the file.
constexpr std::size_t kMaxBytes = 2000;
constexpr std::size_t kWindow = 4096;  // bytes of a line that are considered on either side of the carets

// Returns the text made printable on a terminal and cut to kMaxBytes at the boundary of a character.
std::string shown(std::string_view from) {
  std::string text = vm::printable(from);
  if (text.size() <= kMaxBytes) return text;
  std::size_t end = kMaxBytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  text.resize(end);
  return text + "...";
}

struct Style {
  const char *error = "", *warning = "", *gutter = "", *strong = "", *off = "";
};

Style style(bool color) {
  if (!color) return {};
  return {"\x1b[1;31m", "\x1b[1;33m", "\x1b[1;34m", "\x1b[1m", "\x1b[0m"};
}

const char* word(Severity severity) { return severity == Severity::Error ? "error" : "warning"; }

bool nowhere(Span span) { return span.begin == 0 && span.end == 0; }

// A source line as displayed, in cells of one column each. Tabs become blanks, and characters that a terminal must
// not receive become U+FFFD.
struct Shown {
  std::vector<std::string_view> cells;
  std::vector<std::uint32_t> bytes;  // offset within the line of each cell's character

  explicit Shown(std::string_view line) {
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t length = vm::printable_length(line.substr(at));
      const std::string_view cell = line[at] == '\t' ? std::string_view(" ")
                                    : length == 0    ? std::string_view("\uFFFD")
                                                     : line.substr(at, length);
      const std::size_t columns = line[at] == '\t' ? kTabWidth : 1;
      cells.insert(cells.end(), columns, cell);
      bytes.insert(bytes.end(), columns, static_cast<std::uint32_t>(at));
      at += std::max<std::size_t>(length, 1);
    }
  }

  // Returns the first column at or after a byte of the line.
  std::size_t column(std::uint32_t byte) const {
    return static_cast<std::size_t>(std::lower_bound(bytes.begin(), bytes.end(), byte) - bytes.begin());
  }
  std::string text(std::size_t first, std::size_t last) const {
    std::string out;
    for (std::size_t i = first; i < last; ++i) out += cells[i];
    return out;
  }
};

// Returns the quoted line and the carets under it, without the gutter, both cut to kWidestQuote columns around the
// carets.
std::pair<std::string, std::string> quote(std::string_view line, std::uint32_t line_start, Span span) {
  // Considers only the part of a long line that can be shown.
  const std::size_t at = span.begin - line_start, from = at > kWindow ? at - kWindow : 0;
  line = line.substr(std::min(from, line.size()), 2 * kWindow);
  line_start += static_cast<std::uint32_t>(from);
  const Shown shown(line);
  const std::size_t begin = shown.column(span.begin - line_start);
  const std::size_t end = std::max(begin + 1, shown.column(std::max(span.end, span.begin) - line_start));
  if (shown.cells.size() <= kWidestQuote) {
    const std::size_t last = std::max(begin + 1, std::min(end, shown.cells.size()));
    return {shown.text(0, shown.cells.size()), std::string(begin, ' ') + std::string(last - begin, '^')};
  }
  const std::size_t first = std::min(begin > kLead ? begin - kLead : 0, shown.cells.size() - kWidestQuote);
  const std::size_t last = first + kWidestQuote;
  const std::string before = first > 0 ? "..." : "", after = last < shown.cells.size() ? "..." : "";
  const std::size_t carets = std::max(begin + 1, std::min(end, last)) - begin;
  return {before + shown.text(first, last) + after,
          std::string(before.size() + begin - first, ' ') + std::string(carets, '^')};
}

std::string times(std::size_t count) { return count == 1 ? "once" : fmt::format("{} times", count); }

std::string print_text(const Diagnostic& d, const std::vector<std::string>& calls, const Source& source,
                       const Style& s) {
  std::string out = fmt::format("{}{}[{}]{}{}: {}{}\n", d.severity == Severity::Error ? s.error : s.warning,
                                word(d.severity), d.code, s.off, s.strong, d.message, s.off);
  std::string margin = "  ";  // as wide as the gutter: the line number and a blank on either side
  if (nowhere(d.span)) {
    out += fmt::format("{}{}-->{} {}\n", margin, s.gutter, s.off, shown(source.name()));
    margin += ' ';
  } else {
    const Source& file = source.file(d.span.begin);
    const Position at = source.locate(d.span.begin);
    const std::uint32_t start =
        file.base() + static_cast<std::uint32_t>(file.line(at.line).data() - file.text().data());
    const auto [line, carets] = quote(file.line(at.line), start, d.span);
    const std::string number = std::to_string(at.line);
    margin = std::string(number.size() + 2, ' ');
    const std::string_view severity = d.severity == Severity::Error ? s.error : s.warning;
    out += fmt::format("{}{}-->{} {}\n", margin.substr(1), s.gutter, s.off, shown(source.place(d.span.begin)));
    out += fmt::format("{}{}|{}\n", margin, s.gutter, s.off);
    out += fmt::format("{} {} |{}{}{}\n", s.gutter, number, s.off, line.empty() ? "" : " ", line);
    out += fmt::format("{}{}|{} {}{}{}{}{}\n", margin, s.gutter, s.off, severity, carets, d.label.empty() ? "" : " ",
                       d.label, s.off);
  }
  for (const std::string& help : d.help) {
    out += fmt::format("{}{}={} {}help{}: {}\n", margin, s.gutter, s.off, s.strong, s.off, help);
  }
  for (const std::string& call : calls) out += fmt::format("{}{}={} {}\n", margin, s.gutter, s.off, call);
  if (d.again > 0)
    out += fmt::format("{}{}={} and {} more in calls and loops\n", margin, s.gutter, s.off, times(d.again));
  return out;
}

std::string print_short(const Diagnostic& d, const Source& source) {
  const std::string place = nowhere(d.span) ? source.name() : source.place(d.span.begin);
  return fmt::format("{}: {}: {} [{}]\n", shown(place), word(d.severity), d.message, d.code);
}

std::string json_line(const nlohmann::ordered_json& json) {
  return vm::escape_controls(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

std::string print_json(const Diagnostic& d, const std::vector<std::string>& calls, const Source& source) {
  nlohmann::ordered_json json = {{"severity", word(d.severity)},
                                 {"code", d.code},
                                 {"message", d.message},
                                 {"file", source.file(d.span.begin).name()}};
  if (!nowhere(d.span)) {
    const Position begin = source.locate(d.span.begin), end = source.locate(d.span.end);
    const std::uint32_t base = source.file(d.span.begin).base();
    json["line"] = begin.line;
    json["column"] = begin.column;
    json["end_line"] = end.line;
    json["end_column"] = end.column;
    json["begin_byte"] = d.span.begin - base;
    json["end_byte"] = d.span.end - base;
  }
  json["label"] = d.label;
  json["help"] = d.help;
  if (!calls.empty()) json["calls"] = calls;
  if (d.again > 0) json["again"] = d.again;
  return json_line(json);
}

std::string print_rest(std::size_t count, const Source& source, ErrorFormat format) {
  const std::string message = fmt::format("and {} more error{}", count, count == 1 ? "" : "s");
  switch (format) {
    case ErrorFormat::Text:
      return "\n" + message + "\n";
    case ErrorFormat::Short:
      return fmt::format("{}: {}\n", shown(source.name()), message);
    case ErrorFormat::Json:
      break;
  }
  return json_line({{"severity", "note"}, {"message", message}, {"file", source.name()}});
}

}  // namespace

void Diagnostics::add(Diagnostic d) {
  d.message = shown(d.message);
  d.label = shown(d.label);
  for (std::string& help : d.help) help = shown(help);
  all_.push_back(std::move(d));
}

// True if the same error was reported at the same place, which counts its repetitions: a mistake in a loop is
// reported once. The values that a scene shows (W0407) are reported each time.
bool Diagnostics::count_known(const std::string& code, Span span) {
  if (span.trace == 0 || code == "W0407") return false;
  const auto known = std::ranges::find_if(all_, [&](const Diagnostic& d) {
    return d.code == code && d.span.begin == span.begin && d.span.end == span.end;
  });
  if (known == all_.end()) return false;
  ++known->again;
  return true;
}

// Describes the calls and loops that led to the diagnostic, the innermost first.
std::vector<std::string> Diagnostics::calls(const Diagnostic& d, const Source& source) const {
  constexpr std::size_t kMaxCalls = 8;
  std::vector<std::string> lines;
  // A span can carry the trace number of another Diagnostics object.
  for (std::uint32_t number = d.span.trace; number > 0 && number <= traces_.size();
       number = traces_[number - 1].outside) {
    if (lines.size() == kMaxCalls) {
      lines.emplace_back("and more calls around these");
      break;
    }
    const Trace& trace = traces_[number - 1];
    const std::string_view name = source.excerpt(trace.name);
    const std::string place = shown(source.place(trace.at.begin));
    lines.push_back(!trace.loop ? fmt::format("in `{}`, called at {}", name, place)
                    : std::isnan(trace.value)
                        ? fmt::format("in the loop over `{}` at {}", name, place)
                        : fmt::format("in the loop at {}, with {} = {}", place, name, trace.value));
  }
  return lines;
}

void Diagnostics::error(std::string code, Span span, std::string message, std::string label,
                        std::vector<std::string> help) {
  ++errors_;
  if (count_known(code, span)) {
    ++repeated_;
    return;
  }
  if (errors_ - repeated_ > kMaxKept) return;
  add({Severity::Error, std::move(code), std::move(message), span, std::move(label), std::move(help)});
}

void Diagnostics::warning(std::string code, Span span, std::string message, std::string label,
                          std::vector<std::string> help) {
  if (count_known(code, span) || ++warnings_ > kMaxKept) return;
  add({Severity::Warning, std::move(code), std::move(message), span, std::move(label), std::move(help)});
}

void Diagnostics::append(const Diagnostics& of_text, std::uint32_t base) {
  for (const Diagnostic& d : of_text.all_) {
    if (d.severity == Severity::Warning) continue;
    error(d.code, {d.span.begin + base, d.span.end + base}, d.message, d.label, d.help);
  }
}

std::string Diagnostics::print(const Source& source, ErrorFormat format, bool color) const {
  std::vector<const Diagnostic*> sorted;
  for (const Diagnostic& d : all_) sorted.push_back(&d);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Diagnostic* a, const Diagnostic* b) { return a->span.begin < b->span.begin; });
  std::string out;
  std::size_t printed_errors = 0, printed_warnings = 0;
  for (const Diagnostic* d : sorted) {
    std::size_t& printed = d->severity == Severity::Error ? printed_errors : printed_warnings;
    if (printed == kMaxPrinted) continue;
    ++printed;
    if (format == ErrorFormat::Text && !out.empty()) out += "\n";
    if (format == ErrorFormat::Text) out += print_text(*d, calls(*d, source), source, style(color));
    if (format == ErrorFormat::Short) out += print_short(*d, source);
    if (format == ErrorFormat::Json) out += print_json(*d, calls(*d, source), source);
  }
  const std::size_t rest = errors_ - repeated_ - printed_errors;
  if (rest > 0) out += print_rest(rest, source, format);
  return out;
}

}  // namespace fathom::compiler
