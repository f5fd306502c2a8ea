// Rays that meet the scene's pieces find what the search in double finds in the whole field, whatever rays travel
// with them.
#include "runtime/march/piece_marcher.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "runtime/march/march.h"
#include "runtime/measure/ray_sets.h"
#include "runtime/path/surface.h"
#include "runtime/render.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"

namespace fathom::piece_marcher_test {

namespace {

using namespace fathom;
using namespace fathom::runtime;

bool is_hit(const RayHit& hit) { return hit.status == RayHit::Status::Hit; }

compiler::CompiledScene compiled(const std::string& text) {
  compiler::CompileOptions options;
  options.pieces = true;
  return test::compiled(text, options);
}

Field field_of(const compiler::CompiledScene& scene, bool native = false) {
  Field field = make_field(scene);
  add_pieces(field, scene, extent_of(scene), std::nullopt, native);
  return field;
}

// An object that has no proved Lipschitz constant: the others are then pieces of their own, however cheap.
const std::string kFractal = "object mandelbulb(iterations = 2, detail = 0.01).scale(0.2).translate([0, 9, 0])\n";

// Objects on a ground: alike ones, which share templates, and turned, cut, blended and divided ones.
std::string scene_text(std::uint64_t seed) {
  test::Random random(seed);
  const auto moved = [&](const std::string& shape) {
    return fmt::format("object ({}).translate([{:.3f}, {:.3f}, {:.3f}])\n", shape, random.uniform(-2, 2),
                       random.uniform(0, 1.5), random.uniform(-2, 2));
  };
  const auto size = [&] { return random.uniform(0.1, 0.6); };
  std::string text =
      "fathom 1\ncamera(position = [4, 3, 5], target = [0, 0.5, 0])\nobject plane([0, 1, 0], offset = 0)\n" +
      kFractal;
  for (int i = 0; i < 6; ++i) text += moved(fmt::format("sphere({:.3f})", size()));
  for (int i = 0; i < 4; ++i)
    text += moved(fmt::format("box([{:.3f}, {:.3f}, 0.1]).rotate([{:.1f}, 9, 0])", size(), size(), 90 * size()));
  text += moved(fmt::format("torus({:.3f}, 0.08)", size()));
  text += moved("box([0.5, 0.5, 0.5]) - sphere(0.6)");
  text += moved("sphere(0.3) +{0.1} box([0.1, 0.5, 0.1])");
  text += moved("sphere(0.3) + sphere(0.3).translate([1, 0, 0]) - box([2, 0.05, 0.3])");
  return text;
}

std::vector<Ray> departures(const compiler::CompiledScene& scene, const Field& field, const std::vector<Ray>& rays,
                            std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> away;
  vm::Workspace workspace;
  for (const RayHit& found : march(field, rays).ray_hits) {
    if (!is_hit(found)) continue;
    const glm::dvec3 unit = glm::normalize(rays[found.id].direction);
    const Hit hit{rays[found.id].origin + found.t * unit, glm::vec3(-unit), found.side, found.width, found.piece};
    SurfacePoint point{};
    find_surfaces(scene, field, {&hit, 1}, {&point, 1}, workspace);
    glm::dvec3 direction = random.direction();
    if (glm::dot(direction, glm::dvec3(point.normal)) < 0) direction = -direction;
    away.push_back(spawn_ray(hit, point, direction, false));
  }
  return away;
}

// Float leaves roots that are known to kTolerance (runtime/march/tiered-inl.h): `tolerance`, relative to t.
int wrong_ones(const Field& field, const std::vector<Ray>& rays, double tolerance = 0x1p-16) {
  const std::vector<RayHit> found = march(field, rays).ray_hits,
                            exact = march(field, rays, {.method = Method::Certified}).ray_hits;
  int wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double slack = tolerance * std::max(1.0, exact[i].t) + static_cast<double>(found[i].width);
    wrong += is_hit(found[i]) != is_hit(exact[i]) || found[i].side != exact[i].side ||
             (is_hit(found[i]) && std::abs(found[i].t - exact[i].t) > slack);
  }
  return wrong;
}

// Rays from next to one solid's face, at up to twice the offset of departing rays on either side of it: in the
// corners of rooms, under things that stand on a floor, at solids that touch or overlap, and along thin shells.
int wrong_at_second_pieces(int count, double tolerance = 0x1p-16) {
  const compiler::CompiledScene scene = compiled(
      "fathom 1\ncamera(position = [4, 3, 5], target = [0, 0.5, 0])\nobject plane([0, 1, 0], offset = 0)\n"
      "object box([1, 2, 0.1]).translate([0, 1.9, -1])\nobject box([0.1, 2, 1]).translate([-1, 2, 0])\n"
      "object sphere(0.4).translate([0, 0.4, 0])\nobject sphere(0.4).translate([0.6, 0.4, 0])\n"
      "object cylinder(0.3, 0.5).translate([0.5, 0.5, -0.6])\n"
      "object box([0.3, 0.3, 0.3]).onion(0.001).translate([0.8, 0.3, 0.8])\n"
      "object sphere(0.5).onion(0.0005).translate([-0.3, 0.4, 0.8])\nobject torus(0.5, 0.1)\n" +
      kFractal);
  const Field field = field_of(scene, true);
  REQUIRE(field.pieces->fields.size() > 8);
  RealScratch scratch;
  std::vector<Ray> rays;
  std::uint64_t instructions = 0;
  constexpr double kOffset = 4e-5;
  for (int i = 0; rays.size() < static_cast<std::size_t>(count); ++i) {
    test::Random random(static_cast<std::uint64_t>(i));
    // A place on a random piece, found along a random line.
    const glm::dvec3 from = 4.0 * random.direction(), along = glm::normalize(random.in_box(1) - from);
    const Field& piece = field.pieces->fields[static_cast<std::size_t>(random.uniform(0, 9))];
    const Ray probe{from, along, 12, 1};
    const RayHit found = march(piece, {&probe, 1}, {.method = Method::Certified}).ray_hits[0];
    if (!is_hit(found)) continue;
    const glm::dvec3 origin = from + (found.t + 2 * kOffset * random.uniform(-1, 1)) * along;
    const double f = field.evaluate(origin, scratch, instructions);
    if (std::abs(f) < 4e-6) continue;  // sides that float cannot tell
    rays.push_back({origin, random.direction(), 20, f < 0 ? -1 : 1});
  }
  return wrong_ones(field, rays, tolerance);
}

// Solids that overlap in chains, share faces, touch in a point, and lie in one another.
int wrong_in_solids(int count, double tolerance = 0x1p-16) {
  std::string text =
      "fathom 1\ncamera(position = [4, 3, 5], target = [0, 0.5, 0])\n"
      "object box([0.5, 0.5, 0.5])\nobject box([0.5, 0.5, 0.5]).translate([1, 0, 0])\n"
      "object box([0.25, 0.5, 0.5]).translate([1.75, 0.5, 0])\nobject sphere(0.5).translate([0, 0, 1])\n"
      "object sphere(0.5).translate([-1, 0, 0])\nobject cylinder(0.2, 2)\nobject cylinder(0.1, 0.3)\n"
      "object box([0.6, 0.6, 0.6]).onion(0.001)\nobject torus(0.7, 0.2).translate([0.3, 0.2, 0])\n" +
      kFractal;
  test::Random shapes(4);
  for (int i = 0; i < 24; ++i) {
    text += fmt::format("object sphere({:.3f}).translate([{:.3f}, {:.3f}, {:.3f}])\n", shapes.uniform(0.1, 0.4),
                        shapes.uniform(-1, 1), shapes.uniform(-1, 1), shapes.uniform(-1, 1));
  }
  const compiler::CompiledScene scene = compiled(text);
  const Field field = field_of(scene, true);
  REQUIRE(field.pieces->fields.size() > 30);
  RealScratch scratch;
  std::vector<Ray> rays;
  for (int i = 0; rays.size() < static_cast<std::size_t>(count); ++i) {
    test::Random random(static_cast<std::uint64_t>(i));
    const glm::dvec3 from = random.in_box(1.5);
    const glm::dvec3 axis(i % 5 == 0, 0, 0);  // some within shared faces
    const glm::dvec3 along = axis.x > 0 ? axis : random.direction();
    if (find_solid(field, from, scratch)) rays.push_back({from, along, 20, -1});
  }
  int chains = 0;
  for (const RayHit& hit : march(field, rays).ray_hits) {
    REQUIRE(is_hit(hit));
    CHECK(hit.piece != kNoPiece);
    chains += hit.piece != *find_solid(field, rays[hit.id].origin, scratch)->piece;
  }
  CHECK(chains > count / 4);
  return wrong_ones(field, rays, tolerance);
}

// A medium is its bodies without those that outrank them: the drink in a glass, a stone in a drink, nested balls.
int wrong_in_media(int count, double tolerance = 0x1p-16) {
  std::string text =
      "fathom 1\ncamera(position = [4, 3, 5], target = [0, 0.5, 0])\nlet glass = transparent(ior = 1.5, priority = "
      "1)\n"
      "let drink = transparent(ior = 1.3)\nlet stone = diffuse(color = 0.5)\n";
  for (int i = 0; i < 25; ++i) {
    const std::string there = fmt::format(".translate([{}, 0, {}])", 1.1 * (i % 5), 1.1 * (i / 5));
    text += fmt::format(
        "object ((cylinder(0.5, 0.6) - cylinder(0.45, 0.6).translate([0, 0.05, 0])) {0} .material(glass))\n"
        "object (cylinder(0.45, 0.4).translate([0, -0.1, 0]) {0} .material(drink))\n"
        "object (sphere(0.1).translate([0.4, {1}, 0]) {0} .material(stone))\n"
        "object (sphere(0.2).translate([0, 0.1, 0.1]) {0} .material(glass))\n",
        there, 0.025 * i);
  }
  const compiler::CompiledScene scene = compiled(text + kFractal);
  REQUIRE(scene.media.size() == 2);
  int wrong = 0;
  for (const compiler::Medium& medium : scene.media) {
    Field field = make_field(medium, extent_of(scene), std::nullopt);
    add_pieces(field, medium, extent_of(scene), std::nullopt, true);
    REQUIRE(field.pieces);
    RealScratch scratch;
    std::vector<Ray> rays;
    for (int i = 0; rays.size() < static_cast<std::size_t>(count); ++i) {
      test::Random random(static_cast<std::uint64_t>(i));
      const glm::dvec3 from = glm::dvec3(2.2, 0, 2.2) + random.in_box(3);
      if (find_solid(field, from, scratch)) rays.push_back({from, random.direction(), 20, -1});
    }
    wrong += wrong_ones(field, rays, tolerance);
  }
  return wrong;
}

}  // namespace

TEST_CASE("pieces: rays end where the search in double of the whole field ends them", "[march][pieces]") {
  int wrong = 0, rays = 0, shared = 0;
  RealScratch scratch;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const compiler::CompiledScene scene = compiled(scene_text(seed));
    const Field field = field_of(scene, seed % 2 == 1);
    for (const PieceTemplate& each : field.pieces->templates) shared += each.per_lane;
    for (RaySet& set : make_ray_sets(scene, field, test::scaled_cases(240), seed)) {
      std::erase_if(set.rays, [&](const Ray& ray) {
        std::uint64_t instructions = 0;
        return field.evaluate(ray.origin, scratch, instructions) < 1e-3;
      });
      for (Ray& ray : set.rays) ray.side = 1;
      wrong += wrong_ones(field, set.rays);
      const std::vector<Ray> away = departures(scene, field, set.rays, seed);
      wrong += wrong_ones(field, away);
      rays += static_cast<int>(set.rays.size() + away.size());
    }
  }
  CAPTURE(rays);
  CHECK(shared >= 12);
  CHECK(wrong == 0);
}

TEST_CASE("pieces: a ray's hit has the same bits alone, among others, and with machine code", "[march][pieces]") {
  const compiler::CompiledScene scene = compiled(scene_text(3));
  const Field field = field_of(scene), native = field_of(scene, true);
  std::vector<Ray> rays = make_ray_sets(scene, field, 300, 1)[0].rays;
  for (Ray& ray : rays) ray.side = 1;
  const std::vector<Ray> away = departures(scene, field, rays, 1);
  rays.insert(rays.end(), away.begin(), away.end());
  const std::vector<RayHit> together = march(field, rays).ray_hits, fast = march(native, rays).ray_hits;
  const auto equal = [](const RayHit& a, const RayHit& b) {
    return a.status == b.status && a.side == b.side && a.evaluations == b.evaluations && a.certified == b.certified &&
           a.width == b.width && a.t == b.t && a.instructions == b.instructions && a.piece == b.piece;
  };
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CHECK(equal(together[i], march(field, {&rays[i], 1}).ray_hits[0]));
    CHECK(equal(together[i], fast[i]));
  }
}

TEST_CASE("pieces: of coincident faces the first piece is hit", "[march][pieces]") {
  const compiler::CompiledScene scene = compiled(
      "fathom 1\nobject box([1, 1, 1]).translate([2, 0, 0])\nobject cylinder(1, 1).rotate([90, 0, 0])\n"
      "object box([3, 0.5, 1]).translate([0, 0.7, 0])\nobject plane([0, 1, 0], offset = -1.5)\n" +
      kFractal);
  const Field field = field_of(scene);
  REQUIRE(field.pieces->fields.size() > 1);
  std::vector<Ray> rays;
  for (int i = 0; i < 400; ++i) {
    test::Random random(static_cast<std::uint64_t>(i));
    rays.push_back({{random.uniform(-0.5, 0.5), random.uniform(0.3, 0.8), 5}, {0, 0, -1}, 100, 1});
  }
  const std::vector<RayHit> hits = march(field, rays).ray_hits;
  for (const RayHit& hit : hits) {
    REQUIRE(is_hit(hit));
    CHECK(hit.t == Approx(4).margin(1e-5));
    CHECK(hit.piece == hits[0].piece);
  }
}

TEST_CASE("pieces: rays that begin at a second piece end where the whole field ends them", "[march][pieces]") {
  CHECK(wrong_at_second_pieces(test::scaled_cases(20000)) == 0);
}
TEST_CASE("pieces: rays within overlapping solids end where the last of them ends", "[march][pieces]") {
  CHECK(wrong_in_solids(test::scaled_cases(8000)) == 0);
}
TEST_CASE("pieces: rays within media end where the whole medium ends", "[march][pieces]") {
  CHECK(wrong_in_media(test::scaled_cases(4000)) == 0);
}
// Float promises a root to an eighth of the band (runtime/march/tiered-inl.h), here 7e-5: rays that graze use it. One
// that grazed the face that a floor and a wall share, at a slope of 2e-5, ended there.
TEST_CASE("pieces: a million rays at second pieces, within solids, and in media", "[.][nightly]") {
  constexpr double kPromised = 0x1p-14;
  CHECK(wrong_at_second_pieces(1'000'000, kPromised) == 0);
  CHECK(wrong_in_solids(1'000'000, kPromised) == 0);
  CHECK(wrong_in_media(500'000, kPromised) == 0);
}

// One flag of the whole scene said that something is estimated: a fractal out of view let rays pass through the walls
// of a formula that jumps.
TEST_CASE("pieces: a formula keeps its proof beside an estimate", "[march][pieces]") {
  const std::string view =
      "fathom 1\ncamera(position = [-4.7, -3.6, -3.7], target = [0, 0, 0])\n"
      "object expression(length(mod(x, 0.7) - 0.2, mod(y, 0.7) - 0.3, mod(z, 0.7) - 0.45) - 0.22, half_size = [1, 1, "
      "1])\n";
  const compiler::CompiledScene scene = compiled(view + "object mandelbulb().translate([30, 0, 0])\n"),
                                alone = compiled(view);
  REQUIRE(scene.pieces.size() == 2);
  const Field field = field_of(scene), formula = make_field(alone);
  const glm::dvec3 aside = alone.origin - scene.origin;
  std::vector<Ray> rays, same;
  for (int i = 0; i < test::scaled_cases(1600); ++i) {
    test::Random random(static_cast<std::uint64_t>(i));
    const glm::dvec3 from = 4.0 * random.direction();
    same.push_back({from, glm::normalize(random.in_box(1) - from), 8, 1});
    rays.push_back(same.back());
    rays.back().origin += aside;
  }
  const std::vector<RayHit> hits = march(field, rays).ray_hits,
                            truth = march(formula, same, {.method = Method::Certified}).ray_hits;
  int wrong = 0, found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    found += is_hit(truth[i]);
    wrong += is_hit(hits[i]) != is_hit(truth[i]) || (is_hit(hits[i]) && std::abs(hits[i].t - truth[i].t) > 2e-5);
  }
  CAPTURE(found);
  CHECK(found > test::scaled_cases(400));
  CHECK(wrong == 0);
}

// Camera rays do not know their side. They followed the whole field, and what they hit was of no piece.
TEST_CASE("pieces: rays that do not know their side meet pieces", "[march][pieces]") {
  const compiler::CompiledScene scene = compiled(scene_text(7));
  const Field field = field_of(scene);
  RealScratch scratch;
  std::uint64_t instructions = 0;
  std::vector<Ray> rays;
  for (int i = 0; i < test::scaled_cases(2000); ++i) {
    test::Random random(static_cast<std::uint64_t>(i / 2));  // two rays of one place
    const glm::dvec3 from = random.in_box(2.5), along = random.direction();
    rays.push_back({from, i % 2 == 0 ? along : -along, 30});
  }
  int pieces = 0, inside = 0;
  for (const RayHit& hit : march(field, rays).ray_hits) {
    const bool solid = field.evaluate(rays[hit.id].origin, scratch, instructions) < 0;
    CHECK(hit.side == (solid ? -1 : 1));
    if (is_hit(hit)) CHECK(hit.piece != kNoPiece);
    pieces += is_hit(hit) && !solid;
    inside += solid;
  }
  CHECK(pieces > test::scaled_cases(300));
  CHECK(inside > test::scaled_cases(300));
  CHECK(wrong_ones(field, rays) == 0);
}

TEST_CASE("pieces: a picture has the same bits for any threads and tiles, and the light of the whole field's",
          "[march][pieces]") {
  const compiler::CompiledScene scene = compiled(scene_text(5) + "background [1, 0.9, 0.8]\n");
  RenderOptions options;
  options.width = 48, options.height = 32, options.spp = 8;
  // Returns the sum of all pixels, then each pixel.
  const auto picture = [&] {
    const RenderResult result = render(scene, options);
    std::vector<double> all(1);
    for (int i = 0; i < options.width.value() * options.height.value(); ++i) {
      all.push_back(result.film.means(i % 48, i / 48).radiance.x);
      all[0] += all.back();
    }
    return all;
  };
  options.threads = 1;
  const std::vector<double> whole = picture();
  options.pieces = true;
  const std::vector<double> one = picture();
  options.threads = 3, options.tile = 7;
  CHECK((one == picture()));
  CHECK(one[0] == Approx(whole[0]).epsilon(1e-4));
}

}  // namespace fathom::piece_marcher_test
