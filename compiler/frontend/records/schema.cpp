#include "compiler/frontend/records/schema.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/frontend/records/records.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Returns whole numbers without a fraction, because editors show the number as written.
OrderedJson plain(double number) {
  constexpr double kExact = 9007199254740992;  // 2^53
  if (std::floor(number) == number && std::abs(number) <= kExact) return static_cast<std::int64_t>(number);
  return number;
}

OrderedJson reference(std::string_view definition) { return {{"$ref", "#/$defs/" + std::string(definition)}}; }

// Returns the schema of a value that may be written in two ways.
OrderedJson either(OrderedJson one, OrderedJson other) { return {{"anyOf", OrderedJson::array({std::move(one), std::move(other)})}}; }

OrderedJson string_schema() { return {{"type", "string"}}; }

// Returns the schema of a number that satisfies a property's range and rule, or of a formula of the scene's
// parameters. Only the compiler can check the formula.
OrderedJson number_schema(const PropertySpec& property, const char* type = "number") {
  OrderedJson schema = {{"type", type}};
  const Range& range = property.range;
  const bool above_zero = property.rule == Rule::Positive && range.least <= 0;
  const bool from_zero = property.rule == Rule::NotNegative && range.least < 0;
  schema[above_zero || range.open ? "exclusiveMinimum" : "minimum"] =
      plain(above_zero || from_zero ? 0 : range.least);
  schema[range.open ? "exclusiveMaximum" : "maximum"] = plain(range.most);
  return either(std::move(schema), string_schema());
}

OrderedJson list_schema(OrderedJson items, int least, std::optional<int> most = std::nullopt) {
  OrderedJson schema = {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}};
  if (most) schema["maxItems"] = *most;
  return schema;
}

OrderedJson three_schema(const PropertySpec& property) {
  OrderedJson schema = list_schema(number_schema(property), 3, 3);
  if (property.rule == Rule::NotZero) schema["not"] = {{"items", {{"const", 0}}}};
  return schema;
}

OrderedJson record_schema(const RecordSpec& record, bool type_required);

// True if the property distinguishes the records of a family.
bool tells_apart(const PropertySpec& property) { return property.name == "type" || property.name == "pattern"; }

// Returns the schema of a grey or a colour. A colour string matches the string schema for formulas.
OrderedJson color_schema(const PropertySpec& property) { return either(number_schema(property), three_schema(property)); }

// Returns the schema of the value of a property of `record`.
OrderedJson value_schema(const PropertySpec& property, const RecordSpec& record) {
  switch (property.type) {
    case ValueType::Number:
      return number_schema(property);
    case ValueType::Integer:
      return number_schema(property, "integer");
    case ValueType::Seed:
      return either({{"type", "integer"}, {"minimum", 0}, {"maximum", ~std::uint64_t{0}}}, string_schema());
    case ValueType::Vec2:
      return list_schema(number_schema(property), 2, 2);
    case ValueType::Vec3:
      return three_schema(property);
    case ValueType::Translation:
      return list_schema(number_schema(property), 2, 3);
    case ValueType::Color:
      return color_schema(property);
    case ValueType::Boolean:
      return {{"type", "boolean"}};
    case ValueType::Points:
      return list_schema(list_schema(number_schema(property), 2, 2), 3);
    case ValueType::Formula:
      return either(string_schema(), list_schema(string_schema(), 1));
    case ValueType::Text:
    case ValueType::Choice:
      if (tells_apart(property)) return {{"const", record.type}};
      if (!property.choices.empty()) return {{"enum", property.choices}};
      return string_schema();
    case ValueType::Record:
      return reference(property.name);
    case ValueType::Named:  // definition `material` describes the entries of `materials`
      return {{"type", "object"},
              {"additionalProperties", reference(property.name.substr(0, property.name.size() - 1))}};
    case ValueType::Node:
      return reference("node");
    case ValueType::Nodes:
      return list_schema(reference("node"), 1);
    case ValueType::Scale:
    case ValueType::Rotation:
      return reference(property.name);
    case ValueType::Background:  // one colour for both ends
      return either(color_schema(*background_records()[0].find("top")), reference(property.name));
    case ValueType::Version:
      return {{"const", kSceneVersion}};
    case ValueType::Anything:
      break;
  }
  return OrderedJson::object();
}

OrderedJson default_of(const PropertySpec& property) {
  if (property.fallback.size() == 1) return plain(property.fallback[0]);
  OrderedJson numbers = OrderedJson::array();
  for (const double number : property.fallback) numbers.push_back(plain(number));
  return numbers;
}

OrderedJson property_schema(const PropertySpec& property, const RecordSpec& record) {
  OrderedJson schema = value_schema(property, record);
  if (property.varies) schema["anyOf"].push_back(reference("pattern"));
  schema["description"] = property.doc;
  if (!property.fallback.empty()) schema["default"] = default_of(property);
  if (property.type == ValueType::Choice && !property.required && tells_apart(property))
    schema["default"] = property.choices[0];
  return schema;
}

// If `type_required`, the record is not the default for an absent `type`.
OrderedJson record_schema(const RecordSpec& record, bool type_required) {
  OrderedJson schema = {{"type", "object"}, {"properties", OrderedJson::object()}, {"required", OrderedJson::array()}};
  OrderedJson excluded = OrderedJson::array();
  for (const PropertySpec& property : record.properties) {
    schema["properties"][std::string(property.name)] = property_schema(property, record);
    if (property.required || (type_required && property.name == "type")) schema["required"].push_back(property.name);
    for (const std::string_view other : property.instead_of) {
      excluded.push_back({{"required", {other, property.name}}});
    }
    if (!property.alias_of.empty()) {
      excluded.push_back({{"required", {property.alias_of, property.name}}});
    }
  }
  if (!excluded.empty()) schema["not"] = {{"anyOf", excluded}};
  schema["additionalProperties"] = false;
  return schema;
}

// Returns the schema of a family of records, distinguished by `type`.
OrderedJson family_schema(const std::vector<RecordSpec>& family) {
  OrderedJson rows = OrderedJson::array();
  for (const RecordSpec& record : family) {
    rows.push_back(record_schema(record, &record != &family[0]));
    rows.back()["title"] = record.type;
  }
  return {{"oneOf", rows}};
}

// Schemas that the properties `scale` and `rotate` of every node refer to.
OrderedJson scale_schema() {
  const PropertySpec& scale = *use_record().find("scale");
  return either(number_schema(scale), three_schema(scale));
}
OrderedJson rotate_schema() {
  return either(three_schema(*use_record().find("rotate")), record_schema(rotation_record(), false));
}

// Returns the schema of a length, or of two end points instead.
OrderedJson between_schema(const Between& between) {
  const OrderedJson ends = {{"anyOf", {{{"required", {"a"}}}, {{"required", {"b"}}}}}};
  const OrderedJson length = {{"required", {between.length}}};
  return {{"oneOf", OrderedJson::array({{{"required", {between.length}}, {"not", ends}},
                                 {{"required", {"a", "b"}}, {"not", length}}})}};
}

OrderedJson node_schema() {
  OrderedJson rows = OrderedJson::array();
  for (const NodeSpec& node : node_table()) {
    if (node.category == Category::Internal || node.category == Category::Function) continue;
    rows.push_back(record_schema(node_record(node.kind), true));
    if (node.between) rows.back().update(between_schema(*node.between));
    rows.back()["title"] = node.name;
    rows.back()["description"] = node.doc;
  }
  rows.push_back(record_schema(use_record(), false));
  rows.back()["title"] = use_record().noun;
  rows.back()["description"] = "a node of `nodes`, placed";
  return {{"oneOf", rows}};
}

}  // namespace

std::string scene_schema() {
  OrderedJson schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "Fathom scene"},
                 {"description", "A scene of signed distance fields. Comments (// and /* */) are allowed."}};
  schema.update(record_schema(scene_record(), false));
  schema["$defs"] = {{"camera", family_schema(camera_records())},
                     {"film", record_schema(film_record(), false)},
                     {"render", record_schema(render_record(), false)},
                     {"param", either(number_schema({}), record_schema(parameter_record(), false))},
                     {"material", family_schema(material_records())},
                     {"light", family_schema(light_records())},
                     {"background", family_schema(background_records())},
                     {"pattern", family_schema(pattern_records())},
                     {"node", node_schema()},
                     {"scale", scale_schema()},
                     {"rotate", rotate_schema()}};
  return schema.dump(2) + "\n";
}

}  // namespace fathom::compiler
