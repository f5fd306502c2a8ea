#include "compiler/frontend/text/evaluate/emit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "compiler/frontend/formats/print_syntax.h"
#include "compiler/frontend/syntax/make_syntax.h"

namespace fathom::compiler::text {
namespace {

// Maximum nesting depth of nodes. Deeper nodes become named nodes, because code that reads the nodes recurses.
constexpr int kDeepestNode = 64;

using StatementKind = Statement::Kind;

std::string label_of(const Statement& statement) {
  return statement.label.empty() ? std::string(statement.name) : statement.label;
}

class Emitter {
 public:
  Emitter(const Tree& tree, const Evaluated& evaluated, const Limits& limits, Diagnostics& diagnostics)
      : tree_(tree), evaluated_(evaluated), limits_(limits), diagnostics_(diagnostics) {}

  syntax::File run() {
    reserve_names();
    collect();
    syntax::Value root = scene();
    if (objects_.empty() && !diagnostics_.has_errors()) {
      diagnostics_.error("E0103", {}, "the scene has no object", "", {"such as: object sphere(1)"});
    }
    return {std::move(root)};
  }

 private:
  // Node in converted form.
  struct Entry {
    const Node* node;
    std::uint32_t uses = 0;
    // Name of the entry in `nodes`; empty if the node has no entry.
    std::string label = {};
    Span name_span = {};
    // Converted node, until moved to its use or into `nodes`.
    std::optional<syntax::Value> value = {};
    int height = 0;
  };

  // Names of a table, and the next number to try for each name.
  struct Names {
    std::unordered_set<std::string> taken;
    std::unordered_map<std::string, int> next;
  };

  // Reserves the names of the file, which stay as written. Generated names avoid them.
  void reserve_names() {
    for (std::uint32_t i = 0; i < tree_.modules[0].end; ++i) {
      const Statement& statement = tree_.statements[i];
      const std::optional<Value>& value = evaluated_.values[i];
      if (statement.kind != StatementKind::Let || !value) continue;
      if (value->is(Value::Type::Node)) reserve(node_names_, statement);
      if (value->is(Value::Type::Record) && value->record->word && value->record->word->material) {
        reserve(material_names_, statement);
        material_labels_.emplace(value->record, label_of(statement));
      }
    }
  }
  void reserve(Names& names, const Statement& statement) {
    // For a statement without a label names.cpp reports the duplicate.
    if (names.taken.insert(label_of(statement)).second || statement.label.empty()) return;
    diagnostics_.error("E0802", statement.name_span, fmt::format("`{}` is declared twice", label_of(statement)), "",
                       {"labels are names in listings and messages: choose another"});
  }

  static std::string unique(Names& names, const std::string& wanted) {
    std::string name = wanted;
    for (int& i = names.next[wanted]; !names.taken.insert(name).second; ++i) {
      i = std::max(i, 2);
      name = fmt::format("{} {}", wanted, i);
    }
    return name;
  }

  void collect() {
    for (std::uint32_t i = 0; i < tree_.modules[0].end; ++i) {
      const Statement& statement = tree_.statements[i];
      const std::optional<Value>& value = evaluated_.values[i];
      if (!value) continue;
      if (statement.kind == StatementKind::Let && value->is(Value::Type::Node)) {
        write(value->node);
        globals_.push_back({value->node, &statement});
        Entry& entry = entries_[value->node->number - 1];
        if (entry.label.empty()) enter(entry, label_of(statement), statement.name_span);
      } else if (statement.kind == StatementKind::Let) {
        collect_material(statement, *value);
      } else if (statement.kind == StatementKind::Object) {
        collect_object(statement, *value);
      }
    }
  }

  // Counts the uses of all nodes below and lists the nodes, operands first. Does not recurse.
  void write(const Node* root) {
    struct Visit {
      const Node* node;
      std::size_t next = 0;
    };
    std::vector<Visit> open;
    const auto begin = [&](const Node* node) {
      if (node->number == 0) {
        entries_.push_back({.node = node});
        node->number = static_cast<std::uint32_t>(entries_.size());
        open.push_back({node});
      }
      ++entries_[node->number - 1].uses;
    };
    begin(root);
    while (!open.empty()) {
      Visit& top = open.back();
      if (top.next < top.node->of.size()) {
        begin(top.node->of[top.next++]);
      } else {
        pending_.push_back(top.node->number - 1);
        open.pop_back();
      }
    }
  }

  static void enter(Entry& entry, std::string label, Span span) {
    entry.label = std::move(label), entry.name_span = span;
  }

  void collect_material(const Statement& statement, const Value& value) {
    if (!value.is(Value::Type::Record) || !value.record->word || !value.record->word->material) return;
    const std::string label = label_of(statement);
    materials_.add(label, statement.name_span, to_value(value, Place::Other));
  }

  void collect_object(const Statement& statement, const Value& value) {
    if (value.is(Value::Type::Node)) return add_object(statement, *value.node);
    for (const Value& one : value.list->of) add_object(statement, *one.node);
  }

  void add_object(const Statement& statement, const Node& node) {
    write(&node);
    objects_.push_back({&node, &statement});
  }

  // Place that a value is converted for. A node's formula may have several lines.
  enum class Place { Background, Formula, Other };

  syntax::Value scene() {
    write_nodes();
    RecordMaker root(Span{});
    root.add("version", 1.0);
    std::array<std::optional<syntax::Value>, 4> parts;
    for (std::uint32_t i = 0; i < tree_.modules[0].end; ++i)
      add_part(tree_.statements[i], evaluated_.values[i], parts);
    if (!params_.empty()) root.add("params", params_.take());
    constexpr std::string_view kParts[] = {"camera", "film", "render", "background"};
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i]) root.add(kParts[i], *std::move(parts[i]));
    }
    if (!lights_.empty()) root.add("lights", lights_.take());
    syntax::List objects;
    for (const auto& [node, statement] : objects_) objects.push_back(object(*node, *statement));
    if (!materials_.empty()) root.add("materials", materials_.take());
    if (!nodes_.empty()) root.add("nodes", nodes_.take());
    root.add("objects", syntax::Value{Span{}, std::move(objects)});
    return root.take();
  }

  void add_part(const Statement& statement, const std::optional<Value>& value,
                std::array<std::optional<syntax::Value>, 4>& parts) {
    if (statement.kind == StatementKind::Param) return add_parameter(statement, value);
    if (!value) return;
    if (statement.kind == StatementKind::Light) return add_light(statement, *value);
    const auto at = static_cast<int>(statement.kind) - static_cast<int>(StatementKind::Camera);
    if (at < 0) return;
    std::optional<syntax::Value>& part = parts[static_cast<std::size_t>(at)];
    if (part) {
      diagnostics_.error("E0010", statement.span, "this is said twice", "", {"keep one of the two statements"});
      return;
    }
    part = to_value(*value, statement.kind == StatementKind::Background ? Place::Background : Place::Other);
  }

  void add_parameter(const Statement& statement, const std::optional<Value>& value) {
    for (const Scope::Entry& entry : evaluated_.parameters.entries()) {
      const Parameter& parameter = entry.parameter;
      if (entry.span.begin != statement.name_span.begin || !value) continue;
      syntax::Value own = to_value(*value, Place::Other);
      if (statement.has_fields) {
        RecordMaker record(statement.name_span);
        record.add("default", std::move(own));
        if (std::isfinite(parameter.min)) record.add("min", parameter.min);
        if (std::isfinite(parameter.max)) record.add("max", parameter.max);
        if (!parameter.doc.empty()) record.add("doc", std::string_view(parameter.doc));
        own = record.take();
      }
      params_.add(parameter.name, statement.name_span, std::move(own));
    }
  }

  void add_light(const Statement& statement, const Value& value) {
    if (!value.is(Value::Type::Record) || !value.record->word || !value.record->word->light) {
      diagnostics_.error("E0807", value.span, fmt::format("a light is not {}", describe(value)), "",
                         {"such as: light \"sun\" directional(direction = [0, -1, 0])"});
      return;
    }
    const std::string wanted = statement.label.empty() ? "light" : statement.label;
    const Span place = statement.label.empty() ? statement.span : statement.name_span;
    lights_.add(unique(light_names_, wanted), place, to_value(value, Place::Other));
  }

  void write_nodes() {
    for (const std::uint32_t number : pending_) {
      Entry& entry = entries_[number];
      Built built = build(*entry.node);
      if (entry.label.empty() && (entry.uses > 1 || built.height >= kDeepestNode)) {
        const std::string wanted = entry.node->name.empty() ? "part" : std::string(entry.node->name);
        enter(entry, unique(node_names_, wanted), entry.node->word_span);
      }
      entry.height = entry.label.empty() ? built.height : 0;
      entry.value = std::move(built.value);
    }
    // Add the file's named nodes in file order.
    for (const auto& [node, statement] : globals_) {
      Entry& entry = entries_[node->number - 1];
      int height = 0;
      const bool first = entry.label == label_of(*statement);
      nodes_.add(label_of(*statement), statement->name_span,
                 first ? *std::exchange(entry.value, std::nullopt) : met(*node, height));
    }
    for (const std::uint32_t number : pending_) {
      Entry& entry = entries_[number];
      if (entry.label.empty() || !entry.value) continue;
      nodes_.add(entry.label, entry.name_span, *std::exchange(entry.value, std::nullopt));
    }
  }

  struct Built {
    syntax::Value value;
    int height;
  };

  Built build(const Node& node) {
    if (node.spec == nullptr) return placed(node);
    RecordMaker record(node.span);
    record.add("type", node.word_span, make_value(node.word_span, node.spec->name));
    for (const Field& field : node.fields) {
      const auto param = std::ranges::find(node.spec->params, field.name, &ParamSpec::name);
      const bool formula = param != node.spec->params.end() && param->type == ParamType::Formula;
      add(record, field, formula ? Place::Formula : Place::Other);
    }
    int height = 0;
    if (node.spec->category == Category::Combinator) {
      syntax::List of;
      for (const Node* part : node.of) of.push_back(met(*part, height));
      record.add("of", syntax::Value{node.span, std::move(of)});
    } else if (!node.of.empty()) {
      record.add("of", met(*node.of[0], height));
    }
    return {record.take(), height + 1};
  }

  // Returns the node at a place of use: the node itself, or a reference by name.
  syntax::Value met(const Node& node, int& height) {
    Entry& entry = entries_[node.number - 1];
    height = std::max(height, entry.height);
    if (entry.label.empty()) return *std::exchange(entry.value, std::nullopt);
    return RecordMaker(node.span).add("use", std::string_view(entry.label)).take();
  }

  // Adds a placement to its operand. Scenes apply scale, rotate and translate in this order. A placement in any other
  // order is applied to a union of one node.
  Built placed(const Node& node) {
    int height = 0;
    syntax::Value inner = met(*node.of[0], height);
    if (node.fields.empty()) return {std::move(inner), height};
    const Field& field = node.fields[0];
    constexpr std::string_view kOrder[] = {"scale", "rotate", "translate"};
    const auto rank = [&](std::string_view name) { return std::ranges::find(kOrder, name) - std::begin(kOrder); };
    auto& properties = std::get<syntax::Record>(inner.data).properties;
    const bool fits = std::ranges::none_of(properties, [&](const syntax::Property& property) {
      if (property.name == field.name) return true;
      return rank(field.name) < 3 && rank(property.name) < 3 && rank(property.name) > rank(field.name);
    });
    if (!fits) {
      syntax::List of;
      of.push_back(std::move(inner));
      inner = RecordMaker(node.span).add("type", "union").add("of", syntax::Value{node.span, std::move(of)}).take();
      ++height;
    }
    RecordMaker record(std::move(inner));
    add(record, field);
    return {record.take(), height};
  }

  syntax::Value object(const Node& node, const Statement& statement) {
    int height = 0;
    syntax::Value value = met(node, height);
    if (statement.label.empty()) return value;
    auto& properties = std::get<syntax::Record>(value.data).properties;
    std::erase_if(properties, [](const syntax::Property& property) { return property.name == "name"; });
    RecordMaker record(std::move(value));
    record.add("name", statement.name_span, make_value(statement.name_span, statement.label));
    return record.take();
  }

  void add(RecordMaker& record, const Field& field, Place place = Place::Other) {
    syntax::Value value = field.name == "material" ? material(field.value) : to_value(field.value, place);
    record.add(field.name, field.name_span, std::move(value));
  }

  // Returns the material's name. Adds the material to the scene if it has no name yet.
  syntax::Value material(const Value& value) {
    if (!value.is(Value::Type::Record) || !value.record->word || !value.record->word->material) {
      if (value.is(Value::Type::Text)) return make_value(value.span, *value.text);
      diagnostics_.error("E0807", value.span, fmt::format("a material is not {}", describe(value)), "",
                         {"such as diffuse(color = 0.5)"});
      return make_value(value.span, std::string_view());
    }
    const Record* record = value.record;
    const auto known = material_labels_.find(record);
    if (known != material_labels_.end()) return make_value(value.span, known->second);
    // Merge equal materials, because a function creates a new material per call.
    syntax::Value made = to_value(value, Place::Other);
    std::string key = syntax::print_syntax({std::move(made)});
    const auto [found, is_new] = equal_materials_.emplace(std::move(key), "");
    if (is_new) {
      found->second = unique(material_names_, record->name.empty() ? "material" : std::string(record->name));
      materials_.add(found->second, record->word_span, to_value(value, Place::Other));
    }
    material_labels_.emplace(record, found->second);
    return make_value(value.span, found->second);
  }

  // Reports a scene with too many values before creating them. A list may contain the same list many times, so a
  // short text can expand to a huge scene.
  bool has_room(const Value& value) {
    if (full_) return false;
    full_ = values_ + extent_of(value).values > limits_.tokens;
    ++values_;
    if (full_) {
      diagnostics_.error("E0008", value.span,
                         fmt::format("the scene has more than {} values and names", limits_.tokens),
                         "too many with these", {raise(&Limits::tokens, 2 * limits_.tokens)});
    }
    return !full_;
  }

  syntax::Value to_value(const Value& value, Place place) {
    if (!has_room(value)) return {value.span, {}};
    // A formula such as "(9007199254740993)" would lose digits.
    const bool literal = value.integer >= std::uint64_t{1} << 53 || (value.spelling && value.spelling->is_literal);
    if (value.spelling && (!literal || place == Place::Formula)) return spelled(value, place);
    switch (value.type) {
      case Value::Type::Truth:
        return {value.span, value.truth};
      case Value::Type::Number:
        if (place != Place::Formula) return {value.span, value.number, value.integer};
        return {value.span, std::make_shared<const Formula>(Formula{{{"const", value.number, {}, value.span}}})};
      case Value::Type::Formula:
        return {value.span, std::make_shared<const Formula>(evaluated_.store.formulas.finish(value.formula))};
      case Value::Type::Text:
        return {value.span, *value.text};
      case Value::Type::List: {
        syntax::List list;
        for (const Value& part : value.list->of) list.push_back(to_value(part, Place::Other));
        return {value.span, std::move(list)};
      }
      case Value::Type::Record:
        return record_value(*value.record, place);
      case Value::Type::Node:
        break;
    }
    diagnostics_.error("E0807", value.span, "a node where a number, a text or a record is expected");
    return {value.span, {}};
  }

  // Returns a number as a formula of a JSON scene.
  static syntax::Value spelled(const Value& value, Place place) {
    const Spelling& spelling = *value.spelling;
    if (spelling.lines.empty()) return make_value(value.span, spelling.text);
    if (place != Place::Formula) return make_value(value.span, spelling.inlined);
    syntax::List lines;
    for (const Spelling::Line* line : spelling.lines) {
      lines.push_back(make_value(value.span, fmt::format("{} = {}", line->name, line->text)));
    }
    lines.push_back(make_value(value.span, spelling.text));
    return {value.span, std::move(lines)};
  }

  syntax::Value record_value(const Record& from, Place place) {
    RecordMaker record(from.span);
    if (from.word) {
      const bool pattern = from.word->pattern && !(from.word->background && place == Place::Background);
      record.add(pattern ? "pattern" : "type", from.word_span, make_value(from.word_span, from.word->text));
    }
    for (const Field& field : from.fields)
      record.add(field.name, field.name_span, to_value(field.value, Place::Other));
    return record.take();
  }

  const Tree& tree_;
  const Evaluated& evaluated_;
  const Limits& limits_;
  Diagnostics& diagnostics_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> pending_;  // indices into entries_, in order of conversion
  std::vector<std::pair<const Node*, const Statement*>> objects_, globals_;
  double values_ = 0;  // number of values converted
  bool full_ = false;
  Names node_names_, material_names_, light_names_;
  std::unordered_map<const Record*, std::string> material_labels_;
  std::unordered_map<std::string, std::string> equal_materials_;  // by printed form
  RecordMaker params_{Span{}}, lights_{Span{}}, materials_{Span{}}, nodes_{Span{}};
};

}  // namespace

syntax::File to_syntax(const Tree& tree, const Evaluated& evaluated, const Limits& limits, Diagnostics& diagnostics) {
  return Emitter(tree, evaluated, limits, diagnostics).run();
}

}  // namespace fathom::compiler::text
