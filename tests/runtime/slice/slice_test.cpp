#include "runtime/slice/slice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "vm/interpret/evaluate.h"

namespace fathom::slice_test {

namespace {

using namespace fathom::runtime;
using fathom::compiler::Box;

constexpr double kInf = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("slice: the views are right-handed, pixels are met at their centres", "[slice]") {
  Slice slice{Axis::Z, 7, {-2, 10}, {2, 14}, 4, 2};
  CHECK(slice.point(0, 0) == glm::dvec3(-1.5, 13, 7));  // top left: smallest x, largest y
  CHECK(slice.point(3, 1) == glm::dvec3(1.5, 11, 7));
  slice.axis = Axis::Y;  // up is -z
  CHECK(slice.point(0, 0) == glm::dvec3(-1.5, 7, 11));
  CHECK(slice.point(3, 1) == glm::dvec3(1.5, 7, 13));
  slice.axis = Axis::X;  // right is -z
  CHECK(slice.point(0, 0) == glm::dvec3(7, 13, 1.5));
  CHECK(slice.point(3, 1) == glm::dvec3(7, 11, -1.5));
  for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
    slice.axis = axis;
    const glm::dvec3 right = slice.point(1, 1) - slice.point(0, 1), up = slice.point(0, 0) - slice.point(0, 1);
    CHECK(glm::cross(right, up)[static_cast<int>(axis)] > 0);
  }
}

TEST_CASE("slice: a bound is shown whole with a margin, in square pixels", "[slice]") {
  const Slice slice = frame_slice({{-1, -2, -3}, {1, 2, 3}}, Axis::Z, 0, 200, 100);
  CHECK(slice.lo.y == Approx(-2.2));
  CHECK(slice.hi.y == Approx(2.2));
  CHECK(slice.lo.x == Approx(-4.4));
  CHECK(slice.hi.x == Approx(4.4));
  CHECK(frame_slice({{-1, -2, -3}, {1, 2, 3}}, Axis::X, 0, 100, 100).hi.x == Approx(3.3));
}

TEST_CASE("slice: sides without an end, empty and flat bounds have a frame too", "[slice]") {
  const Box boxes[] = {Box::everything(),
                       Box{},
                       {{-kInf, -kInf, -kInf}, {kInf, 0, kInf}},
                       {{1, 1, 1}, {1, 1, 1}},
                       {{-kInf, 5, 5}, {-9, 6, 6}}};
  for (const Box& box : boxes) {
    const Slice slice = frame_slice(box, Axis::Z, 0, 30, 20);
    CHECK(std::isfinite(slice.lo.x + slice.lo.y + slice.hi.x + slice.hi.y));
    CHECK((slice.lo.x < slice.hi.x && slice.lo.y < slice.hi.y));
    CHECK((slice.hi.x - slice.lo.x) / 30 == Approx((slice.hi.y - slice.lo.y) / 20));
  }
  const Slice floor = frame_slice(boxes[2], Axis::Z, 0, 10, 10);
  CHECK((floor.lo.x <= -2 && floor.hi.x >= 2 && floor.lo.y <= -2 && floor.hi.y >= 0));
}

TEST_CASE("slice: values are those of the machine, for any number of threads", "[slice]") {
  const auto scene =
      scene_of(R"("objects": [{"type": "box", "half_size": [1, 2, 3], "translate": [0.25, 0.5, -0.75]}])");
  for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
    const Slice slice = frame_slice(scene.bound, axis, 0.125, 37, 23);
    const std::vector<float> field = evaluate_slice(scene.distance, slice, 1);
    CHECK(evaluate_slice(scene.distance, slice, 5) == field);
    fathom::vm::Workspace workspace;
    for (int row = 0; row < 23; ++row) {
      for (int column = 0; column < 37; ++column) {
        const double expected = fathom::vm::evaluate_distance(scene.distance, slice.point(column, row), workspace);
        const float actual = field[static_cast<std::size_t>(row * 37 + column)];
        CHECK(static_cast<double>(actual) == Approx(expected).margin(1e-5));
      }
    }
  }
}

TEST_CASE("slice: signs are those of the values, with few choices and with many", "[slice]") {
  std::string row;
  for (int i = 0; i < 40; ++i)
    row += fmt::format(R"(, {{"type": "sphere", "radius": 1, "translate": [{}, {}, 0]}})", 3 * i, i % 7);
  for (const std::string& more : {std::string(), row}) {
    const auto scene = scene_of(R"("objects": [{"type": "box", "half_size": [1, 2, 3]})" + more + "]");
    const Slice slice = frame_slice(scene.bound, Axis::Z, 0.125, 300, 90);
    const std::vector<float> values = evaluate_slice(scene.distance, slice, 1);
    for (const int threads : {1, 3}) {
      const std::vector<float> signs = evaluate_slice(scene.distance, slice, threads, SliceValues::Sign);
      CHECK(std::equal(values.begin(), values.end(), signs.begin(),
                       [](float a, float b) { return (a < 0) == (b < 0); }));
    }
  }
}

TEST_CASE("slice: a picture of signs is white exactly where values are negative", "[slice]") {
  const std::vector<float> field = {-1, -0.0f, 0, 1e-30f, -1e-30f, std::nanf("")};
  CHECK(sign_image(field, 3, 2).rgb ==
        std::vector<std::uint8_t>({255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 0, 0, 0}));
}

TEST_CASE("slice: bands have round steps", "[slice]") {
  CHECK(band_step(10) == Approx(1));
  CHECK(band_step(2.2) == Approx(0.2));
  CHECK(band_step(4.4) == Approx(0.5));
  CHECK(band_step(80) == Approx(10));
  CHECK(band_step(3e-7) == Approx(2e-8));
  // Steps are equal as numbers, not almost: a report prints them. From 1 to 2 the middle is the square root of 2.
  CHECK(band_step(1e4) == 1000);
  CHECK(band_step(14.142) == 1);
  CHECK(band_step(14.143) == 2);
  CHECK(band_step(1e-5) == Approx(1e-6).epsilon(1e-15));
}

TEST_CASE("slice: a picture of distances tells inside from outside, the surface and what is not a number",
          "[slice]") {
  // A row of distances with a surface in the middle. One pixel is a tenth of a band.
  constexpr int kWidth = 41;
  std::vector<float> field;
  for (int i = 0; i < kWidth; ++i) field.push_back(static_cast<float>(i - 20) * 0.1f);
  const std::vector<std::uint8_t> rgb = distance_image(field, kWidth, 1, 1).rgb;
  const auto at = [&](int x) { return &rgb[static_cast<std::size_t>(3 * x)]; };
  CHECK(at(5)[2] > at(5)[0]);    // blue
  CHECK(at(35)[0] > at(35)[2]);  // orange
  CHECK((at(20)[0] < 20 && at(20)[1] < 20 && at(20)[2] < 20));
  CHECK(at(30)[1] < at(28)[1]);  // the line at 1
  CHECK(at(10)[1] < at(12)[1]);  // the line at -1
  CHECK(distance_image({std::nanf(""), 1}, 2, 1, 1).rgb[1] == 0);
  const float inf = std::numeric_limits<float>::infinity();
  CHECK(distance_image({inf, -inf, 1, 0}, 2, 2, 1).rgb.size() == 12);
}

TEST_CASE("slice: a region all at one level is no line", "[slice]") {
  const std::vector<std::uint8_t> rgb = distance_image({1, 1, 1, 1}, 2, 2, 1).rgb;
  CHECK(rgb[0] > 230);
}

}  // namespace fathom::slice_test
