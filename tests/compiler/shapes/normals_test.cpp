// Gradients of every primitive and of random graphs: unit length on the surface, never NaN, equal to difference
// quotients.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "tests/compiler/shapes/primitives.h"
#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/scaled_cases.h"

namespace fathom::test::normals_test {
namespace {

using compiler::Kind;
using compiler::NodeSpec;
using glm::dvec3;

// Moves p onto the surface along the gradient. Returns false if p does not converge.
bool to_surface(const vm::VerifiedProgram& program, dvec3& p, vm::Workspace& workspace) {
  for (int i = 0; i < 60; ++i) {
    const vm::SurfaceValue v = vm::evaluate_surface(program, p, workspace);
    if (std::abs(v.distance) < 1e-12) return true;
    p -= v.distance * v.gradient;
  }
  return false;
}

dvec3 central_difference(const vm::VerifiedProgram& program, dvec3 p, double h, vm::Workspace& workspace) {
  dvec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 before = p, after = p;
    before[axis] -= h;
    after[axis] += h;
    const double rise =
        vm::evaluate_distance(program, after, workspace) - vm::evaluate_distance(program, before, workspace);
    slope[axis] = rise / (after[axis] - before[axis]);
  }
  return slope;
}

// True if the surface has a point on the axis with a whole cone of normals. Only the direction of the gradient is
// known there.
bool has_tip(Kind kind, const std::vector<double>& k) {
  if (kind == Kind::InfiniteCone) return true;
  return (kind == Kind::Cone && (k[0] == 0 || k[1] == 0)) || (kind == Kind::Torus && k[1] >= k[0]);
}

bool finite(dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

TEST_CASE("the gradient is a unit vector on the surface", "[shapes][normals]") {
  vm::Workspace workspace;
  for_each_primitive([&](const NodeSpec& row) {
    if (estimated(row.kind)) return;
    int settled = 0;
    for (int seed = 0; seed < scaled_cases(60); ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      const vm::VerifiedProgram program = plain_lowering(s.scene);
      for (int i = 0; i < 50; ++i) {
        dvec3 p = random_point(random);
        if (!to_surface(program, p, workspace)) continue;
        ++settled;
        INFO(s.name << ", seed " << seed << ", at " << place(p));
        if (has_tip(row.kind, s.params) && std::hypot(p.x, p.z) < 1e-6) {
          const double length = glm::length(vm::evaluate_surface(program, p, workspace).gradient);
          CHECK(length <= 1 + 1e-9);
          if (row.kind != Kind::Torus || s.params[0] != s.params[1])
            CHECK(length > 1e-3);  // a ring without a hole touches itself at the centre
          continue;
        }
        if (periodic(row.kind)) {  // sampled lengths are 0.41 and more
          const double length = glm::length(vm::evaluate_surface(program, p, workspace).gradient);
          CHECK(length > 0.4);
          CHECK(length <= 1 + 1e-9);
          continue;
        }
        CHECK(std::abs(glm::length(vm::evaluate_surface(program, p, workspace).gradient) - 1) <= 1e-9);
        CHECK(std::abs(glm::length(evaluate_float(program, p, workspace).gradient) - 1) <= 1e-6);
      }
    }
    INFO(row.name);
    CHECK(settled > scaled_cases(2500));
  });
}

// At distances up to 1e3 from the origin: the spacing of floats there must not tilt the normal.
TEST_CASE("float normals of smooth shapes are within 1e-6 radians", "[shapes][normals]") {
  vm::Workspace workspace;
  for (Kind kind : {Kind::Sphere, Kind::Torus, Kind::Plane, Kind::RoundCone}) {
    for (int seed = 0; seed < scaled_cases(40); ++seed) {
      Random random(seed);
      const Sample s = sample(kind, random);
      compiler::Scene scene = s.scene;
      // A ring's normal turns over the tube's small radius, while the floats are spaced for the large radius.
      const double slender = kind == Kind::Torus ? std::max(1.0, s.params[0] / s.params[1] / 4) : 1;
      const double reach[] = {0, 1, 1000};
      const dvec3 away = random.in_box(reach[seed % 3]);
      const auto move = transform_params(dvec3(1), dvec3(0, 1, 0), 0, away);
      scene.root = scene.graph.add(Kind::Transform, move, std::vector{scene.root});
      const vm::VerifiedProgram program = plain_lowering(scene);
      for (int i = 0; i < 50; ++i) {
        dvec3 p = away + random.in_box(2);
        if (!to_surface(program, p, workspace)) continue;
        for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(static_cast<float>(p[axis]));
        const dvec3 exact = vm::evaluate_surface(program, p, workspace).gradient;
        if (glm::length(exact) < 0.99 || glm::length(p - away) < 1e-3) continue;  // a torus' cusp or pinched centre
        const dvec3 narrow = evaluate_float(program, p, workspace).gradient;
        INFO(s.name << ", seed " << seed << ", at " << place(p));
        CHECK(glm::length(glm::cross(glm::normalize(narrow), glm::normalize(exact))) <= 1e-6 * slender);
        CHECK(glm::dot(narrow, exact) > 0);
      }
    }
  }
}

TEST_CASE("gradients never are NaN: centres, axes, edges, corners", "[shapes][normals]") {
  vm::Workspace workspace;
  for_each_primitive([&](const NodeSpec& row) {
    for (int seed = 0; seed < scaled_cases(32); ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      const vm::VerifiedProgram program = plain_lowering(s.scene);
      const compiler::Box box = row.bound(s.params);
      for (int i = 0; i < 125; ++i) {  // corner, edge and face centres of the box, and points beyond them
        dvec3 p;
        const int steps[] = {i % 5, i / 5 % 5, i / 25};
        for (int axis = 0; axis < 3; ++axis) {
          const double at[] = {0, box.lo[axis], box.hi[axis], 2 * box.hi[axis], 0.5 * box.lo[axis]};
          p[axis] = std::clamp(at[steps[axis]], -9.0, 9.0);
        }
        INFO(s.name << ", seed " << seed << ", at " << place(p));
        for (const vm::SurfaceValue& v :
             {vm::evaluate_surface(program, p, workspace), evaluate_float(program, p, workspace)}) {
          CHECK(finite(v.gradient));
          CHECK(std::isfinite(v.distance));
          if (!estimated(row.kind)) CHECK(glm::length(v.gradient) <= 1 + 1e-6);
        }
      }
    }
  });
}

TEST_CASE("gradients are what differences say, away from creases", "[shapes][normals]") {
  vm::Workspace workspace;
  const auto check = [&](const compiler::Scene& scene, Random& random, int points) {
    const vm::VerifiedProgram program = plain_lowering(scene);
    int smooth = 0;
    for (int i = 0; i < points; ++i) {
      const dvec3 p = random.in_box(2);
      const dvec3 fine = central_difference(program, p, 1e-5, workspace);
      const dvec3 coarse = central_difference(program, p, 4e-5, workspace);
      if (glm::length(fine - coarse) > 1e-7) continue;  // a crease or strong curvature nearby
      ++smooth;
      INFO("at " << place(p));
      const dvec3 exact = vm::evaluate_surface(program, p, workspace).gradient;
      CHECK(glm::length(exact - fine) <= 1e-7);
      CHECK(glm::length(evaluate_float(program, p, workspace).gradient - exact) <= 1e-3);
    }
    return smooth;
  };
  for_each_primitive([&](const NodeSpec& row) {
    int smooth = 0;
    for (int seed = 0; seed < scaled_cases(40); ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      INFO(s.name << ", seed " << seed);
      smooth += check(s.scene, random, 50);
    }
    INFO(row.name);
    if (!estimated(row.kind)) CHECK(smooth > scaled_cases(1000));
  });
  for (int seed = 0; seed < scaled_cases(300); ++seed) {
    Random random(seed);
    const compiler::Scene scene = random_scene(random);
    INFO("random graph, seed " << seed);
    check(scene, random, 20);
  }
}

}  // namespace fathom::test::normals_test
