#include "compiler/frontend/records/records.h"

#include <type_traits>
#include <utility>

#include "compiler/frontend/records/property_rows.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

using namespace rows;

RecordSpec camera(std::string type, std::vector<PropertySpec> own) {
  RecordSpec record{
      std::move(type),
      "`camera`",
      "camera",
      {choice({"perspective", "orthographic", "panorama"}, "the projection", false),
       vec3("position", "where the camera is", {0, 0, 5}), vec3("target", "what it looks at", {0, 0, 0}),
       vec3("up", "the direction that is up in the picture", {0, 1, 0}, Rule::NotZero),
       number("shutter", "share of a frame's time that it is open, from the frame's begin; 0: nothing blurs", {0},
              kUnit)}};
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  return record;
}

std::vector<PropertySpec> perspective() {
  return {number("fov", "horizontal field of view, degrees", {45}, {0, 180, true}),
          instead_of({"fov"}, number("fov_y", "vertical field of view, degrees", {}, {0, 180, true})),
          instead_of({"fov", "fov_y"}, number("focal_length", "of the lens, mm", {}, {1e-3, 1e6})),
          number("sensor_width", "as wide as the picture, mm", {36}, {1e-3, 1e6}),
          number("lens_radius", "of the aperture, scene units; 0: all is sharp", {}, {}, Rule::NotNegative),
          instead_of({"lens_radius"},
                     number("f_stop", "focal length over the aperture's diameter; a scene unit is a metre", {}, {},
                            Rule::Positive)),
          number("focus_distance", "of the plane that is sharp, along the view, scene units", {}, {}, Rule::Positive),
          instead_of({"focus_distance"}, other("focus", ValueType::Vec3, "a point that is sharp")),
          integer("blades", "sides of the aperture; below 3 it is round", 0, {0, kMaxBlades}),
          number("blade_rotation", "degrees, counter-clockwise in the picture; at 0 a corner is up", {0})};
}

// Adds the properties common to all nodes.
void add_placement(RecordSpec& record) {
  for (PropertySpec property :
       {PropertySpec{"scale",
                     ValueType::Scale,
                     "a positive number, or three; before rotate and translate",
                     {},
                     false,
                     Rule::Positive,
                     {1 / kLargest, kLargest},
                     {}},
        other("rotate", ValueType::Rotation,
              "{\"axis\": [x,y,z], \"angle\": degrees}, or degrees about the fixed x, then y, then z axis"),
        other("translate", ValueType::Translation,
              "how far to move the node, after scale and rotate; two numbers of an outline"),
        other("material", ValueType::Text, "name of a material, for what within has none of its own"),
        other("name", ValueType::Text, "for messages and listings")}) {
    record.properties.push_back(std::move(property));
  }
}

PropertySpec parameter(const ParamSpec& param) {
  PropertySpec property{param.name, ValueType::Number, param.doc, {}, !param.fallback, param.rule, {}, {}};
  if (param.type == ParamType::Integer) property.type = ValueType::Integer;
  if (param.type == ParamType::Vec2) property.type = ValueType::Vec2;
  if (param.type == ParamType::Vec3 || param.type == ParamType::Counts) property.type = ValueType::Vec3;
  if (param.type == ParamType::Points) property.type = ValueType::Points;
  if (param.type == ParamType::Formula) property.type = ValueType::Formula;
  if (param.fallback) property.fallback.assign(static_cast<std::size_t>(width(param.type)), *param.fallback);
  return property;
}

// Adds two end points as an alternative to a length.
void add_between(RecordSpec& record, const Between& between) {
  for (PropertySpec& property : record.properties) property.required &= property.name != between.length;
  for (const char* end : {"a", "b"}) {
    record.properties.push_back(other(end, ValueType::Vec3, "an end of the axis, in place of the length"));
  }
}

template <typename Record, typename Member>
PropertySpec setting_property(const Setting<Record, Member>& setting) {
  using Number = SettingValue<Member>;
  PropertySpec property = other(setting.name, ValueType::Number, setting.doc);
  if constexpr (std::is_enum_v<Number>) {
    property.type = ValueType::Choice;
    const auto words = words_of(Number{});
    property.choices.assign(words.begin(), words.end());
  } else {
    if (std::is_integral_v<Number>) property.type = ValueType::Integer;
    if (std::is_same_v<Number, std::uint64_t>) property.type = ValueType::Seed;
    if constexpr (std::is_same_v<Member, Number>) property.fallback = {static_cast<double>(Record().*setting.member)};
    if (setting.range.above_zero) {
      property.rule = Rule::Positive;
    } else {
      property.range = {setting.range.least, setting.range.most};
    }
  }
  return property;
}

// Returns the rows of the settings that scene files have in this record.
template <typename Record>
std::vector<PropertySpec> setting_properties() {
  std::vector<PropertySpec> properties;
  for_each_setting_of<Record>([&](const auto& setting) {
    if (!setting.doc.empty()) properties.push_back(setting_property(setting));
  });
  return properties;
}

// Returns the rows by kind: [kind].
std::vector<RecordSpec> make_node_records() {
  std::vector<RecordSpec> records(kKindCount);
  for (const NodeSpec& node : node_table()) {
    const std::string type(node.name);
    RecordSpec record{type, "`" + type + "`", type, {}};
    record.properties.push_back(other("type", ValueType::Text, "the type of node", true));
    for (const ParamSpec& param : node.params) record.properties.push_back(parameter(param));
    if (node.between) add_between(record, *node.between);
    const bool of_formula = !node.params.empty() && node.params.back().type == ParamType::Formula;
    if (node.category == Category::Alteration && !(of_formula && node.operand == Sort::Number)) {
      record.properties.push_back(other("of", ValueType::Node, "the node that is altered", true));
    } else if (node.category == Category::Combinator) {
      record.properties.push_back(other("of", ValueType::Nodes, "the nodes that are combined", true));
    }
    add_placement(record);
    records[static_cast<std::size_t>(node.kind)] = std::move(record);
  }
  return records;
}

}  // namespace

const RecordSpec& scene_record() {
  static const RecordSpec record{
      "",
      "the scene",
      "scene",
      {other("version", ValueType::Version, "1, the version of the scene format", true),
       other("$schema", ValueType::Anything, "ignored; for editors"),
       other("params", ValueType::Named, "name -> parameter: a number that formulas can use"),
       other("camera", ValueType::Record, "where the picture is taken from"),
       other("film", ValueType::Record, "the picture"),
       other("render", ValueType::Record, "how much work to spend"),
       {"background",
        ValueType::Background,
        "radiance of rays that leave the scene",
        {},
        false,
        Rule::NotNegative,
        {},
        {}},
       other("lights", ValueType::Named, "name -> light without a surface"),
       other("materials", ValueType::Named, "name -> material"),
       other("nodes", ValueType::Named, "name -> node, for `use`"),
       other("objects", ValueType::Nodes, "the scene is their union", true)}};
  return record;
}

const RecordSpec& parameter_record() {
  static const RecordSpec record{
      "",
      "the parameter",
      "parameter",
      {{"default", ValueType::Number, "its value unless the command line gives one", {}, true, Rule::Any, {}, {}},
       number("min", "the smallest value allowed", {}),
       number("max", "the largest value allowed", {}),
       other("doc", ValueType::Text, "what it does, for messages")}};
  return record;
}

const RecordSpec& film_record() {
  static const RecordSpec record{"", "`film`", "film", setting_properties<Film>()};
  return record;
}

const RecordSpec& render_record() {
  static const RecordSpec record{"", "`render`", "render", setting_properties<RenderSettings>()};
  return record;
}

const RecordSpec& rotation_record() {
  static const RecordSpec record{
      "",
      "`rotate`",
      "rotation",
      {{"axis", ValueType::Vec3, "direction of the axis, any length", {}, true, Rule::NotZero, {}, {}},
       {"angle",
        ValueType::Number,
        "degrees, counter-clockwise as the axis points at you",
        {},
        true,
        Rule::Any,
        {},
        {}}}};
  return record;
}

const std::vector<RecordSpec>& camera_records() {
  static const std::vector<RecordSpec> records = {
      camera("perspective", perspective()),
      camera("orthographic", {number("width", "of the picture, scene units", {4}, {}, Rule::Positive)}),
      camera("panorama", {})};
  return records;
}

const RecordSpec& node_record(Kind kind) {
  static const std::vector<RecordSpec> records = make_node_records();
  return records[static_cast<std::size_t>(kind)];
}

const RecordSpec& use_record() {
  static const RecordSpec record = [] {
    RecordSpec made{"", "`use`", "use", {other("use", ValueType::Text, "name of a node in `nodes`", true)}};
    add_placement(made);
    return made;
  }();
  return record;
}

}  // namespace fathom::compiler
