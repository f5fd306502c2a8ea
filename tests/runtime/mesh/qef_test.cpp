#include "runtime/mesh/qef.h"
#include "tests/support/catch.h"

#include <glm/geometric.hpp>

namespace fathom::qef_test {

using namespace fathom::runtime;

TEST_CASE("qef: three planes meet in a corner, two in an edge, one leaves its plane free", "[mesh]") {
  const glm::dvec3 corner(0.3, -0.2, 0.6);
  Quadric quadric;
  quadric.add_plane(glm::normalize(glm::dvec3(1, 0.2, 0)), corner);
  CHECK(glm::distance(minimise(quadric, {0.3, 1, 1}, 0.01), {0.3, 1, 1}) > 0.1);
  CHECK(quadric.at(minimise(quadric, {0, 1, 1}, 0.01)) == Approx(0).margin(1e-15));
  quadric.add_plane({0, 0, 1}, corner);
  const glm::dvec3 on_edge = minimise(quadric, glm::dvec3(0), 0.01);
  CHECK(on_edge.z == Approx(0.6));
  CHECK(quadric.at(on_edge) == Approx(0).margin(1e-15));
  quadric.add_plane(glm::normalize(glm::dvec3(0.1, 1, 0.1)), corner);
  CHECK(glm::distance(minimise(quadric, glm::dvec3(0), 0.01), corner) < 1e-12);
}

TEST_CASE("qef: within a box the point stays in it, on the nearest part of the planes", "[mesh]") {
  const compiler::Box box{glm::dvec3(-1), glm::dvec3(1)};
  Quadric quadric;
  quadric.add_plane({1, 0, 0}, {3, 0, 0});
  CHECK(minimise_within(quadric, glm::dvec3(0), box, 0.01).x == 1);
  quadric.add_plane({0, 1, 0}, {0, 0.5, 0});
  const glm::dvec3 x = minimise_within(quadric, glm::dvec3(0), box, 0.01);
  CHECK(x.x == 1);
  CHECK(x.y == Approx(0.5).margin(0.02));
}

TEST_CASE("qef: sums of quadrics are the quadrics of all planes", "[mesh]") {
  Quadric a, b, both;
  const glm::dvec3 n = glm::normalize(glm::dvec3(1, 2, 3));
  a.add_plane(n, {1, 0, 0}), b.add_plane({0, 1, 0}, {0, 2, 0}, 3);
  both.add_plane(n, {1, 0, 0}), both.add_plane({0, 1, 0}, {0, 2, 0}, 3);
  a += b;
  const glm::dvec3 p(0.4, -1, 2);
  CHECK(a.at(p) == Approx(both.at(p)));
  CHECK(both.weight == 4);
  const double first = glm::dot(n, p - glm::dvec3(1, 0, 0));
  CHECK(both.at(p) == Approx(first * first + 3 * 9));
}

}  // namespace fathom::qef_test
