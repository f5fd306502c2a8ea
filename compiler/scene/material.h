// Materials as the compiler hands them over: plain numbers, and textures for those that vary over space.
//
// Names and meanings after OpenPBR 1.1 (Academy Software Foundation, "OpenPBR Surface", 2024). A material without a
// texture is its numbers and nothing else.
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

// Colours are linear sRGB in [0,1] unless said; a parameter at its default costs nothing.
struct MaterialNumbers {
  double base_weight = 1;  // factor of `color`
  glm::dvec3 color{0.8};   // diffuse: albedo; specular: reflectance; transparent: tint of each crossing;
                           // emissive: albedo of the lamp's own surface; principled: base_color
  double diffuse_roughness = 0, metalness = 0;
  double specular_weight = 1;
  glm::dvec3 specular_color{1};
  double roughness = 0.3;
  double ior = 1.5;         // index of refraction, relative to vacuum
  double transmission = 0;  // transmission_weight
  glm::dvec3 transmission_color{1};
  double transmission_depth = 0;  // scene units: after so much transmission_color is left; 0: tint of each crossing
  double coat_weight = 0;
  glm::dvec3 coat_color{1};
  double coat_roughness = 0, coat_ior = 1.6;
  glm::dvec3 emission{0.0};       // radiance Le, both sides; emissive and principled only
  double emission_luminance = 1;  // factor of `emission`
  glm::dvec3 absorption{0.0};     // transparent: absorption coefficient inside, per scene unit
  double opacity = 1;             // geometry_opacity
};

using MaterialNumber = double MaterialNumbers::*;
using MaterialColor = glm::dvec3 MaterialNumbers::*;

// A parameter that a texture gives at each place.
struct TexturedParameter {
  std::variant<MaterialNumber, MaterialColor> parameter;
  std::uint32_t texture;  // index into SceneTables::textures
  double least, most;     // what the texture gives is clamped to this
};

// How a surface scatters light.
struct Material : MaterialNumbers {
  enum class Type { Diffuse, Emissive, Specular, Transparent, Principled };
  std::string name;
  Type type = Type::Diffuse;
  bool thin_walled = false;
  int priority = 0;  // of two solids at the same place, the medium is that of the higher
  // Of these the numbers above are stand-ins: the mean of the ends of a pattern, the default for a formula. They are
  // used where the texture is not a number.
  std::vector<TexturedParameter> textured;
};

// Whether light may come from it, at some place.
inline bool emits(const Material& material) {
  bool color = material.emission != glm::dvec3(0), luminance = material.emission_luminance != 0;
  for (const TexturedParameter& row : material.textured) {
    color = color || row.parameter == decltype(row.parameter)(&MaterialNumbers::emission);
    luminance = luminance || row.parameter == decltype(row.parameter)(&MaterialNumbers::emission_luminance);
  }
  const bool can = material.type == Material::Type::Emissive || material.type == Material::Type::Principled;
  return can && color && luminance;
}

// Whether a path may get into what is of it, at some place.
inline bool transmits(const Material& material) {
  if (material.type == Material::Type::Transparent) return true;
  if (material.type != Material::Type::Principled) return false;
  bool may = material.transmission > 0 || material.opacity < 1;
  for (const TexturedParameter& row : material.textured) {
    may = may || row.parameter == decltype(row.parameter)(&MaterialNumbers::transmission) ||
          row.parameter == decltype(row.parameter)(&MaterialNumbers::opacity);
  }
  return may;
}

// Whose coordinates a texture is evaluated in: the scene's, wherever the body was moved to, or those of the node that
// the material was given to, before that node's scale, rotate and translate.
enum class TextureSpace { World, Object };
inline constexpr std::array<std::string_view, 2> kTextureSpaces = {"world", "object"};  // [TextureSpace]

// Formulas in the coordinates of their space, not the programs': indices into CompiledScene::formulas of red, green
// and blue; three times the same where it is a number or a grey.
struct TextureFormula {
  std::array<std::uint32_t, 3> programs;
  TextureSpace space = TextureSpace::World;
};

// Two textures mixed by a number t of each place: a (1 - t) + b t. What t is, runtime/material/pattern.h says.
struct Pattern {
  struct Checker {};
  struct Stripes {
    glm::dvec3 axis;         // unit length, across the stripes
    double width, softness;  // share of the period that is a; of the narrower stripe, how much is transition
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
    double width, height;  // of a brick with its mortar
    double mortar, shift;  // how wide; share of a brick by which each row is moved against the one below
  };
  std::variant<Checker, Stripes, Gradient, Noise, Bricks> kind;
  Affine to_pattern;   // from the coordinates of its space to the pattern's
  std::uint32_t a, b;  // indices into SceneTables::textures, lower than the pattern's own
  TextureSpace space = TextureSpace::World;
};

// A colour (grey where a number is wanted), or what varies.
using Texture = std::variant<glm::dvec3, TextureFormula, Pattern>;

// Whether some texture of each material is evaluated in the coordinates of its node. [material]
std::vector<bool> in_object_space(std::span<const Material> materials, std::span<const Texture> textures);

}  // namespace fathom::compiler
