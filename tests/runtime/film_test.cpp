#include "runtime/film.h"

#include <catch2/catch.hpp>

namespace fathom::runtime {
namespace {

PathSample sample_of(float value, double depth) {
  PathSample sample;
  sample.radiance = glm::vec3(value, 2 * value, 0);
  sample.hit = depth > 0;
  sample.albedo = glm::vec3(0.5f);
  sample.normal = glm::vec3(0, 1, 0);
  sample.depth = depth;
  return sample;
}

TEST_CASE("film: means over all samples, depth over those that hit", "[runtime]") {
  Film film(2, 1);
  CHECK(film.add(1, 0, sample_of(1, 4)));
  CHECK(film.add(1, 0, sample_of(3, 0)));
  const PixelMeans means = film.means(1, 0);
  CHECK(means.radiance == glm::dvec3(2, 4, 0));
  CHECK(means.albedo == glm::dvec3(0.25));
  CHECK(means.depth == 4);
  CHECK(means.hits == 1);
  CHECK(means.samples == 2);
  CHECK(film.means(0, 0).samples == 0);
}

TEST_CASE("film: layers that are not kept are zero and change nothing of the others", "[runtime]") {
  PathSample sample = sample_of(1, 4);
  sample.evaluations = 30;
  sample.instructions = 600;
  Film bare(1, 1, {.first_hit = false, .cost = false}), usual(1, 1), full(1, 1, {.first_hit = true, .cost = true});
  for (Film* film : {&bare, &usual, &full}) {
    CHECK(film->add(0, 0, sample));
    sample.evaluations = 10;
    CHECK(film->add(0, 0, sample));
    sample.evaluations = 30;
    CHECK(film->means(0, 0).radiance == glm::dvec3(1, 2, 0));
    CHECK(film->means(0, 0).hits == 2);
  }
  CHECK(bare.means(0, 0).albedo == glm::dvec3(0));
  CHECK(bare.means(0, 0).depth == 0);
  CHECK(usual.means(0, 0).depth == 4);
  CHECK(usual.means(0, 0).evaluations == 0);
  CHECK(full.means(0, 0).evaluations == 20);
  CHECK(full.means(0, 0).instructions == 600);
  CHECK(full.hash() == usual.hash());  // the cost is no part of the picture
  CHECK(bare.hash() != usual.hash());
}

TEST_CASE("film: the order of samples leaves no trace", "[runtime]") {
  Film forwards(1, 1), backwards(1, 1);
  for (int i = 0; i < 1000; ++i) {
    forwards.add(0, 0, sample_of(1.0f / static_cast<float>(i + 3), i));
    backwards.add(0, 0, sample_of(1.0f / static_cast<float>(1002 - i), 999 - i));
  }
  CHECK(forwards.hash() == backwards.hash());
  CHECK(forwards.hash() != Film(1, 1).hash());
}

TEST_CASE("film: a full sum stays full and says so", "[runtime]") {
  Film film(1, 1);
  CHECK(film.add(0, 0, sample_of(1e9f, 0)));
  CHECK_FALSE(film.add(0, 0, sample_of(2e9f, 0)));
  CHECK(film.means(0, 0).radiance.x == Approx(0x1p31 / 2));
  CHECK_FALSE(film.add(0, 0, sample_of(1e30f, 0)));
  CHECK(film.means(0, 0).radiance.x == Approx(0x1p31 / 3));
}

}  // namespace
}  // namespace fathom::runtime
