// Table of properties: names, types, ranges, defaults and documentation for one record of a scene file.
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
  Seed,     // an integer of 64 bits
  Vec2,     // two numbers
  Vec3,     // three numbers
  Points,   // a list of three or more [x, y]
  Formula,  // a string, or a list of strings (formula.h)
  Color,    // three numbers, or one for a grey
  Text,
  Boolean,
  Choice,  // one of PropertySpec::choices
  Record,  // a record with its own table
  Named,   // a record whose property names the scene chooses
  Node,
  Nodes,        // a list of nodes
  Scale,        // a number or three numbers
  Translation,  // three numbers, or two for an outline
  Rotation,     // three numbers, or a record that follows rotation_record()
  Background,   // a colour, or a record that follows background_records()
  Version,      // the number kSceneVersion
  Anything,
};

inline constexpr int kSceneVersion = 1;

// Largest magnitude of a number. The machine computes in 32-bit floats, and the sum of three squares of this
// magnitude is still below the largest float.
inline constexpr double kLargest = 1e18;

// Allowed range of a number, or of each component of a vector: [least, most], or (least, most) if `open`.
struct Range {
  double least = -kLargest;
  double most = kLargest;
  bool open = false;
};

struct PropertySpec {
  std::string_view name;
  ValueType type;
  std::string_view doc;
  std::vector<double> fallback = {};  // numbers and vectors: value of an absent property; empty without a default
  bool required = false;
  Rule rule = Rule::Any;
  Range range = {};
  std::vector<std::string_view> choices = {};     // the first is the default
  std::vector<std::string_view> instead_of = {};  // properties that this one replaces; only one of them may be given
  std::string_view alias_of = {};                 // property that this one renames; only one of the two may be given
  bool varies = false;  // may also be a formula of the point or a pattern (compiler/frontend/elaborate/textures.h)
};

struct RecordSpec {
  std::string type;   // value of the property `type`, such as "sphere"; "" if the record has no `type`
  std::string title;  // in messages: "`camera`", "`sphere`", "the scene"
  std::string noun;   // "camera", "sphere", "diffuse material"
  std::vector<PropertySpec> properties;

  const PropertySpec* find(std::string_view property) const;
};

}  // namespace fathom::compiler
