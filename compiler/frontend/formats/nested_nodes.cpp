#include "compiler/frontend/formats/nested_nodes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "compiler/frontend/records/record_reader.h"
#include "compiler/frontend/syntax/make_syntax.h"
#include "vm/number/real.h"

namespace fathom::compiler {
namespace {

// Map from world to node coordinates: q = linear * p + offset.
struct Placement {
  glm::dmat3 linear{1};
  glm::dvec3 offset{0};

  // Returns the composition that applies `inner` first, then this placement.
  Placement after(const Placement& inner) const { return {linear * inner.linear, linear * inner.offset + offset}; }
};

struct BlendMode {
  std::string_view name, sharp, smooth;
};
constexpr BlendMode kBlendModes[] = {{"union", "union", "smooth_union"},
                                     {"sub", "subtraction", "smooth_subtraction"},
                                     {"inter", "intersection", "smooth_intersection"}};

// Tolerance of the test for rotation matrices: published files write sines and cosines with three digits.
constexpr double kLeeway = 1e-3;

// Maximum nesting depth of nodes in the converted scene. Deeper nodes become named nodes. The reader of scene files
// allows five times this depth, since each node takes two levels, an object in a list.
constexpr int kDeepestTree = 400;

// Result of converting a node. A left-leaning chain of the same operator becomes one combinator.
struct Made {
  syntax::Value leaf = {};
  const BlendMode* mode = nullptr;  // null for a leaf
  double k = 0;
  std::vector<syntax::Value> of = {};
  int height = 0;
  Span span = {};
};

class Converter {
 public:
  explicit Converter(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  std::optional<syntax::File> run(const syntax::Value& root) {
    const auto& record = std::get<syntax::Record>(root.data);
    const glm::dvec3 lo = vec3(record, "aabb_min", root.span), hi = vec3(record, "aabb_max", root.span);
    convert(root);
    if (diagnostics_.has_errors()) return std::nullopt;
    return syntax::File{scene(root.span, finish(std::move(made_.back())).value, lo, hi)};
  }

 private:
  struct Pending {
    const syntax::Value* value;
    Placement placement;  // of the parent
    bool join;            // the children are converted
  };

  // Uses an explicit stack, because operator chains are as long as the model is large.
  void convert(const syntax::Value& root) {
    std::vector<Pending> pending = {{&root, {}, false}};
    while (!pending.empty()) {
      const Pending next = pending.back();
      pending.pop_back();
      const auto* record = std::get_if<syntax::Record>(&next.value->data);
      if (record == nullptr) {
        bad(next.value->span, fmt::format("a node must be an object, not {}", describe(*next.value)));
        made_.push_back({});
      } else if (next.join) {
        join(*record, next.value->span);
      } else {
        const std::string type = text(*record, "nodeType", next.value->span);
        const Placement placement = next.placement.after(matrix(*record, next.value->span));
        if (type == "binaryOperator") {
          pending.push_back({next.value, placement, true});
          for (const char* child : {"rightChild", "leftChild"}) {
            const syntax::Value* value = find(*record, child, next.value->span);
            if (value) pending.push_back({value, placement, false});
            if (!value) made_.push_back({});
          }
        } else {
          if (type != "primitive" && !type.empty())
            unknown(*record, "nodeType", type, {"binaryOperator", "primitive"});
          made_.push_back({.leaf = primitive(*record, placement, next.value->span), .span = next.value->span});
        }
      }
    }
  }

  void join(const syntax::Record& record, Span span) {
    Made right = std::move(made_.back());
    made_.pop_back();
    Made left = std::move(made_.back());
    made_.pop_back();
    const std::string name = text(record, "blendMode", span);
    const double k = number(record, "blendRadius", span);
    const auto mode = std::find_if(std::begin(kBlendModes), std::end(kBlendModes),
                                   [&](const BlendMode& row) { return row.name == name; });
    if (mode == std::end(kBlendModes)) {
      if (!name.empty()) unknown(record, "blendMode", name, {"union", "sub", "inter"});
      made_.push_back(std::move(left));
      return;
    }
    if (left.mode != mode || left.k != k) {
      Made outer{.mode = mode, .k = k};
      add(outer, std::move(left));
      left = std::move(outer);
    }
    left.span = span;
    add(left, std::move(right));
    made_.push_back(std::move(left));
  }

  void add(Made& combinator, Made part) {
    auto [value, height] = finish(std::move(part));
    combinator.of.push_back(std::move(value));
    combinator.height = std::max(combinator.height, height + 1);
  }

  struct Finished {
    syntax::Value value;
    int height;
  };

  // Returns the node in scene syntax. A deeply nested node is moved to `nodes` and referred to by name.
  Finished finish(Made made) {
    if (made.mode == nullptr) return {std::move(made.leaf), 0};
    RecordMaker record(made.span);
    record.add("type", made.k == 0 ? made.mode->sharp : made.mode->smooth);
    if (made.k != 0) record.add("k", made.k);
    record.add("of", syntax::Value{made.span, std::move(made.of)});
    if (made.height < kDeepestTree) return {record.take(), made.height};
    const std::string name = fmt::format("part {}", ++parts_);
    nodes_.add(name, record.take());
    return {RecordMaker(made.span).add("use", name).take(), 0};
  }

  syntax::Value primitive(const syntax::Record& record, Placement placement, Span span) {
    const std::string type = text(record, "primitiveType", span);
    RecordMaker node(span);
    if (type == "sphere") {
      node.add("type", "sphere").add("radius", number(record, "radius", span));
    } else if (type == "box") {
      box(record, span, node);
    } else if (type == "cylinder") {
      node.add("type", "cylinder")
          .add("radius", number(record, "radius", span))
          .add("half_height", number(record, "height", span) / 2);
    } else if (type == "cone") {
      node.add("type", "cone")
          .add("bottom_radius", number(record, "radius", span))
          .add("top_radius", 0.0)
          .add("half_height", number(record, "height", span) / 2);
    } else if (!type.empty()) {
      unknown(record, "primitiveType", type, {"sphere", "box", "cylinder", "cone"});
    }
    place(node, placement, type == "sphere");
    const int color = color_number(vec3(record, "color", span), span);
    if (color > 1) node.add("material", color_name(color));
    return node.take();
  }

  void box(const syntax::Record& record, Span span, RecordMaker& node) {
    const glm::dvec3 half = vec3(record, "sides", span) / 2.0;
    const double radius = number(record, "round_x", span);
    std::vector<double> all = numbers(record, "bevel", 4, span);
    all.push_back(number(record, "round_y", span));
    if (std::any_of(all.begin(), all.end(), [&](double r) { return r != radius; })) {
      diagnostics_.error("E0614", opening(span), "a box with edges of different roundness", "",
                         {"bevel, round_x and round_y must all be the same number"});
    }
    node.add("type", radius == 0 ? "box" : "round_box").add("half_size", half);
    if (radius != 0) node.add("radius", radius);
  }

  void place(RecordMaker& node, Placement placement, bool round) {
    glm::dmat3 rotation = glm::transpose(placement.linear);  // from the node to the world
    if (glm::determinant(rotation) < 0) rotation[0] = -rotation[0], placement.offset.x = -placement.offset.x;
    // Make the rotation orthogonal to the last bit, regardless of the number of digits in the file.
    rotation[0] = glm::normalize(rotation[0]);
    rotation[1] = glm::normalize(rotation[1] - glm::dot(rotation[0], rotation[1]) * rotation[0]);
    rotation[2] = glm::cross(rotation[0], rotation[1]);
    const glm::dvec3 axis(rotation[1].z - rotation[2].y, rotation[2].x - rotation[0].z,
                          rotation[0].y - rotation[1].x);
    const double trace = rotation[0].x + rotation[1].y + rotation[2].z;
    const double angle = vm::real::atan2(glm::length(axis), trace - 1) / vm::real::kDegree;
    if (angle != 0 && !round) {
      RecordMaker turn(Span{});
      turn.add("axis", glm::length(axis) > 1e-6 ? axis : half_turn_axis(rotation)).add("angle", angle);
      node.add("rotate", turn.take());
    }
    const glm::dvec3 centre = -(rotation * placement.offset);
    if (centre != glm::dvec3(0)) node.add("translate", centre);
  }

  // Axis of a rotation by 180 degrees. Every column of R + 1 is parallel to the axis, and the longest is the most
  // accurate.
  static glm::dvec3 half_turn_axis(const glm::dmat3& rotation) {
    const glm::dmat3 sum = rotation + glm::dmat3(1);
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
      if (glm::length(sum[i]) > glm::length(sum[longest])) longest = i;
    }
    return sum[longest];
  }

  // Colours become materials. The whole object has the material of the first colour, so nodes name only the others.
  int color_number(const glm::dvec3& color, Span span) {
    const auto found = std::find(colors_.begin(), colors_.end(), color);
    const int number = static_cast<int>(found - colors_.begin()) + 1;
    if (found == colors_.end()) {
      colors_.push_back(color);
      materials_.add(color_name(number), RecordMaker(span).add("type", "diffuse").add("color", color).take());
    }
    return number;
  }
  static std::string color_name(int number) { return fmt::format("color {}", number); }

  Placement matrix(const syntax::Record& record, Span span) {
    const std::size_t errors = diagnostics_.errors();
    const std::vector<double> m = numbers(record, "matrix", 12, span);
    if (diagnostics_.errors() > errors) return {};
    Placement out;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        out.linear[column][row] = m[static_cast<std::size_t>(4 * row + column)];
      out.offset[row] = m[static_cast<std::size_t>(4 * row + 3)];
    }
    const glm::dmat3 square = glm::transpose(out.linear) * out.linear;
    double off = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(square[i][j] - (i == j ? 1 : 0)));
    }
    if (off <= kLeeway) return out;
    diagnostics_.error("E0613", record.find("matrix")->value->span, "the matrix is not a rotation with a move", "",
                       {"its rows without their last numbers must have length 1 and be at right angles"});
    return {};
  }

  // Readers for a property. They report a missing or invalid value and return a placeholder.

  const syntax::Value* find(const syntax::Record& record, std::string_view name, Span span) {
    const syntax::Property* property = record.find(name);
    if (property) return property->value.get();
    bad(opening(span), fmt::format("the node has no `{}`", name));
    return nullptr;
  }

  std::string text(const syntax::Record& record, std::string_view name, Span span) {
    const syntax::Value* value = find(record, name, span);
    if (value == nullptr) return "";
    if (const auto* found = std::get_if<std::string>(&value->data)) return *found;
    bad(value->span, fmt::format("`{}` must be a string, not {}", name, describe(*value)));
    return "";
  }

  double number(const syntax::Record& record, std::string_view name, Span span) {
    const syntax::Value* value = find(record, name, span);
    if (value == nullptr) return 1;
    if (const auto* found = std::get_if<double>(&value->data)) return *found;
    bad(value->span, fmt::format("`{}` must be a number, not {}", name, describe(*value)));
    return 1;
  }

  std::vector<double> numbers(const syntax::Record& record, std::string_view name, std::size_t count, Span span) {
    std::vector<double> out;
    const syntax::Value* value = find(record, name, span);
    const auto* list = value ? std::get_if<syntax::List>(&value->data) : nullptr;
    for (std::size_t i = 0; list && i < list->size(); ++i) {
      if (const auto* found = std::get_if<double>(&(*list)[i].data)) out.push_back(*found);
    }
    if (list && list->size() == count && out.size() == count) return out;
    if (value)
      bad(value->span, fmt::format("`{}` must be a list of {} numbers, not {}", name, count, describe(*value)));
    return std::vector<double>(count, 0.0);
  }

  glm::dvec3 vec3(const syntax::Record& record, std::string_view name, Span span) {
    const std::vector<double> v = numbers(record, name, 3, span);
    return {v[0], v[1], v[2]};
  }

  void unknown(const syntax::Record& record, std::string_view name, std::string_view value,
               const std::vector<std::string_view>& known) {
    diagnostics_.error("E0611", record.find(name)->value->span, fmt::format("unknown {} `{}`", name, value), "",
                       {fmt::format("known: {}", fmt::join(known, ", "))});
  }

  void bad(Span span, std::string message) { diagnostics_.error("E0612", span, std::move(message)); }

  syntax::Value scene(Span whole, syntax::Value object, const glm::dvec3& lo, const glm::dvec3& hi) {
    // Frame the whole box from the front: its front face fills the height or the width of the image.
    constexpr double kFieldOfView = 40, kMargin = 1.1, kAspect = 640.0 / 360.0;
    const glm::dvec3 middle = (lo + hi) / 2.0, half = (hi - lo) / 2.0;
    const double reach = kMargin * std::max({half.y, half.x / kAspect, 1e-3});
    const double away = half.z + reach / vm::real::tan(kFieldOfView / 2 * vm::real::kDegree);
    RecordMaker camera(whole), film(whole), background(whole), out(whole);
    camera.add("position", middle + glm::dvec3(0, 0, away)).add("target", middle).add("fov_y", kFieldOfView);
    film.add("width", 640.0).add("height", 360.0);
    background.add("bottom", glm::dvec3(0.4)).add("top", glm::dvec3(1));
    out.add("version", 1.0)
        .add("camera", camera.take())
        .add("film", film.take())
        .add("background", background.take())
        .add("materials", materials_.take());
    if (!nodes_.empty()) out.add("nodes", nodes_.take());
    std::get<syntax::Record>(object.data)
        .properties.push_back(
            {"material", object.span, std::make_unique<syntax::Value>(make_value(whole, color_name(1)))});
    syntax::List objects;
    objects.push_back(std::move(object));
    return out.add("objects", syntax::Value{whole, std::move(objects)}).take();
  }

  Diagnostics& diagnostics_;
  std::vector<Made> made_;
  std::vector<glm::dvec3> colors_;
  RecordMaker materials_{Span{}}, nodes_{Span{}};
  int parts_ = 0;
};

}  // namespace

bool is_nested_nodes(const syntax::File& file) {
  const auto* record = std::get_if<syntax::Record>(&file.root.data);
  return record && record->find("nodeType") && !record->find("version");
}

std::optional<syntax::File> from_nested_nodes(const syntax::File& file, Diagnostics& diagnostics) {
  return Converter(diagnostics).run(file.root);
}

}  // namespace fathom::compiler
