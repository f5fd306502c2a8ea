// Materials as shading needs them: single precision, ready to use, every texture evaluated.
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

// A material at one point of a surface: every parameter is a number. Names and meanings are those of
// compiler/scene/material_parameters.def.
struct MaterialPoint {
  using Number = float;
  using Color = glm::vec3;
  MaterialType type = MaterialType::Diffuse;
  bool thin_walled = false;
  Color base_color{0.8f};  // base_weight * color
  Color emission{0};       // emission_luminance * emission: radiance of an opaque surface without a coat
  // transmission_color is the tint per crossing, opacity 1 if the material fills a body, and absorption includes that
  // which follows from transmission_depth.
#define PARAMETER(Type, member, value, ...) Type member{value};
#define COMBINED(...)
#include "compiler/scene/material_parameters.def"

  // Returns the radiance that leaves the surface to both sides: the opaque part emits, through the coat.
  glm::vec3 emitted_radiance() const;
  // transmits(): true if a path may get through the surface. has_interior(): true if the path is then in a medium of
  // this index.
  bool transmits() const { return is_transmissive() || opacity < 1; }
  bool has_interior() const { return is_transmissive() && !thin_walled; }
  // True if light may continue straight through the surface (Bsdf::null_transmission).
  bool has_null_transmission() const { return opacity < 1 || (is_transmissive() && thin_walled); }

 private:
  bool is_transmissive() const { return type == MaterialType::Transparent || transmission > 0; }
};

// Returns the material without its textures, with stand-ins for textured parameters.
MaterialPoint untextured_point(const compiler::Material& material);

// Mixes all parameters linearly, t in [0,1]. At t <= 0 or NaN the result is a, and at t >= 1 b. Two materials of one
// type keep the type, otherwise both become principled.
MaterialPoint mix(const MaterialPoint& a, const MaterialPoint& b, float t);

// Returns the principled material that looks the same, or nearly: a perfect mirror's constant reflectance becomes
// that of a smooth metal with a tint at 82 degrees that makes both equal there.
MaterialPoint to_principled(const MaterialPoint& m);

// The materials of a scene. The values of textures are clamped to their parameters' ranges, and a NaN is replaced by
// the parameter's stand-in (compiler/scene/material.h). Every method may be called from many threads. The scene must
// outlive this object.
class Materials {
 public:
  explicit Materials(const compiler::CompiledScene& scene);

  std::size_t size() const { return points_.size(); }
  const compiler::CompiledScene& scene() const { return *scene_; }

  // Evaluates a material. `position` is in the programs' coordinates, like a hit's position. `place` is the same
  // point in the coordinates of the node, for textures in object space. `workspace` is the thread's.
  MaterialPoint at(std::uint32_t material, glm::dvec3 position, glm::dvec3 place, vm::Workspace& workspace) const;

  // Returns the material without its textures, with stand-ins for textured parameters.
  const MaterialPoint& untextured(std::uint32_t material) const { return points_[material]; }
  bool is_textured(std::uint32_t material) const { return !scene_->materials[material].textured.empty(); }
  // True if the material varies in the coordinates of the node.
  bool uses_object_space(std::uint32_t material) const { return uses_object_space_[material]; }
  // True if light may come from the material at some point.
  bool emits(std::uint32_t material) const { return compiler::emits(scene_->materials[material]); }
  // True if light may continue straight through any of the materials.
  bool any_null_transmission() const { return any_null_transmission_; }
  // Among solids that overlap, the one of the highest priority determines the medium.
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
  std::vector<bool> uses_object_space_;  // [material]
  bool any_null_transmission_ = false;
};

glm::vec3 albedo_of(const MaterialPoint& m);

}  // namespace fathom::runtime
