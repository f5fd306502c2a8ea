#include "tests/support/random/random_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/make_syntax.h"

namespace fathom::test {
namespace {

using namespace fathom::compiler;
using syntax::List;
using syntax::Value;

constexpr std::array kOddNames = {"ball",  "a ball", "for",  "let",   "6 in", "x",   "pi",  "a\"b", "a\\b", "\u00E4",
                                  "ball_", "table",  "if",   "a/*b",  "//",   "_",   "e",   "sphere", "a-b", "fold"};

class Drawer {
 public:
  explicit Drawer(Random& random) : random_(random) {}

  syntax::File draw() {
    RecordMaker root{Span{}};
    root.add("version", 1.0);
    if (random_.chance(0.7)) root.add("params", params());
    if (random_.chance(0.5)) root.add("camera", row(pick(camera_records()), "type"));
    if (random_.chance(0.4)) root.add("film", row(film_record(), ""));
    if (random_.chance(0.4)) root.add("render", row(render_record(), ""));
    if (random_.chance(0.5)) {
      root.add("background", random_.chance(0.5) ? row(pick(background_records()), "type") : numbers(3, false));
    }
    if (random_.chance(0.4)) root.add("lights", named(light_names_, [&] { return row(pick(light_records()), "type"); }));
    if (random_.chance(0.8)) {
      root.add("materials", named(material_names_, [&] { return row(pick(material_records()), "type"); }));
    }
    if (random_.chance(0.7)) root.add("nodes", named(node_names_, [&] { return node(3); }));
    List objects;
    for (int i = random_.below(4); i >= 0; --i) objects.push_back(node(4));
    return {root.add("objects", Value{{}, std::move(objects)}).take()};
  }

 private:
  template <class T>
  const T& pick(const std::vector<T>& from) {
    return from[static_cast<std::size_t>(random_.below(static_cast<int>(from.size())))];
  }

  std::string odd_name() { return kOddNames[static_cast<std::size_t>(random_.below(kOddNames.size()))]; }

  // Random parameters. The parameters' names must be valid in formulas. Some names are words of the language.
  Value params() {
    RecordMaker record{Span{}};
    for (const char* name : {"r", "t1", "gap", "diffuse", "ball", "for", "in"}) {
      if (!record.empty() && random_.chance(0.5)) continue;
      if (random_.chance(0.5)) {
        record.add(name, finite());
      } else {
        RecordMaker options{Span{}};
        options.add("default", finite());
        if (random_.chance(0.5)) options.add("min", -1e18);
        if (random_.chance(0.5)) options.add("doc", "a \"quoted\" text");
        record.add(name, options.take());
      }
      params_.push_back(name);
    }
    return record.take();
  }

  template <class Make>
  Value named(std::vector<std::string>& names, const Make& make) {
    RecordMaker record{Span{}};
    for (int i = random_.below(4); i >= 0; --i) {
      const std::string name = odd_name();
      if (std::ranges::find(names, name) != names.end()) continue;
      record.add(name, make());
      names.push_back(name);
    }
    return record.take();
  }

  // Random record of the table's properties, with about half of the optional ones.
  Value row(const RecordSpec& spec, std::string_view key) {
    RecordMaker record{Span{}};
    if (!key.empty() && (!spec.type.empty() && (spec.find(key)->required || random_.chance(0.7)))) {
      record.add(key, spec.type);
    }
    for (const PropertySpec& property : spec.properties) {
      if (property.name == key || (!property.required && random_.chance(0.6))) continue;
      if (auto value = property_value(property)) record.add(property.name, *std::move(value));
    }
    return record.take();
  }

  std::optional<Value> property_value(const PropertySpec& property) {
    if (property.varies && patterns_ < 3 && random_.chance(0.3)) return pattern();
    switch (property.type) {
      case ValueType::Number:
      case ValueType::Integer:
        return number(property.varies);
      case ValueType::Seed: {
        const std::uint64_t seed = random_.bits();
        return Value{{}, static_cast<double>(seed), seed};
      }
      case ValueType::Vec2:
        return numbers(2, false);
      case ValueType::Vec3:
      case ValueType::Translation:
      case ValueType::Background:
        return numbers(3, false);
      case ValueType::Scale:
        return random_.chance(0.5) ? number(false) : numbers(3, false);
      case ValueType::Color:
        if (random_.chance(0.2)) return Value{{}, std::string("#c04020")};
        return random_.chance(0.5) ? number(property.varies) : numbers(3, property.varies);
      case ValueType::Boolean:
        return Value{{}, random_.chance(0.5)};
      case ValueType::Choice:
        return Value{{}, std::string(pick(property.choices))};
      case ValueType::Text:
        return Value{{}, odd_name()};
      case ValueType::Points:
        return points();
      case ValueType::Rotation:
        if (random_.chance(0.5)) return numbers(3, false);
        return RecordMaker(Span{}).add("axis", numbers(3, false)).add("angle", number(false)).take();
      case ValueType::Formula:
        return formula();
      default:
        return std::nullopt;
    }
  }

  // Random pattern. Patterns nest up to a depth limit.
  Value pattern() {
    ++patterns_;
    Value made = row(pick(pattern_records()), "pattern");
    --patterns_;
    return made;
  }

  Value points() {
    List list;
    for (int i = 3 + random_.below(3); i > 0; --i) list.push_back(numbers(2, false));
    return {{}, std::move(list)};
  }

  Value numbers(int count, bool may_vary) {
    List list;
    for (int i = 0; i < count; ++i) list.push_back(number(may_vary));
    return {{}, std::move(list)};
  }

  // Random number, or a formula as a string.
  Value number(bool may_vary) {
    if (random_.chance(0.75)) return {{}, plain()};
    return {{}, expression(3, may_vary)};
  }
  double plain() {
    constexpr std::array kPlain = {0.0, 1.0, -1.0, 0.5, 1e-9, 3.25e17, -0.0, 0.1, 2.0 / 3, 100.0, -12.5};
    return kPlain[static_cast<std::size_t>(random_.below(kPlain.size()))];
  }

  // Random finite number, or a formula of constants, as parameters require.
  Value finite() {
    if (random_.chance(0.5)) return {{}, plain()};
    return {{}, fmt::format("{}/2 + ({} - 1)/4", atom(false), atom(false))};
  }

  // One expression, or definitions followed by an expression.
  Value formula() {
    if (random_.chance(0.6)) return {{}, expression(4, true)};
    List lines;
    locals_ = {};
    for (const char* name : {"d", "s"}) {
      lines.push_back({{}, fmt::format("{} = {}", name, expression(3, true))});
      locals_.push_back(name);
    }
    lines.push_back({{}, expression(4, true) + " - d*s"});
    locals_ = {};
    return {{}, std::move(lines)};
  }

  std::string expression(int depth, bool varies) {
    if (depth == 0) return atom(varies);
    const auto inner = [&] { return expression(depth - 1, varies); };
    switch (random_.below(9)) {
      case 0:
        return fmt::format("({})", inner());
      case 1:
        return fmt::format("-{}", atom(varies));
      case 2:
        return fmt::format("{}^{}", atom(varies), random_.chance(0.5) ? "2" : "-(1/2)");
      case 3:
        return fmt::format("{} + {}", inner(), atom(varies));
      case 4:
        return fmt::format("{} - ({})", inner(), inner());
      case 5:
        return fmt::format("{}*{}", atom(varies), atom(varies));
      case 6:
        return fmt::format("({})/{}", inner(), atom(varies));
      case 7:
        return fmt::format("smoothstep({}, {}, {})", inner(), inner(), inner());
      default:
        return fmt::format("max({},sqrt( {} ))", inner(), inner());
    }
  }

  std::string atom(bool varies) {
    if (varies && random_.chance(0.5)) return std::string(1, "xyz"[random_.below(3)]);
    if (!locals_.empty() && random_.chance(0.4)) return pick(locals_);
    if (!params_.empty() && random_.chance(0.5)) return pick(params_);
    constexpr std::array kAtoms = {"0.50", "2", ".25", "1e3", "pi", "tau", "12."};
    return kAtoms[static_cast<std::size_t>(random_.below(kAtoms.size()))];
  }

  Value node(int depth) {
    RecordMaker record{Span{}};
    if (!node_names_.empty() && random_.chance(0.25)) {
      record.add("use", pick(node_names_));
    } else {
      add_type(record, depth);
    }
    for (const char* name : {"scale", "rotate", "translate"}) {
      if (random_.chance(0.3)) record.add(name, *property_value(*use_record().find(name)));
    }
    if (!material_names_.empty() && random_.chance(0.4)) record.add("material", pick(material_names_));
    if (random_.chance(0.2)) record.add("name", odd_name());
    return record.take();
  }

  void add_type(RecordMaker& record, int depth) {
    const NodeSpec* spec = nullptr;
    while (spec == nullptr || spec->category == Category::Internal || spec->category == Category::Function ||
           (depth == 0 && node_record(spec->kind).find("of"))) {
      spec = &pick(node_table());
    }
    record.add("type", spec->name);
    for (const ParamSpec& param : spec->params) {
      if (param.fallback && random_.chance(0.5)) continue;
      record.add(param.name, *property_value(*node_record(spec->kind).find(param.name)));
    }
    if (!node_record(spec->kind).find("of")) return;
    if (spec->category == Category::Alteration) {
      record.add("of", node(depth - 1));
      return;
    }
    List of;
    for (int i = random_.chance(0.1) ? 10 : 1 + random_.below(3); i > 0; --i) of.push_back(node(depth - 1));
    record.add("of", Value{{}, std::move(of)});
  }

  Random& random_;
  int patterns_ = 0;  // nesting depth of patterns at the current record
  std::vector<std::string> params_, locals_, node_names_, material_names_, light_names_;
};

// Parses a string that is entirely a number: "2.50" counts as the number.
std::optional<double> whole_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

compiler::syntax::File random_document(Random& random) { return Drawer(random).draw(); }

std::string canonical(const compiler::syntax::Value& value) {
  if (const auto* record = std::get_if<compiler::syntax::Record>(&value.data)) {
    std::map<std::string, std::string> sorted;
    for (const compiler::syntax::Property& property : record->properties) {
      if (property.name != "$schema") sorted.emplace(property.name, canonical(*property.value));
    }
    std::string out = "{";
    for (const auto& [name, text] : sorted) out += name + ":" + text + ";\n";
    return out + "}";
  }
  if (const auto* list = std::get_if<compiler::syntax::List>(&value.data)) {
    std::string out = "[";
    for (const compiler::syntax::Value& part : *list) out += canonical(part) + ",";
    return out + "]";
  }
  if (const auto* text = std::get_if<std::string>(&value.data)) {
    std::string out = *text;
    std::erase(out, ' ');
    if (const auto number = whole_number(out)) return fmt::format("{}", *number);
    return "'" + out + "'";
  }
  if (std::holds_alternative<double>(value.data)) return number_text(value);
  if (const auto* truth = std::get_if<bool>(&value.data)) return *truth ? "true" : "false";
  return "null";
}

}  // namespace fathom::test
