// A ray meets the boxes in its way in the order in which it enters them, whatever the tree.
#include "runtime/field/piece_boxes.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"

namespace fathom::piece_boxes_test {

namespace {

using namespace fathom;
using namespace fathom::runtime;

std::vector<BoxedPiece> met(const PieceBoxes& boxes, glm::dvec3 origin, glm::dvec3 direction, double length,
                            double reach) {
  PieceBoxes::Visit visit;
  boxes.begin(origin, direction, length, visit);
  std::vector<BoxedPiece> all;
  for (BoxedPiece found; boxes.next(visit, reach, found);) all.push_back(found);
  return all;
}

}  // namespace

TEST_CASE("piece boxes: a ray meets no box that begins beyond its length or its reach", "[field][pieces]") {
  const std::vector<compiler::Box> list = {
      {{-1, -1, -9}, {1, 1, -8}}, {{-1, -1, -4}, {1, 1, -2}}, {{3, 3, 3}, {4, 4, 4}}, {}};
  const PieceBoxes boxes(list);
  const std::vector<BoxedPiece> found = met(boxes, {0, 0, 0}, {0, 0, -1}, 100, 100);
  REQUIRE(found.size() == 2);
  CHECK(found[0].piece == 1);
  CHECK(found[0].entry == Approx(2).margin(1e-4));
  CHECK(found[0].exit == Approx(4).margin(1e-4));
  CHECK(found[1].piece == 0);
  CHECK(met(boxes, {0, 0, 0}, {0, 0, -1}, 5, 100).size() == 1);
  CHECK(met(boxes, {0, 0, 0}, {0, 0, -1}, 100, 5).size() == 1);
  const std::vector<BoxedPiece> within = met(boxes, {0, 0, -3}, {0, 0, 1}, 5, 100);
  REQUIRE(within.size() == 1);
  CHECK(within[0].entry == 0);
  CHECK(met(PieceBoxes(), {0, 0, 0}, {0, 0, 1}, 5, 5).empty());
}

TEST_CASE("piece boxes: a tree of many boxes finds what each box alone finds, in one order", "[field][pieces]") {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  for (int seed = 0; seed < test::scaled_cases(12); ++seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    std::vector<compiler::Box> list;
    for (int i = 0; i < 8 << seed % 8; ++i) {
      const glm::dvec3 lo = random.in_box(4);
      list.push_back({lo, lo + 0.5 * (glm::dvec3(1) + random.in_box(1))});
      if (i % 5 == 0) list.back() = list[list.size() / 2];  // boxes with one entry
    }
    for (int i = 0; i < seed; ++i) list.push_back({{-kEndless, -kEndless, -kEndless}, {kEndless, -1.0 * i, kEndless}});
    const PieceBoxes boxes(list);
    for (int k = 0; k < 50; ++k) {
      const glm::dvec3 origin = random.in_box(5), direction = random.direction();
      std::vector<BoxedPiece> alone;
      for (std::size_t i = 0; i < list.size(); ++i) {
        for (BoxedPiece found : met(PieceBoxes({&list[i], 1}), origin, direction, 20, 20)) {
          found.piece = static_cast<std::int32_t>(i);
          alone.push_back(found);
        }
      }
      std::ranges::sort(alone, [](const BoxedPiece& a, const BoxedPiece& b) {
        return a.entry < b.entry || (a.entry == b.entry && a.piece < b.piece);
      });
      const std::vector<BoxedPiece> together = met(boxes, origin, direction, 20, 20);
      REQUIRE(together.size() == alone.size());
      for (std::size_t i = 0; i < alone.size(); ++i) {
        CHECK(together[i].piece == alone[i].piece);
        CHECK(together[i].entry == alone[i].entry);
        CHECK(together[i].exit == alone[i].exit);
      }
    }
  }
}

}  // namespace fathom::piece_boxes_test
