#include "runtime/mesh/make_mesh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <unordered_set>

#include "runtime/mesh/contour.h"
#include "runtime/mesh/distance_proof.h"
#include "runtime/mesh/find_cells.h"
#include "runtime/mesh/simplify.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

// A cell's diagonal over its edge, with a margin for the rounding of its corners.
constexpr double kDiagonal = 1.7320508 * (1 + 0x1p-10);
// Bytes per cell that may hold the surface, measured as the process's largest size over the number of cells.
constexpr double kBytesPerCell = 900;
// Factor from one distance to the next when the last proof looks for the least that it can prove, their number, and
// the number of samples that it may take.
constexpr double kTighter = 0.75;
constexpr int kMostProofs = 12;
constexpr std::size_t kMostSamples = 48'000'000;
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

// Moves vertices apart that floats do not tell apart: readers of formats without indices join them. Moves are of one
// ulp, along one axis after the other.
void separate(TriangleMesh& mesh) {
  const auto less = [](const glm::vec3& a, const glm::vec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  };
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return less(glm::vec3(mesh.vertices[a]), glm::vec3(mesh.vertices[b]));
    });
    bool moved = false;
    for (std::size_t i = 1; i < order.size(); ++i) {
      const glm::vec3 here(mesh.vertices[order[i]]);
      if (glm::vec3(mesh.vertices[order[i - 1]]) != here) continue;
      const int axis = round % 3;
      mesh.vertices[order[i]][axis] = static_cast<double>(std::nextafter(here[axis], std::numeric_limits<float>::infinity()));
      moved = true;
    }
    if (!moved) return;
  }
}

// Returns true if all triangles are proved within `distance`. The result is the same for any number of threads.
bool holds_for_all(const MeshField& field, const TriangleMesh& mesh, double distance, int threads) {
  constexpr std::size_t kBatch = 256;
  std::atomic<bool> held = true;
  parallel_for(
      threads, (mesh.triangles.size() + kBatch - 1) / kBatch, [&] { return std::make_unique<DistanceProof>(field); },
      [&](std::unique_ptr<DistanceProof>& proof, std::size_t batch) {
        if (!held) return;
        proof->clear();
        const std::size_t end = std::min(mesh.triangles.size(), (batch + 1) * kBatch);
        for (std::size_t i = batch * kBatch; i < end; ++i) proof->add(mesh.corners(mesh.triangles[i]));
        if (!proof->holds(distance)) held = false;
      });
  return held;
}

// Returns the least distance that is proved for the mesh, starting from one that holds by construction.
double tighten(const MeshField& field, const TriangleMesh& mesh, double distance, int threads) {
  const double area = measure(mesh).area;
  for (int i = 0; i < kMostProofs; ++i) {
    const double next = kTighter * distance;
    // Four samples per square of the radius of a disc, and twice as many for the second try.
    if (24 * area / (next * next) > static_cast<double>(kMostSamples)) break;
    if (!holds_for_all(field, mesh, next, threads)) break;
    distance = next;
  }
  return distance;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t v) {
  while (parents[v] != v) v = parents[v] = parents[parents[v]];
  return v;
}

}  // namespace

double tolerance_of(const compiler::Box& box, double resolution) {
  const glm::dvec3 size = box.hi - box.lo;
  return kDiagonal * std::max({size.x, size.y, size.z}) / resolution;
}

MeshMeasures measure(const TriangleMesh& mesh) {
  MeshMeasures measures;
  std::vector<std::uint32_t> parents(mesh.vertices.size());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const Triangle& triangle : mesh.triangles) {
    const auto corners = mesh.corners(triangle);
    measures.volume += glm::dot(corners[0], glm::cross(corners[1], corners[2])) / 6;
    measures.area += 0.5 * glm::length(area_normal(corners));
    for (const std::size_t i : {1u, 2u}) {
      parents[root_of(parents, triangle.vertices[i])] = root_of(parents, triangle.vertices[0]);
    }
  }
  for (std::uint32_t v = 0; v < parents.size(); ++v) measures.components += root_of(parents, v) == v;
  return measures;
}

MeshResult make_mesh(const compiler::CompiledScene& scene, const compiler::Box& box, const MeshOptions& options) {
  using End = MeshResult::End;
  MeshResult result;
  const auto begin = [&](std::string_view step) {
    if (options.progress) options.progress(step);
  };
  result.cell = options.tolerance / kDiagonal;
  const CellLattice lattice = make_lattice(box, result.cell);
  if (lattice.cell == 0 || lattice.diagonal > options.tolerance) {
    result.end = End::TooFine;
    return result;
  }
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
    result.lost = find_lost_parts(field, lattice, signs, options.threads);
    contoured = contour(lattice, signs, find_crossings(field, lattice, signs, options.threads));
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
    simplify(field, contoured, {options.tolerance, materials});
  }
  result.mesh = std::move(contoured.mesh);
  separate(result.mesh);
  begin("proof");
  result.bound = tighten(field, result.mesh, options.tolerance, options.threads);
  return result;
}

}  // namespace fathom::runtime
