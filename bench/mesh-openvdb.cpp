// Meshes a scene by OpenVDB's volumeToMesh, a published dual contouring, for comparison with `fathom mesh`:
//
//     fathom emit cpp scene.json -o scene.h
//     g++ -O3 -march=native -std=c++17 -I. -DLO=-1,-1,-1 -DHI=1,1,1 bench/mesh-openvdb.cpp -lopenvdb -ltbb -o mesh-openvdb
//     ./mesh-openvdb 0.0078 0        # cell, adaptivity
//
// Blocks of 8^3 voxels whose centre is further from the surface than they are large are left out. Prints the seconds
// for sampling and for meshing, and the triangles.
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "scene.h"

int main(int argc, char** argv) {
  if (argc < 3) return 1;
  const double cell = std::atof(argv[1]), adaptivity = std::atof(argv[2]);
  const double lo[3] = {LO}, hi[3] = {HI};
  openvdb::initialize();
  const auto seconds = [](auto from) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  };
  const auto start = std::chrono::steady_clock::now();
  const float band = 3 * static_cast<float>(cell);
  auto grid = openvdb::FloatGrid::create(band);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(cell));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  auto accessor = grid->getAccessor();
  int first[3], last[3];
  for (int i = 0; i < 3; ++i) {
    first[i] = static_cast<int>(std::floor(lo[i] / cell / 8)) - 1;
    last[i] = static_cast<int>(std::ceil(hi[i] / cell / 8)) + 1;
  }
  const auto value = [&](int x, int y, int z) {
    return fathom_scene::distance(static_cast<float>(x * cell), static_cast<float>(y * cell), static_cast<float>(z * cell));
  };
  for (int bz = first[2]; bz < last[2]; ++bz)
    for (int by = first[1]; by < last[1]; ++by)
      for (int bx = first[0]; bx < last[0]; ++bx) {
        const float centre = value(8 * bx + 4, 8 * by + 4, 8 * bz + 4);
        if (std::abs(centre) > 7 * cell + band) {
          if (centre < 0) {
            const openvdb::CoordBBox block({8 * bx, 8 * by, 8 * bz}, {8 * bx + 7, 8 * by + 7, 8 * bz + 7});
            grid->fill(block, -band, false);
          }
          continue;
        }
        for (int i = 0; i < 512; ++i) {
          const openvdb::Coord at(8 * bx + (i & 7), 8 * by + (i >> 3 & 7), 8 * bz + (i >> 6));
          const float d = value(at.x(), at.y(), at.z());
          if (std::abs(d) < band) {
            accessor.setValue(at, d);
          } else {
            accessor.setValueOff(at, d < 0 ? -band : band);
          }
        }
      }
  const double sampling = seconds(start);
  const auto meshing = std::chrono::steady_clock::now();
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, adaptivity);
  std::printf("sampling %.2f s, meshing %.2f s, %zu triangles\n", sampling, seconds(meshing),
              triangles.size() + 2 * quads.size());
}
