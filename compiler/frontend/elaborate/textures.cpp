#include "compiler/frontend/elaborate/textures.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "compiler/frontend/elaborate/placement.h"
#include "compiler/frontend/formula/formula_nodes.h"
#include "compiler/frontend/formula/read_formula.h"
#include "compiler/frontend/records/record_family.h"
#include "compiler/frontend/records/written_numbers.h"

namespace fathom::compiler {
namespace {

constexpr int kDeepestPattern = kMaxPatternDepth;

// Returns the pattern's row with the properties `a` and `b` restricted to the values that the parameter allows.
RecordSpec row_for(const RecordSpec& pattern, const PropertySpec& parameter) {
  RecordSpec row = pattern;
  for (PropertySpec& property : row.properties) {
    if (property.name != "a" && property.name != "b") continue;
    property.type = parameter.type;
    property.rule = parameter.rule;
    property.range = parameter.range;
  }
  return row;
}

decltype(Pattern::kind) kind_of(const RecordReader& reader, std::string_view type) {
  if (type == "stripes") {
    return Pattern::Stripes{glm::normalize(reader.vec3("axis")), reader.number("width"), reader.number("softness")};
  }
  if (type == "gradient") return Pattern::Gradient{reader.vec3("from"), reader.vec3("to")};
  if (type == "noise") {
    return Pattern::Noise{static_cast<int>(reader.number("octaves")), reader.number("gain"),
                          reader.number("lacunarity"), reader.number("contrast"), reader.seed("seed")};
  }
  if (type == "bricks") {
    return Pattern::Bricks{reader.number("width"), reader.number("height"), reader.number("mortar"),
                           reader.number("shift")};
  }
  return Pattern::Checker{};
}

bool is_sound(const Pattern& pattern, Span place, Diagnostics& diagnostics) {
  const auto* gradient = std::get_if<Pattern::Gradient>(&pattern.kind);
  if (gradient == nullptr || gradient->from != gradient->to) return true;
  diagnostics.error("E0302", place, "`from` and `to` of the gradient are the same point", "",
                    {"a is at `from` and b at `to`: move one of them"});
  return false;
}

}  // namespace

TextureSpace space_of(const RecordReader& reader, TextureSpace otherwise) {
  const syntax::Value* value = reader.value("space");
  if (value == nullptr) return otherwise;
  const bool world = std::get<std::string>(value->data) == kTextureSpaces[0];
  return world ? TextureSpace::World : TextureSpace::Object;
}

std::optional<ReadTexture> TextureReader::read(const syntax::Value& value, const PropertySpec& parameter,
                                               Context context) {
  if (!std::holds_alternative<syntax::Record>(value.data)) return read_formulas(value, parameter, context.space);
  if (context.depth <= kDeepestPattern) return read_pattern(value, parameter, context);
  diagnostics_.error("E0109", opening(value.span), "patterns nested too deep",
                     fmt::format("this is within {} others", kDeepestPattern),
                     {"mix fewer patterns, or write a formula"});
  return std::nullopt;
}

std::optional<ReadTexture> TextureReader::read_pattern(const syntax::Value& value, const PropertySpec& parameter,
                                                       Context context) {
  const auto& record = std::get<syntax::Record>(value.data);
  const Span place = opening(value.span);
  const RecordSpec* found = row_by_type(pattern_records(), "pattern", record, place, diagnostics_, "pattern");
  if (found == nullptr) return std::nullopt;
  const RecordSpec row = row_for(*found, parameter);
  const RecordReader reader(row, record, place, scope_, diagnostics_);
  context.space = space_of(reader, context.space);
  const std::optional<ReadTexture> a = read_end(reader, row, "a", context), b = read_end(reader, row, "b", context);
  const auto placement = read_placement(reader, scope_, diagnostics_);
  if (!reader.good() || !a || !b) return std::nullopt;
  if (!a->index && !b->index && a->typical == b->typical) return a;
  Pattern pattern{kind_of(reader, row.type), {}, 0, 0, context.space};
  if (!is_sound(pattern, place, diagnostics_)) return std::nullopt;
  constexpr std::array<double, 13> kStill = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1};
  const std::array<double, 13> params = placement.value_or(kStill);
  pattern.to_pattern = Affine::from_params(std::span(params).first(12));
  pattern.a = index_of(*a);
  pattern.b = index_of(*b);
  return ReadTexture{(a->typical + b->typical) / 2.0, add(pattern)};
}

// Reads the value of the pattern's `a` or `b`.
std::optional<ReadTexture> TextureReader::read_end(const RecordReader& reader, const RecordSpec& row,
                                                   const char* name, Context context) {
  const syntax::Value* value = reader.value(name);
  if (value == nullptr) return std::nullopt;
  if (varies(*value)) return read(*value, *row.find(name), Context{context.space, context.depth + 1});
  return ReadTexture{*three_numbers(*value)};
}

std::optional<ReadTexture> TextureReader::read_formulas(const syntax::Value& value, const PropertySpec& parameter,
                                                        TextureSpace space) {
  const double usual = parameter.fallback.empty() ? 0 : parameter.fallback[0];
  const auto* list = std::get_if<syntax::List>(&value.data);
  if (list == nullptr) {
    const std::optional<std::uint32_t> one = add_formula(value);
    if (!one) return std::nullopt;
    return ReadTexture{glm::dvec3(usual), add(TextureFormula{{*one, *one, *one}, space})};
  }
  if (parameter.type != ValueType::Color || list->size() != 3) {
    diagnostics_.error(
        "E0101", value.span,
        fmt::format("`{}` must be {}, not {}", parameter.name,
                    parameter.type == ValueType::Color ? "a number or three" : "a number", describe(value)),
        "", {fmt::format("`{}`: {}", parameter.name, parameter.doc)});
    return std::nullopt;
  }
  TextureFormula texture{{}, space};
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<std::uint32_t> one = add_formula((*list)[i]);
    good = good && one;
    texture.programs[i] = one.value_or(0);
  }
  if (!good) return std::nullopt;
  return ReadTexture{glm::dvec3(usual), add(texture)};
}

// Adds a formula, or a plain number that stands in a list with formulas.
std::optional<std::uint32_t> TextureReader::add_formula(const syntax::Value& value) {
  std::optional<Formula> formula;
  if (const double* number = std::get_if<double>(&value.data)) {
    formula = Formula{{{"const", *number, {}, value.span}}};
  } else if (is_formula_text(value)) {
    formula = read_formula(value, scope_, machine_functions(), diagnostics_);
  } else {
    diagnostics_.error("E0101", value.span,
                       fmt::format("a part of a colour must be a number, not {}", describe(value)));
  }
  if (!formula || !holds_in_float(*formula, diagnostics_)) return std::nullopt;
  Scene scene;
  scene.root = make_formula(scene.graph, *formula, "");
  formulas.push_back(std::move(scene));
  return static_cast<std::uint32_t>(formulas.size() - 1);
}

std::uint32_t TextureReader::add(Texture texture) {
  textures.push_back(std::move(texture));
  return static_cast<std::uint32_t>(textures.size() - 1);
}

std::uint32_t TextureReader::index_of(const ReadTexture& end) { return end.index ? *end.index : add(end.typical); }

}  // namespace fathom::compiler
