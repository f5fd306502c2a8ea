#include "runtime/image/image_diff.h"
#include "tests/support/catch.h"

#include <cmath>
#include <vector>

namespace fathom::runtime::image_diff_test {
namespace {

RgbView view(const std::vector<float>& rgb) { return {static_cast<int>(rgb.size() / 3), 1, rgb}; }

TEST_CASE("image diff: a picture does not differ from itself", "[image]") {
  const std::vector<float> picture = {0, 1, 1e6f, -2, 0.25f, 3};
  const Differences same = compare(view(picture), view(picture));
  CHECK(same.mse == 0);
  CHECK(same.relmse == 0);
  CHECK(same.max == 0);
  CHECK(same.mean == 0);
  CHECK(same.invalid == 0);
}

TEST_CASE("image diff: the measures are those of their formulas", "[image]") {
  const std::vector<float> picture = {1, 2, 3, 0, 0, 0.5f}, reference = {1, 0, 3, 1, 0, 0};
  const Differences differences = compare(view(picture), view(reference));
  CHECK(differences.mse == Approx((4 + 1 + 0.25) / 6));
  CHECK(differences.relmse == Approx((4 / 0.01 + 1 / 1.01 + 0.25 / 0.01) / 6));
  CHECK(differences.max == 2);
  CHECK(differences.mean == Approx((2 - 1 + 0.5) / 6));
  // The second argument is the reference.
  CHECK(compare(view(reference), view(picture)).relmse == Approx((4 / 4.01 + 1 / 0.01 + 0.25 / 0.26) / 6));
  CHECK(compare(view(reference), view(picture)).mean == Approx(-differences.mean));
}

TEST_CASE("image diff: what is not finite is counted and left out", "[image]") {
  const std::vector<float> picture = {NAN, 5, 5, 1, 1, 1, 2, 2, 2}, reference = {0, 0, 0, INFINITY, 1, 1, 1, 1, 1};
  const Differences differences = compare(view(picture), view(reference));
  CHECK(differences.invalid == 2);
  CHECK(differences.mse == 1);
  CHECK(differences.max == 1);
  const std::vector<float> nothing = {NAN, NAN, NAN};
  CHECK(compare(view(nothing), view(nothing)).mse == 0);
  CHECK(compare(view(nothing), view(nothing)).invalid == 1);
}

}  // namespace
}  // namespace fathom::runtime::image_diff_test
