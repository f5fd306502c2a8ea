// Materials as shading wants them: single precision, ready to use, every texture evaluated.
//
//     const Materials materials(scene);
//     const MaterialPoint m = materials.at(point.material, hit.position, point.place, workspace);
//
// Tested by: tests/runtime/material/material_test.cpp, render_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "compiler/scene/compiled_scene.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

using MaterialType = compiler::Material::Type;

// A material at one place of a surface: every parameter a number. Names and meanings after OpenPBR 1.1 (Academy
// Software Foundation, "OpenPBR Surface", 2024); a parameter at its default costs nothing.
struct MaterialPoint {
  MaterialType type = MaterialType::Diffuse;
  glm::vec3 base_color{0.8f};   // base_weight is multiplied in
  float diffuse_roughness = 0;  // 0: Lambert's
  float metalness = 0;
  float specular_weight = 1;
  glm::vec3 specular_color{1};
  float roughness = 0.3f;           // specular_roughness r: GGX with alpha = r^2
  float ior = 1.5f;                 // inside relative to vacuum
  float transmission = 0;           // transmission_weight
  glm::vec3 transmission_color{1};  // where transmission_depth is 0: tint of each crossing
  float coat_weight = 0;
  glm::vec3 coat_color{1};
  float coat_roughness = 0, coat_ior = 1.6f;
  bool thin_walled = false;
  float opacity = 1;        // geometry_opacity; 1 for what fills a body
  glm::vec3 emission{0};    // radiance of a surface that is opaque and has no coat
  glm::vec3 absorption{0};  // inside, per scene unit

  // The radiance that leaves the surface, to both sides: what is there of it emits, through the coat.
  glm::vec3 emitted() const;
  // Whether a path may get through the surface, and whether it then is in a medium of this index.
  bool transmits() const { return passes_light() || opacity < 1; }
  bool fills() const { return passes_light() && !thin_walled; }
  // Whether light may go straight on through it (Bsdf::straight_through).
  bool passes_straight() const { return opacity < 1 || (passes_light() && thin_walled); }

 private:
  bool passes_light() const { return type == MaterialType::Transparent || transmission > 0; }
};

// The material where it does not vary, with stand-ins for what varies.
MaterialPoint typical_point(const compiler::Material& material);

// All parameters mixed linearly, t in [0,1]; at 0 and below it is a, at 1 and above b. Two of one type stay of it; of
// two types both become principled. NaN counts as 0.
MaterialPoint mix(const MaterialPoint& a, const MaterialPoint& b, float t);

// The principled material that looks the same, or nearly: a perfect mirror's constant reflectance becomes that of a
// smooth metal whose tint at 82 degrees makes it equal there.
MaterialPoint to_principled(const MaterialPoint& m);

// The materials of a scene. Of one that varies over space the parameters are clamped to their ranges; where a texture
// is not a number its stand-in counts (compiler/scene/material.h). Every method may be called from many threads; the scene
// must outlive it.
class Materials {
 public:
  explicit Materials(const compiler::CompiledScene& scene);

  std::size_t size() const { return points_.size(); }
  const compiler::CompiledScene& scene() const { return *scene_; }

  // `position` is in the programs' coordinates, as a hit's; `place` is the same point in those of the node, which
  // count where a texture is in object space; `workspace` is the thread's.
  MaterialPoint at(std::uint32_t material, glm::dvec3 position, glm::dvec3 place, vm::Workspace& workspace) const;

  // The same everywhere, or with stand-ins for what varies.
  const MaterialPoint& typical(std::uint32_t material) const { return points_[material]; }
  bool varies(std::uint32_t material) const { return !scene_->materials[material].textured.empty(); }
  // Whether it varies in the coordinates of the node.
  bool placed(std::uint32_t material) const { return placed_[material]; }
  // Whether light may come from it at some place.
  bool emits(std::uint32_t material) const { return compiler::emits(scene_->materials[material]); }
  // Whether light may go straight on through any of them.
  bool pass_straight() const { return pass_straight_; }
  // Of solids at the same place, the medium is that of the highest.
  int priority(std::uint32_t material) const { return scene_->materials[material].priority; }

 private:
  // A point in the coordinates of both spaces.
  struct TexturePoint {
    glm::dvec3 world, object;
    glm::dvec3 in(compiler::TextureSpace space) const {
      return space == compiler::TextureSpace::World ? world : object;
    }
  };
  glm::dvec3 value(std::uint32_t texture, const TexturePoint& point, vm::Workspace& workspace) const;

  const compiler::CompiledScene* scene_;
  std::vector<MaterialPoint> points_;  // [material]
  std::vector<bool> placed_;           // [material]
  bool pass_straight_ = false;
};

glm::vec3 albedo_of(const MaterialPoint& m);

}  // namespace fathom::runtime
