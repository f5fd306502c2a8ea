#include "compiler/frontend/formats/write_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/frontend/formula/formula_text.h"

namespace fathom::compiler {
namespace {

constexpr std::size_t kWidestLine = 120;  // columns, for lines that can be broken

// Quotes a string. Control characters need no escapes, because the readers reject them.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string scalar(const syntax::Value& value) {
  if (const auto* truth = std::get_if<bool>(&value.data)) return *truth ? "true" : "false";
  if (const auto* number = std::get_if<double>(&value.data)) {
    // Without the point, -0 would be read back as an integer, which has no sign.
    return *number == 0 && std::signbit(*number) ? "-0.0" : number_text(value);
  }
  if (const auto* text = std::get_if<std::string>(&value.data)) return quoted(*text);
  return "null";
}

// Returns an already parsed formula as a string or a list of strings.
syntax::Value as_strings(const Formula& formula, Span span) {
  std::vector<std::string> lines = formula_lines(formula);
  if (lines.size() == 1) return {span, std::move(lines[0])};
  syntax::List list;
  for (std::string& line : lines) list.push_back({span, std::move(line)});
  return {span, std::move(list)};
}

// Access to the parts of a record or list, and to the text before each part.
std::size_t parts(const syntax::Value& value) {
  if (const auto* list = std::get_if<syntax::List>(&value.data)) return list->size();
  if (const auto* record = std::get_if<syntax::Record>(&value.data)) return record->properties.size();
  return 0;
}
const syntax::Value& part(const syntax::Value& value, std::size_t i) {
  if (const auto* list = std::get_if<syntax::List>(&value.data)) return (*list)[i];
  return *std::get<syntax::Record>(value.data).properties[i].value;
}
std::string lead(const syntax::Value& value, std::size_t i) {
  const auto* record = std::get_if<syntax::Record>(&value.data);
  return record ? quoted(record->properties[i].name) + ": " : "";
}
bool is_record(const syntax::Value& value) { return std::holds_alternative<syntax::Record>(value.data); }
bool is_scalar(const syntax::Value& value) {
  return !is_record(value) && !std::holds_alternative<syntax::List>(value.data);
}

// Prints the value on one line, or returns nullopt if the line needs more than `room` columns.
std::optional<std::string> on_one_line(const syntax::Value& value, std::size_t room) {
  if (const auto* formula = std::get_if<syntax::ReadFormula>(&value.data)) {
    return on_one_line(as_strings(**formula, value.span), room);
  }
  std::string out;
  if (is_scalar(value)) {
    out = scalar(value);
  } else {
    out = is_record(value) ? "{" : "[";
    for (std::size_t i = 0; i < parts(value); ++i) {
      out += (i > 0 ? ", " : "") + lead(value, i);
      if (out.size() > room) return std::nullopt;
      const auto inner = on_one_line(part(value, i), room - out.size());
      if (!inner) return std::nullopt;
      out += *inner;
    }
    out += is_record(value) ? "}" : "]";
  }
  return out.size() <= room ? std::optional(std::move(out)) : std::nullopt;
}

// Returns the offset in the source where part i begins.
std::uint32_t place_of_part(const syntax::Value& value, std::size_t i) {
  const auto* record = std::get_if<syntax::Record>(&value.data);
  return record ? record->properties[i].name_span.begin : part(value, i).span.begin;
}

class JsonWriter {
 public:
  explicit JsonWriter(JsonComments comments) : comments_(std::move(comments)) {}

  void write(const syntax::Value& value, std::size_t indent, std::size_t used, std::string& out) {
    if (const auto* formula = std::get_if<syntax::ReadFormula>(&value.data)) {
      return write(as_strings(**formula, value.span), indent, used, out);
    }
    const std::size_t room = kWidestLine - std::min(kWidestLine, indent + used);
    // Always break the root record into lines, for readability.
    const auto line = indent == 0 || is_commented(value, indent) ? std::nullopt : on_one_line(value, room);
    if (line || is_scalar(value)) {
      out += line ? *line : scalar(value);
      return;
    }
    out += is_record(value) ? "{\n" : "[\n";
    for (std::size_t i = 0; i < parts(value); ++i) {
      if (indent <= kDeepestComment) write_comments(place_of_part(value, i), indent + 2, out);
      out.append(indent + 2, ' ');
      const std::string name = lead(value, i);
      out += name;
      write(part(value, i), indent + 2, name.size() + 1, out);
      out += i + 1 < parts(value) ? ",\n" : "\n";
    }
    out.append(indent, ' ');
    out += is_record(value) ? '}' : ']';
  }

 private:
  // Maximum indentation, in columns, of values with comments: the tables of the scene.
  static constexpr std::size_t kDeepestComment = 2;

  bool is_commented(const syntax::Value& value, std::size_t indent) const {
    if (indent > kDeepestComment || comments_.empty()) return false;
    for (std::size_t i = 0; i < parts(value); ++i) {
      if (comments_.contains(place_of_part(value, i))) return true;
    }
    return false;
  }

  void write_comments(std::uint32_t place, std::size_t indent, std::string& out) {
    const auto [first, last] = comments_.equal_range(place);
    for (auto comment = first; comment != last; ++comment) {
      out.append(indent, ' ');
      out += comment->second + "\n";
    }
    comments_.erase(first, last);
  }

  JsonComments comments_;  // not written yet
};

}  // namespace

std::string write_json(const syntax::File& file, const JsonComments& comments) {
  std::string out;
  JsonWriter(comments).write(file.root, 0, 0, out);
  return out + "\n";
}

}  // namespace fathom::compiler
