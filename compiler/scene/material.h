// Materials as the compiler's output: plain numbers, and textures for the numbers that vary over space.
//
// Names and meanings follow OpenPBR 1.1 (Academy Software Foundation, "OpenPBR Surface", 2024). A material without a
// texture consists of its numbers alone.
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

// Colours are linear sRGB in [0,1] unless stated otherwise. A parameter at its default costs nothing.
struct MaterialNumbers {
  double base_weight = 1;  // factor of `color`
  glm::dvec3 color{0.8};   // diffuse: albedo; specular: reflectance; transparent: tint per crossing;
                           // emissive: albedo of the emitting surface; principled: base_color
  double diffuse_roughness = 0, metalness = 0;
  double specular_weight = 1;
  glm::dvec3 specular_color{1};
  double roughness = 0.3;
  double ior = 1.5;         // index of refraction, relative to vacuum
  double transmission = 0;  // transmission_weight
  glm::dvec3 transmission_color{1};
  double transmission_depth = 0;  // scene units, after which transmission_color is left; 0: tint per crossing
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

// A parameter whose value a texture gives at each place.
struct TexturedParameter {
  std::variant<MaterialNumber, MaterialColor> parameter;
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
    color = color || row.parameter == decltype(row.parameter)(&MaterialNumbers::emission);
    luminance = luminance || row.parameter == decltype(row.parameter)(&MaterialNumbers::emission_luminance);
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
    may = may || row.parameter == decltype(row.parameter)(&MaterialNumbers::transmission) ||
          row.parameter == decltype(row.parameter)(&MaterialNumbers::opacity);
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
