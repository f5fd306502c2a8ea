#include "compiler/frontend/formats/print_syntax.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/frontend/formula/formula_text.h"

namespace fathom::compiler::syntax {
namespace {

// Quotes and escapes a string as in JSON.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += fmt::format("\\{}", c);
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

bool is_scalar(const Value& value) {
  return value.data.index() < 4 || std::holds_alternative<ReadFormula>(value.data);
}

// True if the value fits on its property's line: scalars, lists of scalars, and empty records and lists.
bool is_short(const Value& value) {
  if (const auto* record = std::get_if<Record>(&value.data)) return record->properties.empty();
  if (const auto* list = std::get_if<List>(&value.data)) return std::all_of(list->begin(), list->end(), is_scalar);
  return true;
}

std::string print_short(const Value& value) {
  struct Printer {
    const Value& value;
    std::string operator()(std::monostate) const { return "null"; }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(double) const { return number_text(value); }
    std::string operator()(const std::string& text) const { return in_quotes(text); }
    std::string operator()(const List& list) const {
      std::string out;
      for (const Value& item : list) out += (out.empty() ? "" : ", ") + print_short(item);
      return "[" + out + "]";
    }
    std::string operator()(const Record&) const { return "{}"; }
    std::string operator()(const ReadFormula& formula) const {
      std::string out;
      for (const std::string& line : formula_lines(*formula)) out += (out.empty() ? "" : ", ") + in_quotes(line);
      return "[" + out + "]";
    }
  };
  return std::visit(Printer{value}, value.data);
}

std::string print_name(std::string_view name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '$';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), plain) ? std::string(name) : in_quotes(name);
}

void print_lines(const Value& value, std::size_t indent, std::string& out);

// Prints a value after its property's name: on the same line if short, otherwise on the lines below.
void print_after(const Value& value, std::size_t indent, std::string& out) {
  if (is_short(value)) {
    out += " " + print_short(value) + "\n";
    return;
  }
  out += "\n";
  print_lines(value, indent, out);
}

void print_lines(const Value& value, std::size_t indent, std::string& out) {
  if (is_short(value)) {
    out.append(indent, ' ');
    out += print_short(value) + "\n";
  } else if (const auto* record = std::get_if<Record>(&value.data)) {
    for (const Property& property : record->properties) {
      out.append(indent, ' ');
      out += print_name(property.name) + ":";
      print_after(*property.value, indent + 2, out);
    }
  } else {
    for (const Value& item : std::get<List>(value.data)) {
      out.append(indent, ' ');
      out += "-";
      print_after(item, indent + 2, out);
    }
  }
}

}  // namespace

std::string print_syntax(const File& file) {
  std::string out;
  print_lines(file.root, 0, out);
  return out;
}

}  // namespace fathom::compiler::syntax
