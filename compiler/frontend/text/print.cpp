#include "compiler/frontend/text/print.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "compiler/frontend/formula/formula.h"
#include "compiler/frontend/formula/formula_lexer.h"
#include "compiler/frontend/formula/formula_parser.h"
#include "compiler/frontend/formula/formula_text.h"
#include "compiler/frontend/records/color_text.h"
#include "compiler/frontend/text/parse/token_cursor.h"
#include "compiler/frontend/text/parse/vocabulary.h"
#include "compiler/frontend/text/print_lines.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler::text {
namespace {

using syntax::Property;
using SyntaxRecord = syntax::Record;
using SyntaxValue = syntax::Value;

constexpr std::size_t kMaxOperands = 8;  // operands of an operator chain; longer chains are printed as calls

bool is_no_name(std::string_view word) {
  return is_reserved(word) || word == "x" || word == "y" || word == "z" || formula_constant(word);
}

struct InfixWord {
  std::string_view type;
  char mark;
  std::string_view blend;  // name of the blend width inside {}; empty without a blend
};
constexpr InfixWord kInfixWords[] = {
    {"union", '+', ""},
    {"subtraction", '-', ""},
    {"intersection", '&', ""},
    {"smooth_union", '+', "k"},
    {"smooth_subtraction", '-', "k"},
    {"smooth_intersection", '&', "k"},
    {"chamfer_union", '+', "chamfer"},
    {"chamfer_subtraction", '-', "chamfer"},
    {"chamfer_intersection", '&', "chamfer"},
    {"round_union", '+', "round"},
    {"round_subtraction", '-', "round"},
    {"round_intersection", '&', "round"},
    {"stairs_union", '+', "stairs"},
    {"stairs_subtraction", '-', "stairs"},
    {"stairs_intersection", '&', "stairs"},
};

std::string quoted_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

const SyntaxRecord* as_record(const SyntaxValue* value) {
  return value ? std::get_if<SyntaxRecord>(&value->data) : nullptr;
}
const SyntaxValue* find_value(const SyntaxRecord& record, std::string_view name) {
  const Property* found = record.find(name);
  return found ? found->value.get() : nullptr;
}
std::string text_in(const SyntaxRecord& record, std::string_view name) {
  const SyntaxValue* value = find_value(record, name);
  const auto* text = value ? std::get_if<std::string>(&value->data) : nullptr;
  return text ? *text : "";
}

// Printed expression. An operator chain (a row) needs parentheses inside other expressions.
struct Printed {
  std::string text;
  bool is_row = false;
  std::string atom() const { return is_row ? "(" + text + ")" : text; }
};

class TextPrinter {
 public:
  explicit TextPrinter(const SyntaxRecord& root) : root_(root) {
    choose_names("params", params_);
    choose_names("materials", materials_);
    choose_names("nodes", nodes_);
  }

  std::vector<PrintedStatement> statements() {
    add_params();
    for (const char* part : {"camera", "film", "render", "background"}) add_part(part);
    add_entries("materials", materials_, [&](const SyntaxValue& value) { return call_text(*as_record(&value)); });
    add_lights();
    add_entries("nodes", nodes_, [&](const SyntaxValue& value) { return node(value).text; });
    const SyntaxValue* objects = find_value(root_, "objects");
    for (const SyntaxValue& object : std::get<syntax::List>(objects->data)) add_object(object);
    return std::move(out_);
  }

 private:
  using Chosen = std::map<std::string, std::string, std::less<>>;

  void choose_names(const char* table, Chosen& chosen) {
    const SyntaxRecord* record = as_record(find_value(root_, table));
    if (record == nullptr) return;
    for (const Property& entry : record->properties) chosen.emplace(entry.name, free_name(entry.name));
  }

  std::string free_name(const std::string& label) {
    std::string name;
    for (const char c : label) {
      const bool fits = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c >= '0' && c <= '9');
      if (fits || (!name.empty() && name.back() != '_')) name += fits ? c : '_';
    }
    if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name = "_" + name;
    if (is_no_name(name)) name += "_";
    std::string candidate = name;
    for (int i = 2; !taken_.insert(candidate).second; ++i) candidate = fmt::format("{}_{}", name, i);
    return candidate;
  }

  // `let name "label"`, with the label only if it differs from the name.
  static std::string head(const char* word, const std::string& label, const std::string& name) {
    return label == name ? fmt::format("{} {}", word, name) : fmt::format("{} {} {}", word, name, quoted_text(label));
  }

  void add(std::string_view group, std::string text, Span span) {
    out_.push_back({group, std::move(text), span, {}, {}});
  }

  void add_params() {
    const SyntaxRecord* params = as_record(find_value(root_, "params"));
    if (params == nullptr) return;
    for (const Property& entry : params->properties) {
      std::string line = head("param", entry.name, params_.at(entry.name));
      const SyntaxValue* value = entry.value.get();
      if (const SyntaxRecord* record = as_record(value)) {
        std::string fields;
        for (const Property& field : record->properties) {
          if (field.name == "default") continue;
          fields += (fields.empty() ? "" : ", ") + field.name + " = " + value_text(*field.value, field.name == "doc");
        }
        line += "(" + fields + ")";
        value = find_value(*record, "default");
      }
      add("params", line + " = " + value_text(*value), {entry.name_span.begin, entry.value->span.end});
    }
  }

  void add_part(const char* part) {
    const Property* property = root_.find(part);
    if (property == nullptr) return;
    const SyntaxRecord* record = as_record(property->value.get());
    const std::string text = record ? call_text(*record) : value_text(*property->value);
    add(part, fmt::format("{} {}", part, text), {property->name_span.begin, property->value->span.end});
  }

  template <class Print>
  void add_entries(const char* table, const Chosen& chosen, const Print& print) {
    const SyntaxRecord* record = as_record(find_value(root_, table));
    if (record == nullptr) return;
    for (const Property& entry : record->properties) {
      add(table, head("let", entry.name, chosen.at(entry.name)) + " = " + print(*entry.value),
          {entry.name_span.begin, entry.value->span.end});
    }
  }

  void add_lights() {
    const SyntaxRecord* record = as_record(find_value(root_, "lights"));
    if (record == nullptr) return;
    for (const Property& entry : record->properties) {
      add("lights", fmt::format("light {} {}", quoted_text(entry.name), call_text(*as_record(entry.value.get()))),
          {entry.name_span.begin, entry.value->span.end});
    }
  }

  void add_object(const SyntaxValue& object) {
    const SyntaxRecord& record = *as_record(&object);
    const std::string name = text_in(record, "name");
    const std::string text = node(object, true).text;
    add("objects", name.empty() ? "object " + text : fmt::format("object {} {}", quoted_text(name), text),
        object.span);
  }

  // Prints word(name = value, ...), or (name = value, ...) for a record without a type.
  std::string call_text(const SyntaxRecord& record) {
    std::string word = text_in(record, "type"), fields;
    const std::string pattern = text_in(record, "pattern");
    if (!pattern.empty()) word = pattern;
    for (const Property& property : record.properties) {
      if (property.name == "type" || property.name == "pattern") continue;
      const bool is_text = property.name == "file" || property.name == "preset";
      fields += (fields.empty() ? "" : ", ") + property.name + " = " +
                value_text(*property.value, is_text || is_choice(record, property));
    }
    return word + "(" + fields + ")";
  }

  // True if the property's string is a word, not a formula.
  static bool is_choice(const SyntaxRecord& record, const Property& property) {
    for (const auto* family :
         {&camera_records(), &light_records(), &background_records(), &material_records(), &pattern_records()}) {
      for (const RecordSpec& row : *family) {
        if (text_in(record, "type") != row.type && text_in(record, "pattern") != row.type) continue;
        const PropertySpec* spec = row.find(property.name);
        if (spec) return spec->type == ValueType::Choice || spec->type == ValueType::Text;
      }
    }
    for (const RecordSpec* row : {&film_record(), &render_record()}) {
      const PropertySpec* spec = row->find(property.name);
      if (spec && spec->type == ValueType::Choice) return true;
    }
    return false;
  }

  std::string value_text(const SyntaxValue& value, bool is_text = false) {
    if (const auto* truth = std::get_if<bool>(&value.data)) return *truth ? "true" : "false";
    if (std::holds_alternative<double>(value.data)) return number_text(value);
    if (const auto* text = std::get_if<std::string>(&value.data)) {
      return is_text || text->starts_with('#') ? quoted_text(*text) : formula_text(*text);
    }
    if (const auto* formula = std::get_if<syntax::ReadFormula>(&value.data))
      return lines_text(formula_lines(**formula));
    if (const auto* record = std::get_if<SyntaxRecord>(&value.data)) return call_text(*record);
    std::string out;
    for (const SyntaxValue& part : std::get<syntax::List>(value.data))
      out += (out.empty() ? "" : ", ") + value_text(part, is_text);
    return "[" + out + "]";
  }

  // Replaces the names of parameters by their names in the text.
  std::string formula_text(const std::string& formula) const {
    std::string out;
    std::size_t copied = 0;
    FormulaLexer lexer(formula);
    for (compiler::Token token = lexer.next(); token.kind != compiler::Token::Kind::End; token = lexer.next()) {
      const auto found = token.kind == compiler::Token::Kind::Name ? params_.find(token.text) : params_.end();
      if (found == params_.end()) continue;
      const auto at = static_cast<std::size_t>(token.text.data() - formula.data());
      out += formula.substr(copied, at - copied) + found->second;
      copied = at + token.text.size();
    }
    return out + formula.substr(copied);
  }

  std::string lines_text(const std::vector<std::string>& lines) const {
    std::string out;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) out += fmt::format("let {} ", formula_text(lines[i]));
    return out.empty() ? formula_text(lines[0]) : out + "in " + formula_text(lines.back());
  }

  // Prints a node's formula, which is a string or a list of lines.
  std::string formula_value(const SyntaxValue& value) {
    const auto* list = std::get_if<syntax::List>(&value.data);
    if (list == nullptr) return value_text(value);
    std::vector<std::string> lines;
    for (const SyntaxValue& line : *list) lines.push_back(std::get<std::string>(line.data));
    return lines_text(lines);
  }

  Printed node(const SyntaxValue& value, bool is_object = false) {
    const SyntaxRecord& record = *as_record(&value);
    Printed out = record.find("use") ? Printed{nodes_.at(text_in(record, "use"))} : made(record);
    for (const char* placement : {"scale", "rotate", "translate"}) {
      const SyntaxValue* given = find_value(record, placement);
      if (given == nullptr) continue;
      const SyntaxRecord* turn = as_record(given);
      const std::string argument = turn ? call_text(*turn) : "(" + value_text(*given) + ")";
      out = {out.atom() + "." + placement + argument};
    }
    const std::string material = text_in(record, "material"), name = text_in(record, "name");
    if (!material.empty()) {
      const auto known = materials_.find(material);
      out = {fmt::format("{}.material({})", out.atom(),
                         known == materials_.end() ? quoted_text(material) : known->second)};
    }
    if (!name.empty() && !is_object) out = {fmt::format("{}.name({})", out.atom(), quoted_text(name))};
    return out;
  }

  // Prints a node of a type, without its placement.
  Printed made(const SyntaxRecord& record) {
    const std::string type = text_in(record, "type");
    const NodeSpec& spec = *find_node(type);
    const SyntaxValue* of = find_value(record, "of");
    const auto* list = of ? std::get_if<syntax::List>(&of->data) : nullptr;
    if (list) return combined(record, spec, *list);
    std::string arguments;
    const std::vector<std::string_view>& order = positional(spec);
    std::size_t without_name = 0;
    while (without_name < order.size() && record.find(order[without_name])) ++without_name;
    for (std::size_t i = 0; i < without_name; ++i) {
      if (order[i] != "of") arguments += (arguments.empty() ? "" : ", ") + parameter(spec, *record.find(order[i]));
    }
    arguments += named(record, spec, std::span(order).first(without_name), !arguments.empty());
    return {of ? fmt::format("{}.{}({})", node(*of).atom(), type, arguments)
               : fmt::format("{}({})", type, arguments)};
  }

  std::string parameter(const NodeSpec& spec, const Property& property) {
    const auto found = std::ranges::find(spec.params, property.name, &ParamSpec::name);
    const bool formula = found != spec.params.end() && found->type == ParamType::Formula;
    return formula ? formula_value(*property.value) : value_text(*property.value);
  }

  // Prints the named properties, except those common to all nodes.
  std::string named(const SyntaxRecord& record, const NodeSpec& spec, std::span<const std::string_view> done,
                    bool comma) {
    constexpr std::string_view kCommon[] = {"type", "of", "scale", "rotate", "translate", "material", "name"};
    std::string out;
    for (const Property& property : record.properties) {
      if (std::ranges::find(kCommon, property.name) != std::end(kCommon)) continue;
      if (std::ranges::find(done, property.name) != done.end()) continue;
      out += (comma || !out.empty() ? ", " : "") + property.name + " = " + parameter(spec, property);
    }
    return out;
  }

  Printed combined(const SyntaxRecord& record, const NodeSpec& spec, const syntax::List& of) {
    std::vector<std::string> operands;
    for (const SyntaxValue& part : of) operands.push_back(node(part).atom());
    const auto* row = std::ranges::find(kInfixWords, spec.name, &InfixWord::type);
    if (row != std::end(kInfixWords) && operands.size() > 1 && operands.size() <= kMaxOperands) {
      const std::string blend = blend_text(record, spec, *row);
      return {fmt::format("{}", fmt::join(operands, fmt::format(" {}{} ", row->mark, blend))), true};
    }
    return {fmt::format("{}({}{})", spec.name, fmt::join(operands, ", "), named(record, spec, {}, true))};
  }

  // Prints the blend of an operator, such as {0.1}, {round = 0.1} or {stairs = 0.1, steps = 3}.
  std::string blend_text(const SyntaxRecord& record, const NodeSpec& spec, const InfixWord& row) {
    if (row.blend.empty()) return "";
    std::string out;
    for (const Property& property : record.properties) {
      const bool width = property.name == "k" || property.name == "radius";
      if (!width && std::ranges::find(spec.params, property.name, &ParamSpec::name) == spec.params.end()) continue;
      const std::string name =
          width && row.blend == "k" ? "" : (width ? std::string(row.blend) : property.name) + " = ";
      out += (out.empty() ? "" : ", ") + name + value_text(*property.value);
    }
    return "{" + out + "}";
  }

  const SyntaxRecord& root_;
  Chosen params_, materials_, nodes_;  // names in the text, by name in the scene
  std::set<std::string> taken_;
  std::vector<PrintedStatement> out_;
};

}  // namespace

std::string print_text(const syntax::File& file, const Source& source) {
  return print_lines(TextPrinter(*as_record(&file.root)).statements(), source);
}

}  // namespace fathom::compiler::text
