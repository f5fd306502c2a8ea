#include "compiler/scene/material.h"

#include <algorithm>

namespace fathom::compiler {

const MaterialParameter& parameter_of(MaterialMember member) {
  return *std::ranges::find(kMaterialParameters, member, &MaterialParameter::member);
}

std::vector<bool> in_object_space(std::span<const Material> materials, std::span<const Texture> textures) {
  std::vector<bool> textured, result;
  for (const Texture& texture : textures) {  // a pattern comes after the textures that it mixes
    bool object = false;
    if (const auto* formula = std::get_if<TextureFormula>(&texture)) object = formula->space == TextureSpace::Object;
    if (const auto* pattern = std::get_if<Pattern>(&texture)) {
      object = pattern->space == TextureSpace::Object || textured[pattern->a] || textured[pattern->b];
    }
    textured.push_back(object);
  }
  for (const Material& material : materials) {
    result.push_back(std::any_of(material.textured.begin(), material.textured.end(),
                                 [&](const TexturedParameter& row) { return textured[row.texture]; }));
  }
  return result;
}

}  // namespace fathom::compiler
