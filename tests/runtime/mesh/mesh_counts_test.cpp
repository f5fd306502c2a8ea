// Bodies and hollows of meshes of sharp, thin, near, touching and tiny parts: right, or a lost part is named in
// place.
//
// A box and its lid 0.35 apart were one body with one hollow at a resolution of 60, without a warning: the gap lies
// in cells that have signs of both kinds, which nothing searched.
#include <algorithm>
#include <string_view>

#include "tests/runtime/mesh/mesh_checks.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::mesh_counts_test {

namespace {

using namespace fathom::runtime;
using fathom::test::meshed;

struct Counted {
  const char* name;
  const char* objects;
  std::size_t bodies, hollows;  // by hand
  glm::dvec3 weak;              // middle of the thin places
  double reach;                 // of the thin places around it, scene units
};

const Counted kScenes[] = {
    // Sharp.
    {"turned box", "object box([1, .5, .5]).rotate([10, 20, 30])", 1, 0, {0, 0, 0}, 0},
    {"star", "object extrude(star(points = 7, radius = 1, inner_radius = 0.3), half_depth = 0.2)", 1, 0, {}, 1.1},
    {"wedge",
     "object extrude(isosceles_triangle(half_width = 0.25, height = 2), half_depth = 0.5).rotate([13, 21, 17])",
     1,
     0,
     {},
     2},
    {"needle", "object cone(.06, 0, 1).rotate([3, 0, 11])", 1, 0, {}, 1.1},
    {"lens", "object sphere(1) & sphere(1).translate([1.9, 0.03, 0.01])", 1, 0, {0.95, 0, 0}, 0.4},
    {"ring", "object sphere(20) - cylinder(radius = 17, half_height = 50).rotate([90, 0, 0])", 1, 0, {}, 21},
    // Thin.
    {"plate", "object box([1, 1, 0.005])", 1, 0, {}, 1.5},
    {"turned plate", "object box([1, 1, 0.01]).rotate([31, 17, 5])", 1, 0, {}, 1.5},
    {"shell", "object sphere(1).onion(0.01)", 1, 1, {}, 1.1},
    {"rooms",
     "object box([1, .6, .6]) - box([.4, .4, .4]).translate([-.41, 0, 0]) - box([.4, .4, .4]).translate([.41, 0, 0])",
     1,
     2,
     {},
     0.6},
    {"dumbbell",
     "object sphere(.4).translate([-1, 0, 0]) + sphere(.4).translate([1, 0.02, 0]) + "
     "capsule(radius = 0.01, half_height = 1).rotate([0, 0, 89.4])",
     1,
     0,
     {},
     0.7},
    {"pinhole",
     "object sphere(1).onion(.1) - infinite_cylinder(.01).rotate([10, 0, 20]).translate([0.3, 0, 0])",
     1,
     0,
     {0.3, 0, 0},
     1.2},
    {"hair", "object box([1, .5, .5]) + cylinder(.004, .5).translate([.1, .6, .05])", 1, 0, {.1, .8, .05}, .4},
    // Near and touching.
    {"balls", "object sphere(1)\nobject sphere(1).translate([2.01, 0.03, 0.02])", 2, 0, {1.005, 0, 0}, 0.4},
    {"lid",
     "object box([20, 10, 15]) - box([18.4, 18.4, 13.4]).translate([0, 10, 0])\n"
     "object box([20, .8, 15]).translate([0, 11.15, 0])",
     2,
     0,
     {0, 10.2, 0},
     25},
    {"turned lid",
     "object ((box([20, 10, 15]) - box([18.4, 18.4, 13.4]).translate([0, 10, 0])) + "
     "box([20, .8, 15]).translate([0, 11.15, 0])).rotate([12, 23, 34])",
     2,
     0,
     {0, 0, 0},
     27},
    {"boxes", "object box([1, .5, .5])\nobject box([1, .3, .5]).translate([0, .804, 0])", 2, 0, {0, .502, 0}, 1.2},
    {"nested", "object sphere(1).onion(.1)\nobject sphere(.88)", 2, 1, {}, 1},
    {"merging balls", "object sphere(1) + sphere(1).translate([1.998, 0.01, 0.03])", 1, 0, {1, 0, 0}, 0.4},
    {"slit", "object box([1, .5, .5]) - box([.003, 1, 1]).rotate([0, 20, 30])", 2, 0, {}, 1},
    {"chain",
     "object torus(.3, .05)\nobject torus(.3, .05).rotate([90, 0, 0]).translate([.49, 0, 0])",
     2,
     0,
     {.245, 0, 0},
     .1},
    // Tiny.
    {"speck",
     "object box([1, .5, .5])\nobject sphere(.01).translate([.313, .56, .117])",
     2,
     0,
     {.313, .56, .117},
     .02},
    {"bubble", "object box([1, .5, .5]) - sphere(.01).translate([.313, .46, .117])", 1, 1, {.313, .46, .117}, .02},
    {"bubbles",
     "object box([1, .5, .5]) - sphere(.03).translate([.1, .1, .1]) - sphere(.02).translate([-.3, .12, .1]) - "
     "sphere(.3).translate([.6, 0, 0])",
     1,
     3,
     {-.1, .11, .1},
     .25},
};

const Counted& scene_named(std::string_view name) {
  return *std::ranges::find_if(kScenes, [&](const Counted& each) { return name == each.name; });
}

void check_counts(double resolution) {
  for (const Counted& each : kScenes) {
    const auto scene = test::compiled(std::string("fathom 1\n") + each.objects + "\n");
    const MeshResult result = meshed(scene, resolution, false);
    const MeshMeasures measures = measure(result.mesh);
    INFO(each.name << " at " << resolution << ": " << measures.bodies << " bodies, " << measures.hollows
                   << " hollows, " << result.lost.size() << " lost");
    const bool right = measures.bodies == each.bodies && measures.hollows == each.hollows;
    const bool named = std::ranges::any_of(result.lost, [&](const LostPart& part) {
      return glm::distance(part.place + scene.origin, each.weak) <= each.reach;
    });
    CHECK((right || named));
  }
}

}  // namespace

TEST_CASE("mesh counts: bodies and hollows are right, or their thin places are named", "[mesh]") { check_counts(24); }
TEST_CASE("mesh counts: the same with cells half as large", "[mesh][heavy]") { check_counts(48); }
TEST_CASE("mesh counts: the same with cells a quarter as large", "[mesh][heavy]") { check_counts(96); }

TEST_CASE("mesh counts: the named tolerance keeps what was lost", "[mesh]") {
  for (const char* name : {"lid", "rooms", "dumbbell", "speck", "bubble", "shell", "pinhole"}) {
    const Counted& each = scene_named(name);
    const auto scene = test::compiled(std::string("fathom 1\n") + each.objects + "\n");
    const MeshResult coarse = meshed(scene, 24, false);
    INFO(name);
    REQUIRE_FALSE(coarse.lost.empty());
    double thinnest = coarse.lost.front().thickness;
    for (const LostPart& part : coarse.lost) thinnest = std::min(thinnest, part.thickness);
    MeshOptions options;
    options.tolerance = options.deviation = thinnest;
    options.simplifies = false;
    options.memory = 8e9;
    options.threads = 2;
    const MeshResult fine = make_mesh(scene, scene.bound, options);
    const MeshMeasures measures = measure(fine.mesh);
    CHECK(fine.lost.empty());
    CHECK(measures.bodies == each.bodies);
    CHECK(measures.hollows == each.hollows);
  }
}

// Widths of a gap of 0.35 were called 0.57, 0.016 and 0.13, and a plate of 0.01 4.1e-05 thin.
TEST_CASE("mesh counts: thicknesses of lost parts are right", "[mesh]") {
  const struct {
    const char* objects;
    double resolution, thickness;
    bool is_gap;
  } cases[] = {{"object box([1, 1, 0.005])", 48, 0.01, false},
               {"object box([1, 1, 0.01])", 24, 0.02, false},
               {"object box([1, 1, 0.01])", 32, 0.02, false},
               {"object box([1, 1, 0.005])", 64, 0.01, false},
               {"object cylinder(radius = 1, half_height = 0.005)", 24, 0.01, false},
               {"object sphere(1).onion(0.01)", 32, 0.02, false},
               {"object box([1, 1, 0.01]).rotate([31, 17, 5])", 32, 0.02, false},
               {scene_named("lid").objects, 60, 0.35, true},
               {scene_named("turned lid").objects, 60, 0.35, true},
               {"object box([1, .5, .5]) - box([.003, 1, 1]).rotate([0, 20, 30])", 40, 0.006, true}};
  for (const auto& each : cases) {
    const auto scene = test::compiled(std::string("fathom 1\n") + each.objects + "\n");
    const MeshResult result = meshed(scene, each.resolution, false);
    const auto part =
        std::ranges::find_if(result.lost, [&](const LostPart& p) { return p.is_gap == each.is_gap && !p.is_torn; });
    INFO(each.objects << " at " << each.resolution);
    REQUIRE(part != result.lost.end());
    CHECK(part->thickness == Approx(each.thickness).epsilon(0.02));
    CHECK_FALSE(part->tapers);
  }
}

// A star's tip broke off without a warning.
TEST_CASE("mesh counts: pieces of a body are islands, and other bodies are not", "[mesh]") {
  const auto star = test::compiled(
      "fathom 1\nobject extrude(star(points = 7, radius = 1, inner_radius = 0.3), half_depth = 0.2)\n");
  const MeshResult torn = meshed(star, 48, false);
  CHECK(measure(torn.mesh).bodies == 2);
  CHECK(torn.islands == 1);
  CHECK(std::ranges::any_of(torn.lost, [](const LostPart& part) { return part.is_torn; }));
  const auto two = test::compiled("fathom 1\nobject sphere(1)\nobject box([1, 1, 1]).translate([2.2, 0, 0])\n");
  CHECK(meshed(two, 48, false).islands == 0);
}

}  // namespace fathom::mesh_counts_test
