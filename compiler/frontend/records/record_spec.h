// A table of properties: names, types, ranges, defaults and documentation of one record of a scene file.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/shapes/node_spec.h"

namespace fathom::compiler {

enum class ValueType {
  Number,
  Integer,
  Vec2,     // two numbers
  Vec3,     // three numbers
  Points,   // a list of [x, y], three or more
  Formula,  // a string, or a list of them (formula.h)
  Color,    // three numbers, or one of a grey
  Text,
  Boolean,
  Choice,  // one of PropertySpec::choices
  Record,  // a record with a table of its own
  Named,   // a record whose properties are names of the scene's choosing
  Node,
  Nodes,        // a list of nodes
  Scale,        // a number or three
  Translation,  // three numbers, or two of an outline
  Rotation,     // three numbers or a record by rotation_record()
  Background,   // a colour or a record of background_records()
  Version,      // the number kSceneVersion
  Anything,
};

inline constexpr int kSceneVersion = 1;

// The machine computes in 32-bit floats: three squares of this magnitude still add up to less than their largest.
inline constexpr double kLargest = 1e18;

// Numbers (each of three, for a vector) lie in [least, most]; in (least, most) when open.
struct Range {
  double least = -kLargest;
  double most = kLargest;
  bool open = false;
};

struct PropertySpec {
  std::string_view name;
  ValueType type;
  std::string_view doc;
  std::vector<double> fallback =
      {};  // numbers and vectors: used when the property is absent; empty when there is none
  bool required = false;
  Rule rule = Rule::Any;
  Range range = {};
  std::vector<std::string_view> choices = {};     // the first is used when the property is absent
  std::vector<std::string_view> instead_of = {};  // the properties this one takes the place of: no two may be given
  std::string_view alias_of = {};                 // the property this is another name of: not both may be given
  bool varies = false;  // may be a formula of the place or a pattern, too (frontend/elaborate/textures.h)
};

struct RecordSpec {
  std::string type;   // what the property `type` says, such as "sphere"; "" when the record has none
  std::string title;  // in messages: "`camera`", "`sphere`", "the scene"
  std::string noun;   // "camera", "sphere", "diffuse material"
  std::vector<PropertySpec> properties;

  const PropertySpec* find(std::string_view property) const;
};

}  // namespace fathom::compiler
