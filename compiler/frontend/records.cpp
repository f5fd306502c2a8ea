#include "compiler/frontend/records.h"

#include <utility>

#include "compiler/compiled_scene.h"

namespace fathom::compiler {
namespace {

constexpr Range kUnit{0, 1};
// A double holds every whole number up to here, and JSON numbers are read as doubles.
constexpr double kLargestWhole = 9007199254740992;  // 2^53

PropertySpec number(std::string_view name, std::string_view doc, std::vector<double> fallback, Range range = {},
                    Rule rule = Rule::Any) {
  return {name, ValueType::Number, doc, std::move(fallback), false, rule, range, {}};
}
PropertySpec integer(std::string_view name, std::string_view doc, double fallback, Range range) {
  return {name, ValueType::Integer, doc, {fallback}, false, Rule::Any, range, {}};
}
PropertySpec vec3(std::string_view name, std::string_view doc, std::vector<double> fallback, Rule rule = Rule::Any) {
  return {name, ValueType::Vec3, doc, std::move(fallback), false, rule, {}, {}};
}
PropertySpec color(std::string_view name, std::string_view doc, double fallback, Range range = kUnit,
                   Rule rule = Rule::Any) {
  return {name, ValueType::Color, doc, {fallback, fallback, fallback}, false, rule, range, {}};
}
PropertySpec other(std::string_view name, ValueType type, std::string_view doc, bool required = false) {
  return {name, type, doc, {}, required, Rule::Any, {}, {}};
}
PropertySpec choice(std::vector<std::string_view> choices, std::string_view doc, bool required) {
  return {"type", ValueType::Choice, doc, {}, required, Rule::Any, {}, std::move(choices)};
}

RecordSpec camera(std::string type, std::vector<PropertySpec> own) {
  RecordSpec record{
      std::move(type),
      "`camera`",
      "camera",
      {choice({"perspective", "orthographic"}, "the projection", false),
       vec3("position", "where the camera is", {0, 0, 5}), vec3("target", "what it looks at", {0, 0, 0}),
       vec3("up", "the direction that is up in the picture", {0, 1, 0}, Rule::NotZero)}};
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  return record;
}

PropertySpec vertical_fov() {
  PropertySpec property = number("fov_y", "vertical field of view, degrees", {}, {0, 180, true});
  property.instead_of = "fov";
  return property;
}

RecordSpec material(std::string type, std::vector<PropertySpec> own) {
  RecordSpec record{
      type,
      "`" + type + "`",
      type + " material",
      {choice({"diffuse", "emissive", "specular", "transparent"}, "how the surface scatters light", true)}};
  for (PropertySpec& property : own) record.properties.push_back(std::move(property));
  return record;
}

// What every node may have.
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
        vec3("translate", "how far to move the node, after scale and rotate", {0, 0, 0}),
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

// Two end points in place of a length.
void add_between(RecordSpec& record, const Between& between) {
  for (PropertySpec& property : record.properties) property.required &= property.name != between.length;
  for (const char* end : {"a", "b"}) {
    record.properties.push_back(other(end, ValueType::Vec3, "an end of the axis, in place of the length"));
  }
}

// [kind]
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

const PropertySpec* RecordSpec::find(std::string_view property) const {
  for (const PropertySpec& row : properties) {
    if (row.name == property) return &row;
  }
  return nullptr;
}

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
        ValueType::Gradient,
        "radiance of rays that leave the scene",
        {},
        false,
        Rule::NotNegative,
        {},
        {}},
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
  static const RecordSpec record{
      "",
      "`film`",
      "film",
      {integer("width", "pixels", 640, {1, kMaxSide}),
       integer("height", "pixels", 360, {1, kMaxSide}),
       number("exposure", "stops: the picture is multiplied by 2^exposure", {0}, {-100, 100}),
       {"tone",
        ValueType::Choice,
        "how light becomes a display's, after exposure",
        {},
        false,
        Rule::Any,
        {},
        {kToneCurves.begin(), kToneCurves.end()}}}};
  return record;
}

const RecordSpec& render_record() {
  static const RecordSpec record{
      "",
      "`render`",
      "render",
      {integer("spp", "samples per pixel", 16, {1, kMaxSpp}),
       integer("bounces", "before Russian roulette may end a path", 10, {0, kMaxBounces}),
       integer("tile", "pixels a side", 16, {1, kMaxTile}),
       integer("seed", "of the random numbers", 0, {0, kLargestWhole}),
       number("far", "how far from the camera rays are followed, scene units", {}, {}, Rule::Positive)}};
  return record;
}

const RecordSpec& gradient_record() {
  static const RecordSpec record{"",
                                 "`background`",
                                 "background",
                                 {color("bottom", "radiance from straight down", 0, {}, Rule::NotNegative),
                                  color("top", "radiance from straight up", 0, {}, Rule::NotNegative)}};
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
      camera("perspective",
             {number("fov", "horizontal field of view, degrees", {45}, {0, 180, true}), vertical_fov()}),
      camera("orthographic", {number("width", "of the picture, scene units", {4}, {}, Rule::Positive)})};
  return records;
}

const std::vector<RecordSpec>& material_records() {
  static const std::vector<RecordSpec> records = {
      material("diffuse", {color("color", "albedo", 0.8)}),
      material("emissive", {color("emission", "radiance, both sides", 1, {}, Rule::NotNegative),
                            color("color", "albedo of the lamp itself", 0)}),
      material("specular", {color("color", "reflectance of the mirror", 1)}),
      material("transparent",
               {number("ior", "index of refraction inside relative to outside", {1.5}, {}, Rule::Positive),
                color("color", "tint at each crossing", 1),
                color("absorption", "inside, per scene unit", 0, {}, Rule::NotNegative)})};
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
