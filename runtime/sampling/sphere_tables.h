// The tables of PiecewiseConstantSphere (piecewise_constant_sphere.h) and its lanes (piecewise_constant_sphere_lanes.h):
// rows of rays, and the tables of a sphere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fathom::runtime {

// Directions, [axis][ray], and what is there, [ray]: the radiance, and the density of samples per solid angle.
// Kernels read and write whole registers.
struct DirectionRows {
  static constexpr std::size_t kCapacity = 64;
  alignas(64) float direction[3][kCapacity] = {}, light[kCapacity][4] = {};

  glm::vec3 direction_of(std::size_t i) const { return {direction[0][i], direction[1][i], direction[2][i]}; }
  glm::vec3 radiance(std::size_t i) const { return {light[i][0], light[i][1], light[i][2]}; }
  float density(std::size_t i) const { return light[i][3]; }
  void set_direction(std::size_t i, glm::vec3 w) {
    direction[0][i] = w.x, direction[1][i] = w.y, direction[2][i] = w.z;
  }
  void set_radiance(std::size_t i, glm::vec3 value) {
    light[i][0] = value.x, light[i][1] = value.y, light[i][2] = value.z;
  }
};

// Running sums of the shares of `size` cells, from 0 to 1, in rows. The cell of u is the last whose sum is not above
// u. Row r's sums begin at r (size + 1), its guide at r (bins + 1). Entry i of the guide is the cell of i / bins;
// `bins` is a power of two, so that the bin of u is exact.
struct RunningSums {
  std::size_t size = 0, bins = 1;
  std::vector<float> sums;
  std::vector<std::uint32_t> guide;
};

// A pixel of the image and, last, the density of its cell.
struct SphereCell {
  alignas(16) float light[4];
};

// The tables of a PiecewiseConstantSphere.
struct SphereTables {
  int width = 0, height = 0;
  RunningSums rows, columns;
  // Distances from the nearer pole, along the axis, at which rows begin, and their change within the row. Near the
  // poles these have more digits than heights. The first rows_above(height) rows count from +y, the others from -y.
  std::vector<float> pole_distance, pole_step;
  // With a border of one pixel: the row's other end at its ends, and the outer rows once more.
  std::vector<SphereCell> cells;
};

inline int rows_above(int height) { return (height + 1) / 2; }

// Places among the cells of a sphere, [ray]: the index in SphereTables::cells of the upper left of the four cells
// around a place, how far it lies from that cell's middle towards those of the next cell and of the next row, in
// [0,1], and the cell that it lies in.
struct SphereCellRows {
  alignas(64) std::int32_t cell[DirectionRows::kCapacity], own[DirectionRows::kCapacity];
  alignas(64) float along[DirectionRows::kCapacity], down[DirectionRows::kCapacity];
};

}  // namespace fathom::runtime
