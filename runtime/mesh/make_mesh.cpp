#include "runtime/mesh/make_mesh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "runtime/mesh/contour.h"
#include "runtime/mesh/distance_proof.h"
#include "runtime/mesh/lattice/find_cells.h"
#include "runtime/mesh/mesh_measures.h"
#include "runtime/mesh/move_to_surface.h"
#include "runtime/mesh/simplify.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

// A cell's diagonal over its edge, with a margin for the rounding of coordinates.
constexpr double kDiagonal = 1.7320508 * (1 + 0x1p-10);
// Bytes per cell that may hold the surface. The sheet of tests/data/meshes/gyroid-box.fathom, of whose cells two
// thirds are crossed, takes 282.
constexpr double kBytesPerCell = 400;
// Distances that the last proof tries, from one slightly above the deviation upwards, and the max number of samples.
constexpr double kFirstProof = 1.2, kNextProof = 1.25;
constexpr double kMostSamples = 24e6;
// Edge of the blocks that threads simplify, in cells.
constexpr double kBlockCells = 40;
// Evaluations per cell, for the decision what preparing the field may cost.
constexpr double kEvaluationsPerCell = 60;

Field prepare_field(const compiler::CompiledScene& scene, double cells, int threads) {
  Field field = make_field(scene);
  RegionOptions regions;
  regions.threads = threads;
  regions.evaluations = kEvaluationsPerCell * cells;
  add_regions(field, scene, regions);
  add_native_code(field, regions.evaluations);
  return field;
}

// Moves vertices apart that floats do not tell apart in the scene's coordinates: readers of formats without indices
// join them. Moves are of one ulp, along one axis after the other.
void separate(TriangleMesh& mesh, glm::dvec3 origin) {
  const auto less = [](const glm::vec3& a, const glm::vec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  const auto place = [&](std::uint32_t v) { return glm::vec3(mesh.vertices[v] + origin); };
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  constexpr int kRounds = 24;
  for (int round = 0; round < kRounds; ++round) {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return less(place(a), place(b)); });
    const int axis = round % 3;
    bool moved = false;
    for (std::size_t i = order.size(); i-- > 1;) {
      const glm::vec3 here = place(order[i]);
      if (place(order[i - 1]) != here) continue;
      const float next = std::nextafter(here[axis], std::numeric_limits<float>::infinity());
      mesh.vertices[order[i]][axis] = static_cast<double>(next) - origin[axis];
      moved = true;
    }
    if (!moved) return;
  }
}

// Returns the distance by which files, which hold floats, may move points of the scene's coordinates.
double file_rounding(const compiler::Box& box, glm::dvec3 origin) {
  const compiler::Box all = box.moved(origin);
  return 0x1p-23 * std::max(compiler::largest_part(all.lo), compiler::largest_part(all.hi));
}

// Returns the triangles among `some` that are not proved within `distance`, the same for any number of threads.
std::vector<std::uint32_t> unproved(const MeshField& field, const TriangleMesh& mesh,
                                    const std::vector<std::uint32_t>& some, double distance, int threads) {
  std::vector<std::uint8_t> held(some.size());
  constexpr std::size_t kBatch = 8;
  parallel_for(
      threads, (some.size() + kBatch - 1) / kBatch, [&] { return std::make_unique<DistanceProof>(field); },
      [&](std::unique_ptr<DistanceProof>& proof, std::size_t batch) {
        for (std::size_t i = batch * kBatch; i < std::min(some.size(), (batch + 1) * kBatch); ++i) {
          proof->clear();
          proof->add(mesh.corners(mesh.triangles[some[i]]));
          held[i] = proof->is_near(distance);
        }
      });
  std::vector<std::uint32_t> left;
  for (std::size_t i = 0; i < some.size(); ++i) {
    if (!held[i]) left.push_back(some[i]);
  }
  return left;
}

// Returns the least distance that is proved for the mesh, at most `tolerance`, which holds by construction.
double prove(const MeshField& field, const TriangleMesh& mesh, double deviation, double tolerance, int threads) {
  const double area = measure(mesh).area;
  std::vector<std::uint32_t> left(mesh.triangles.size());
  std::iota(left.begin(), left.end(), 0u);
  for (double distance = kFirstProof * deviation; distance < tolerance; distance *= kNextProof) {
    // Flat parts take about ten samples per square of the distance.
    if (10 * area > kMostSamples * distance * distance) continue;
    left = unproved(field, mesh, left, distance, threads);
    if (left.empty()) return distance;
  }
  return tolerance;
}

}  // namespace

double tolerance_of(const compiler::Box& box, double resolution) {
  const glm::dvec3 size = box.hi - box.lo;
  return kDiagonal * std::max({size.x, size.y, size.z}) / resolution;
}

double fine_deviation(double tolerance) {
  constexpr double kCellShare = 0.2;
  return kCellShare * tolerance / kDiagonal;
}

MeshResult make_mesh(const compiler::CompiledScene& scene, const compiler::Box& box, const MeshOptions& options) {
  using End = MeshResult::End;
  MeshResult result;
  const auto begin = [&](std::string_view step) {
    if (options.progress) options.progress(step);
  };
  const double rounding = file_rounding(box, scene.origin);
  result.cell = (options.tolerance - rounding) / kDiagonal;
  const CellLattice lattice = result.cell > 0 ? make_lattice(box, result.cell) : CellLattice{};
  if (lattice.cell == 0 || lattice.diagonal + rounding > options.tolerance) {
    result.end = End::TooFine;
    return result;
  }
  const double within = lattice.diagonal;  // by construction, and a little less than the tolerance
  begin("cells");
  const glm::dvec3 size = (box.hi - box.lo) / result.cell;
  const double shell = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
  const Field prepared = prepare_field(scene, shell, options.threads);
  const MeshField field(prepared, options.is_clipped ? box : compiler::Box::everything());
  const auto most = static_cast<std::size_t>(options.memory / kBytesPerCell);
  FoundCells found = find_cells(field, lattice, most, options.threads);
  result.cells = found.cells.size();
  if (found.too_many) {
    result.end = End::TooMany;
    result.memory = kBytesPerCell * static_cast<double>(found.expected);
    return result;
  }
  begin("surface");
  Contour contoured;
  {
    const SignedLattice signs(found.cells, signs_of(field, lattice, options.threads));
    found.cells = {};
    LostParts lost = find_lost_parts(field, lattice, signs, options.threads);
    result.lost = std::move(lost.parts), result.islands = lost.islands;
    contoured = contour(lattice, signs, find_crossings(field, lattice, signs, options.threads));
    move_to_surface(field, lattice, contoured, options.threads);
  }
  result.contour_triangles = contoured.mesh.triangles.size();
  if (contoured.mesh.triangles.empty()) {
    result.end = End::Empty;
    return result;
  }
  if (options.simplifies) {
    begin("simplification");
    std::vector<std::uint32_t> materials;
    for (const compiler::Surface& surface : scene.surfaces) materials.push_back(surface.material);
    if (materials.empty()) materials.push_back(0);
    simplify(field, contoured,
             {within, std::min(options.deviation, within), kBlockCells * result.cell, options.threads, materials});
  }
  result.mesh = std::move(contoured.mesh);
  separate(result.mesh, scene.origin);
  begin("proof");
  result.bound = prove(field, result.mesh, options.deviation, within, options.threads) + rounding;
  return result;
}

}  // namespace fathom::runtime
