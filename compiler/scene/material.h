// Materials as the compiler's output: plain numbers, and textures for the numbers that vary over space.
//
// The parameters are the rows of compiler/scene/material_parameters.def. A material without a texture consists of its
// numbers alone.
// Tested by: tests/compiler/frontend/elaborate/materials_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/geometry/affine.h"

namespace fathom::compiler {

// The values of a material's parameters, one member for each row of the table.
struct MaterialNumbers {
  using Number = double;
  using Color = glm::dvec3;
#define PARAMETER(Type, member, value, ...) Type member{value};
#include "compiler/scene/material_parameters.def"
};

using MaterialNumber = double MaterialNumbers::*;
using MaterialColor = glm::dvec3 MaterialNumbers::*;
using MaterialMember = std::variant<MaterialNumber, MaterialColor>;

// Valid values of a parameter, or of each component of a colour: in [0,1], above 0, or not below 0.
enum class ParameterDomain { Share, Positive, NotNegative };

// A row of the table.
struct MaterialParameter {
  std::string_view name;  // of the member
  MaterialMember member;
  double value;  // the default, of each component
  ParameterDomain domain;
  std::string_view property, alias, doc;  // of principled materials
};
inline constexpr MaterialParameter kMaterialParameters[] = {
#define PARAMETER(Type, member, value, domain, property, alias, doc) \
  {#member, &MaterialNumbers::member, value, ParameterDomain::domain, property, alias, doc},
#include "compiler/scene/material_parameters.def"
};

const MaterialParameter& parameter_of(MaterialMember member);

// A parameter whose value a texture gives at each place.
struct TexturedParameter {
  MaterialMember parameter;
  std::uint32_t texture;  // index into SceneTables::textures
  double least, most;     // the texture's values are clamped to this range
};

// Scattering and emission of a surface.
struct Material : MaterialNumbers {
  enum class Type { Diffuse, Emissive, Specular, Transparent, Principled };
  std::string name;
  Type type = Type::Diffuse;
  bool thin_walled = false;
  int priority = 0;  // where two solids overlap, the medium is that of the higher priority
  // Parameters with a texture. Their numbers above are stand-ins, which are used where the texture is NaN: the mean
  // of a pattern's ends, or the default for a formula.
  std::vector<TexturedParameter> textured;
};

// True if the material may emit light at some place.
inline bool emits(const Material& material) {
  bool color = material.emission != glm::dvec3(0), luminance = material.emission_luminance != 0;
  for (const TexturedParameter& row : material.textured) {
    color = color || row.parameter == MaterialMember(&MaterialNumbers::emission);
    luminance = luminance || row.parameter == MaterialMember(&MaterialNumbers::emission_luminance);
  }
  const bool can = material.type == Material::Type::Emissive || material.type == Material::Type::Principled;
  return can && color && luminance;
}

// True if a path may enter a body of the material at some place.
inline bool transmits(const Material& material) {
  if (material.type == Material::Type::Transparent) return true;
  if (material.type != Material::Type::Principled) return false;
  bool may = material.transmission > 0 || material.opacity < 1;
  for (const TexturedParameter& row : material.textured) {
    may = may || row.parameter == MaterialMember(&MaterialNumbers::transmission) ||
          row.parameter == MaterialMember(&MaterialNumbers::opacity);
  }
  return may;
}

// Coordinates in which a texture is evaluated: those of the scene, wherever the body is moved to, or those of the
// node that has the material, before the node's scale, rotate and translate.
enum class TextureSpace { World, Object };
inline constexpr std::array<std::string_view, 2> kTextureSpaces = {"world", "object"};  // [TextureSpace]

// Indices into CompiledScene::formulas of the programs for red, green and blue, all three equal for a number or a
// grey. The formulas take the coordinates of their space, not the programs'.
struct TextureFormula {
  std::array<std::uint32_t, 3> programs;
  TextureSpace space = TextureSpace::World;
};

// Two textures mixed by a number t per place: a (1 - t) + b t. runtime/material/pattern.h defines t.
struct Pattern {
  struct Checker {};
  struct Stripes {
    glm::dvec3 axis;         // unit length, across the stripes
    double width, softness;  // share of the period that is a; share of the narrower stripe that is transition
  };
  struct Gradient {
    glm::dvec3 from, to;
  };
  struct Noise {
    int octaves;
    double gain, lacunarity, contrast;
    std::uint64_t seed;
  };
  struct Bricks {
    double width, height;  // of a brick including its mortar
    double mortar, shift;  // width; share of a brick by which each row is shifted against the row below
  };
  std::variant<Checker, Stripes, Gradient, Noise, Bricks> kind;
  Affine to_pattern;   // from the coordinates of its space to the pattern's
  std::uint32_t a, b;  // indices into SceneTables::textures, lower than the pattern's own
  TextureSpace space = TextureSpace::World;
};

// A colour (grey for a number), or a texture that varies.
using Texture = std::variant<glm::dvec3, TextureFormula, Pattern>;

// [material] True if a texture of the material is evaluated in the coordinates of its node.
std::vector<bool> in_object_space(std::span<const Material> materials, std::span<const Texture> textures);

}  // namespace fathom::compiler
