// The box tree finds the same boxes as a test of each box.
#include "compiler/geometry/box_tree.h"
#include "tests/support/catch.h"

#include <random>

namespace fathom::box_tree_test {

namespace {

using namespace fathom::compiler;

TEST_CASE("box tree: finds what is not apart, in order, with fewer looks than boxes", "[geometry]") {
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<double>(random() % 1000) / 10; };
  std::vector<Box> boxes = {Box(), Box::everything()};
  while (boxes.size() < 1000) {
    const glm::dvec3 lo(number(), number(), number());
    boxes.push_back({lo, lo + glm::dvec3(number(), number(), number()) / 30.0});
  }
  const BoxTree tree(boxes);
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < boxes.size(); i += 7) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t j = 0; j < boxes.size(); ++j) {
      if (!apart(boxes[i], boxes[j])) expected.push_back(j);
    }
    const std::size_t looks = tree.find(boxes[i], found);
    CHECK(found == expected);
    if (expected.size() < 20) CHECK(looks < boxes.size() / 2);
  }
}

}  // namespace

}  // namespace fathom::box_tree_test
