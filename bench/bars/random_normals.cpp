// B11: gradients on the surfaces of random primitives, and normals at points where the gradient is undefined.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "bench/bars/bars.h"
#include "compiler/shapes/make_node.h"
#include "runtime/path/surface.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"

namespace fathom::bench {
namespace {

using compiler::Kind;
using glm::dvec3;

// Adds a random primitive. Outlines (2-D shapes) are extruded or revolved.
compiler::NodeId add_primitive(compiler::NodeMaker& maker, test::Random& random, Kind kind,
                               const std::vector<double>& params) {
  const compiler::NodeId shape = maker.make(kind, params, {});
  if (compiler::spec(kind).sort == compiler::Sort::Solid) return shape;
  const compiler::NodeId children[] = {shape};
  if (random.chance(0.5)) return maker.make(Kind::Extrude, std::vector<double>{random.length(0.05, 1.5)}, children);
  return maker.make(Kind::Revolve, std::vector<double>{random.uniform(0, 2)}, children);
}

compiler::CompiledScene scene_of(test::Random& random, Kind kind, const std::vector<double>& params) {
  compiler::Scene graph;
  compiler::NodeMaker maker(graph.graph);
  graph.root = add_primitive(maker, random, kind, params);
  const vm::VerifiedProgram program = test::plain_lowering(graph);
  const compiler::NodeFacts& known = maker.known(graph.root);
  compiler::CompiledField field{program,        program, known.box, known.box, known.lipschitz, known.cancellation,
                                known.certified};
  compiler::CompiledScene scene{{}, std::move(field), {}, dvec3(0), {}, {}, {}, {}, {}, graph.graph.size(), {}};
  scene.surfaces.push_back({"it", 0});
  scene.materials.emplace_back();
  return scene;
}

// Returns a random point in or around a shape of size 1. Many points lie on an axis, a coordinate plane, a diagonal,
// or at a corner or edge of the box whose half size is the first three parameters.
dvec3 random_place(test::Random& random, const std::vector<double>& params) {
  const double half[] = {0.5, 1, 2, 2};
  dvec3 p = random.in_box(half[random.below(4)]);
  if (random.chance(0.1)) p[random.below(3)] = 0;
  if (random.chance(0.05)) p = dvec3(0, p.y, 0);
  if (random.chance(0.03)) p.z = p.x;
  if (random.chance(0.05) && params.size() >= 3) {
    p = dvec3(params[0], params[1], params[2]) * random.uniform(0.5, 2);
    if (random.chance(0.5)) p[random.below(3)] *= random.uniform(0, 1);
  }
  return p;
}

// Returns the point, rounded to float, where the segment from a to b crosses the surface. Empty when both ends are on
// the same side.
std::optional<dvec3> surface_between(const vm::VerifiedProgram& program, dvec3 a, dvec3 b, vm::Workspace& workspace) {
  const bool inside = vm::evaluate_distance(program, a, workspace) < 0;
  if (inside == (vm::evaluate_distance(program, b, workspace) < 0)) return std::nullopt;
  for (int i = 0; i < 40; ++i) {
    const dvec3 middle = (a + b) / 2.0;
    ((vm::evaluate_distance(program, middle, workspace) < 0) == inside ? a : b) = middle;
  }
  return dvec3(glm::vec3(a));
}

// True if the field, in double, rises along `gradient` at p or at a point that float cannot distinguish from p. At an
// edge between faces, the gradient of any of these faces is accepted.
bool rises_along(const vm::VerifiedProgram& program, dvec3 p, dvec3 gradient, test::Random& random,
                 vm::Workspace& workspace) {
  constexpr double kStep = 1e-8, kNear = 8 * vm::kFloatError;
  const dvec3 step = kStep * glm::normalize(gradient);
  for (int i = 0; i < 64; ++i) {
    const dvec3 q = i == 0 ? p : p + random.in_box(kNear);
    if (vm::evaluate_distance(program, q + step, workspace) > vm::evaluate_distance(program, q - step, workspace))
      return true;
  }
  return false;
}

// True if the field, in double, has a first derivative at p along some axis. At the centre of a torus without a hole,
// two tips of the solid meet: no axis has a derivative there, and no direction is the normal.
bool changes_at(const vm::VerifiedProgram& program, dvec3 p, vm::Workspace& workspace) {
  constexpr double kStep = 1e-7;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 step(0);
    step[axis] = kStep;
    const double after = vm::evaluate_distance(program, p + step, workspace);
    const double before = vm::evaluate_distance(program, p - step, workspace);
    if (std::abs(after - before) > 0.1 * kStep) return true;
  }
  return false;
}

struct Tally {
  std::size_t on_surface = 0, anywhere = 0;
  std::size_t reversed = 0, zero = 0, not_numbers = 0;  // gradients on the surface
  std::size_t unfit = 0;  // normals that are not of unit length or point away from the ray
};

// Tries random points of one primitive.
class Trial {
 public:
  Trial(test::Random& random, Kind kind, vm::Workspace& workspace, Tally& tally)
      : random_(random),
        params_(test::random_params(kind, random)),
        scene_(scene_of(random, kind, params_)),
        field_(runtime::make_field(scene_)),
        workspace_(workspace),
        tally_(tally) {}

  void try_surface() {
    const dvec3 from = random_place(random_, params_), to = random_place(random_, params_);
    const std::optional<dvec3> p = surface_between(scene_.surface, from, to, workspace_);
    if (!p) return;
    ++tally_.on_surface;
    const dvec3 g = gradient(*p);
    const double length = glm::length(g);
    if (!std::isfinite(length)) {
      ++tally_.not_numbers;
    } else if (length < 1e-3) {
      tally_.zero += changes_at(scene_.surface, *p, workspace_);
    } else if (!rises_along(scene_.surface, *p, g, random_, workspace_)) {
      ++tally_.reversed;
    }
    check_normal(*p);
  }
  void try_anywhere() { check_normal(random_.chance(0.05) ? dvec3(0) : random_place(random_, params_)); }

 private:
  dvec3 gradient(dvec3 p) {
    const glm::vec3 at(p);
    float distance, x, y, z;
    std::uint32_t surface;
    vm::evaluate_surface(scene_.surface, {&at.x, &at.y, &at.z}, 1, {&distance, &x, &y, &z, &surface}, workspace_);
    return {x, y, z};
  }

  void check_normal(dvec3 p) {
    const runtime::Hit hit{p, glm::vec3(random_.direction()), random_.chance(0.5) ? 1 : -1, 1e-7f};
    runtime::SurfacePoint point;
    runtime::find_surfaces(scene_, field_, {&hit, 1}, {&point, 1}, workspace_);
    const bool unit = std::abs(glm::length(dvec3(point.normal)) - 1) < 1e-6;
    ++tally_.anywhere;
    tally_.unfit += !(unit && glm::dot(point.normal, hit.wo) > 0);
  }

  test::Random& random_;
  const std::vector<double> params_;
  const compiler::CompiledScene scene_;
  const runtime::Field field_;
  vm::Workspace& workspace_;
  Tally& tally_;
};

}  // namespace

void random_normal_bars(BarTable& table, const Counts& counts) {
  constexpr int kPlaces = 64;  // per primitive
  std::vector<Kind> kinds = test::primitive_kinds(compiler::Sort::Solid, false);
  const std::vector<Kind> outlines = test::primitive_kinds(compiler::Sort::Outline, false);
  kinds.insert(kinds.end(), outlines.begin(), outlines.end());
  Tally tally;
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; tally.on_surface < counts.normals; ++seed) {
    test::Random random(seed);
    Trial trial(random, kinds[seed % kinds.size()], workspace, tally);
    for (int i = 0; i < kPlaces; ++i) trial.try_surface(), trial.try_anywhere();
  }
  const std::string where = fmt::format("{} random primitives", kinds.size());
  table.none("B11", where + ", on the surface: reversed gradients", tally.reversed, tally.on_surface);
  table.none("B11", where + ", on the surface: zero gradients where there is one", tally.zero, tally.on_surface);
  table.none("B11", where + ", on the surface: gradients that are not numbers", tally.not_numbers, tally.on_surface);
  table.none("B11", where + ", anywhere: normals not of length 1 or not to the ray", tally.unfit, tally.anywhere);
}

}  // namespace fathom::bench
