// The field that a mesh is made from: the scene's field, cut off at a box. Points are evaluated in batches.
//
//     const MeshField solid(field, box);
//     solid.evaluate(points, MeshField::Values::Distance, values, threads);
//
// Tested by: tests/runtime/mesh/contour_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "compiler/geometry/box.h"
#include "runtime/field/field.h"

namespace fathom::runtime {

// Points in the programs' coordinates, one array per coordinate. Evaluators read whole registers, so the arrays have
// room for one register more.
class PointArrays {
 public:
  void reserve(std::size_t count);
  void resize(std::size_t count);
  void clear() { resize(0); }
  void push_back(float x, float y, float z);
  // Appends the point rounded to float.
  void push_back(glm::dvec3 p) {
    push_back(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
  }
  void set(std::size_t i, float x, float y, float z) { axes_[0][i] = x, axes_[1][i] = y, axes_[2][i] = z; }
  std::size_t size() const { return count_; }
  glm::vec3 operator[](std::size_t i) const { return {axes_[0][i], axes_[1][i], axes_[2][i]}; }
  vm::Points from(std::size_t first) const {
    return {axes_[0].data() + first, axes_[1].data() + first, axes_[2].data() + first};
  }

 private:
  static constexpr std::size_t kRegister = 16;
  std::vector<float> axes_[3];
  std::size_t count_ = 0;
};

// Sign of the field at a point, as far as float decides it.
enum class Side : std::int8_t { Inside = -1, Unknown = 0, Outside = 1 };

class MeshField {
 public:
  // Memory that a thread needs for evaluations.
  struct Scratch {
    RegionScratch regions;
    vm::Workspace workspace;
    std::vector<float> values;
  };
  // Distance: the field itself. Radius: radius of a ball around the point without a zero of the field, with the
  // field's sign, scene units.
  enum class Values { Distance, Radius };

  // The solid is cut off at `clip`, whose sides may be infinite. `field` must outlive this object.
  MeshField(const Field& field, const compiler::Box& clip) : field_(&field), clip_(clip) {}

  // Computes a value per point, the same for any number of threads.
  void evaluate(const PointArrays& points, Values kind, std::vector<float>& out, int threads) const;
  void evaluate(vm::Points points, std::size_t count, Values kind, float* out, Scratch& scratch) const;

  // Bound on the float error of a value at a point, scene units.
  float error(glm::vec3 p, float value) const { return distance_error(*field_, p.x, p.y, p.z, value); }
  // Returns the side that a float distance proves, given its error. NaN proves nothing.
  Side side(glm::vec3 p, float distance) const {
    const float most = error(p, distance);
    return distance < -most ? Side::Inside : distance > most ? Side::Outside : Side::Unknown;
  }
  // True if double places the point in the solid.
  bool is_inside(glm::dvec3 p, RealScratch& scratch) const;

  // A surface point's outward unit normal, zero where undefined, and the surface.
  struct SurfacePoint {
    glm::dvec3 normal;
    std::uint32_t surface;
  };
  void find_surfaces(const PointArrays& points, std::vector<SurfacePoint>& out, int threads) const;

  const Field& field() const { return *field_; }
  bool is_clipped() const { return clip_.finite(); }

 private:
  // Distance of the box that cuts the solid off, by its nearest side, with the outward normal of that side.
  struct ClipDistance {
    double distance;
    glm::dvec3 normal;
  };
  ClipDistance clip_distance(glm::dvec3 p) const;

  const Field* field_;
  compiler::Box clip_;
};

}  // namespace fathom::runtime
