// Textures in the coordinates of the node that has the material: a transformed body keeps its grain.
#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "runtime/field/field.h"
#include "runtime/image/image.h"
#include "runtime/material/material.h"
#include "runtime/path/surface.h"
#include "runtime/render.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::runtime::object_space_test {
namespace {

using compiler::CompiledScene;
using glm::dvec3;
using glm::vec3;

const std::string kGrain = R"~(["0.5 + 0.25*sin(3*x)", "0.5 + 0.25*sin(5*y)", "0.5 + 0.25*sin(7*z)"])~";
const std::string kOak = R"("oak": {"type": "diffuse", "space": "object", "color": )" + kGrain + "}";

CompiledScene scene_of(const std::string& objects, const std::string& materials = kOak) {
  return test::compiled(R"({"version": 1, "materials": {)" + materials + R"(}, "objects": [)" + objects + "]}");
}

// Returns the scene's colour at a point of its surface.
vec3 color_at(const CompiledScene& scene, dvec3 p) {
  RealScratch scratch;
  const Field field = make_field(scene);
  const vm::SurfacePlace found = find_object_point(scene, field, p - scene.origin, scratch);
  return Materials(scene)
      .at(scene.surfaces[found.surface].material, p - scene.origin, found.place, scratch.workspace)
      .base_color;
}

// Checks the colour at p against kGrain's formula at q, in the object's coordinates.
void check_grain(const CompiledScene& scene, dvec3 p, dvec3 q) {
  INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
  const vec3 color = color_at(scene, p);
  CHECK(static_cast<double>(color.x) == Approx(0.5 + 0.25 * std::sin(3 * q.x)).epsilon(1e-6));
  CHECK(static_cast<double>(color.y) == Approx(0.5 + 0.25 * std::sin(5 * q.y)).epsilon(1e-6));
  CHECK(static_cast<double>(color.z) == Approx(0.5 + 0.25 * std::sin(7 * q.z)).epsilon(1e-6));
}

const std::string kBox = R"("type": "box", "half_size": [0.5, 0.4, 0.3])";
const dvec3 kOnBox(0.5, 0.1, 0.2);
// The box in one record scaled by 2, rotated by 90 degrees about y (x to -z, z to x) and translated.
const std::string kPlaced = R"("scale": 2, "rotate": [0, 90, 0], "translate": [3, 1, -2])";
dvec3 placed(dvec3 q) { return dvec3(2 * q.z, 2 * q.y, -2 * q.x) + dvec3(3, 1, -2); }

TEST_CASE("object space: a body takes its grain along wherever the material stands", "[march][object_space]") {
  check_grain(scene_of("{" + kBox + R"(, "material": "oak"})"), kOnBox, kOnBox);
  const std::string within = "{" + kBox + R"(, "material": "oak"})", bare = "{" + kBox + "}";
  const auto group = [](const std::string& of, const std::string& more) {
    return R"({"type": "union", "of": [)" + of + "]" + more + "}";
  };
  const std::string oak = R"(, "material": "oak")", move = ", " + kPlaced;
  for (const std::string& object :
       {"{" + kBox + oak + move + "}", group(within, move), group(bare, oak + move),
        group("{" + kBox + move + "}", oak), group(group("{" + kBox + move + "}", ""), oak)}) {
    INFO(object);
    check_grain(scene_of(object), placed(kOnBox), kOnBox);
  }
  // Two transforms, with the material before, between and after them.
  const std::string twice = R"(, "translate": [0, 5, 0])";
  for (const std::string& object :
       {group("{" + kBox + oak + move + "}", twice), group("{" + kBox + move + "}", oak + twice),
        group(group("{" + kBox + move + "}", twice), oak)}) {
    INFO(object);
    check_grain(scene_of(object), placed(kOnBox) + dvec3(0, 5, 0), kOnBox);
  }
}

TEST_CASE("object space: texts mean the same, painted before a move or after", "[march][object_space]") {
  const std::string head = R"~(fathom 1
let oak = diffuse(space = "object", color = [0.5 + 0.25*sin(3*x), 0.5 + 0.25*sin(5*y), 0.5 + 0.25*sin(7*z)])
object box([0.5, 0.4, 0.3]))~";
  for (const char* chain :
       {".scale(2).rotate([0, 90, 0]).translate([3, 1, -2]).material(oak)",
        ".material(oak).scale(2).rotate([0, 90, 0]).translate([3, 1, -2])",
        ".scale(2).material(oak).rotate([0, 90, 0]).translate([3, 1, -2])",
        ".scale(2).translate([1, 0.5, 1.5]).rotate([0, 90, 0]).material(oak).translate([1.5, 0.5, -1])"}) {
    INFO(chain);
    check_grain(test::compiled(head + chain), placed(kOnBox), kOnBox);
  }
}

TEST_CASE("object space: uses and copies have the same grain, each its own", "[march][object_space]") {
  const auto with_nodes = [](const std::string& node, const std::string& objects) {
    return test::compiled(R"({"version": 1, "materials": {)" + kOak + R"(}, "nodes": {"block": )" + node +
                          R"(}, "objects": [)" + objects + "]}");
  };
  const std::string use = R"({"use": "block", )" + kPlaced + R"(}, {"use": "block", "translate": [-4, 0, 0]})";
  const CompiledScene inside = with_nodes("{" + kBox + R"(, "material": "oak"})", use);
  check_grain(inside, placed(kOnBox), kOnBox);
  check_grain(inside, kOnBox + dvec3(-4, 0, 0), kOnBox);
  const CompiledScene outside = with_nodes("{" + kBox + R"(, "translate": [0, 7, 0]})",
                                           R"({"use": "block", "material": "oak", )" + kPlaced + "}");
  check_grain(outside, placed(kOnBox + dvec3(0, 7, 0)), kOnBox);
  const CompiledScene row =
      scene_of(R"({"type": "repetition", "period": [2, 0, 0], "count": [5, 1, 1], "translate": [0, 1, 0],
      "of": {)" +
               kBox + R"(, "material": "oak"}})");
  for (const double copy : {-2, 0, 1, 2}) check_grain(row, kOnBox + dvec3(2 * copy, 1, 0), kOnBox);
}

TEST_CASE("object space: what stands below the material is not undone, but for moves", "[march][object_space]") {
  const std::string row = R"({"type": "repetition", "period": [2, 0, 0], "count": [5, 1, 1], "of": {)" + kBox + R"(},
      "material": "oak", "translate": [0, 1, 0]})";
  check_grain(scene_of(row), kOnBox + dvec3(4, 1, 0), kOnBox + dvec3(4, 0, 0));
  const std::string pair = R"({"type": "union", "material": "oak", "translate": [0, 1, 0], "of": [{)" + kBox +
                           R"(}, {)" + kBox + R"(, "translate": [3, 0, 0]}]})";
  check_grain(scene_of(pair), kOnBox + dvec3(3, 1, 0), kOnBox + dvec3(3, 0, 0));
}

TEST_CASE("object space: mirrors and twists above the material are undone", "[march][object_space]") {
  const std::string block = "{" + kBox + R"(, "material": "oak", "translate": [2, 0, 0]})";
  const CompiledScene mirrored = scene_of(R"({"type": "mirror", "normal": [1, 0, 0], "of": )" + block + "}");
  check_grain(mirrored, kOnBox + dvec3(2, 0, 0), kOnBox);
  check_grain(mirrored, dvec3(-2.5, 0.1, 0.2), kOnBox);
  // A quarter turn per unit of height: 36 degrees at y = 0.4, the top.
  const CompiledScene twisted =
      scene_of(R"({"type": "twist", "turn": 90, "of": {)" + kBox + R"(, "material": "oak"}})");
  const dvec3 q(0.2, 0.4, 0.1);
  const double angle = 0.4 * std::acos(0.0);
  const double s = std::sin(angle), c = std::cos(angle);
  const vec3 one = color_at(twisted, {c * q.x - s * q.z, q.y, s * q.x + c * q.z});
  const vec3 other = color_at(twisted, {c * q.x + s * q.z, q.y, -s * q.x + c * q.z});
  const auto off = [&](vec3 color) {
    return std::abs(static_cast<double>(color.x) - 0.5 - 0.25 * std::sin(3 * q.x));
  };
  CHECK(std::min(off(one), off(other)) < 1e-6);
  CHECK(std::max(off(one), off(other)) > 1e-2);
}

TEST_CASE("object space: a pattern has its own space, and what it mixes has that, too", "[march][object_space]") {
  const auto color = [](const std::string& material) {
    const std::string text = R"("m": {"type": "diffuse", )" + material + "}";
    return color_at(scene_of("{" + kBox + R"(, "material": "m", "translate": [1, 0, 0]})", text), {1.5, 0.1, 0.2});
  };
  const std::string gradient = R"("color": {"pattern": "gradient", "to": [2, 0, 0], "a": 0, "b": 1)";
  CHECK(color(gradient + "}") == vec3(0.75f));
  CHECK(color(gradient + R"(, "space": "object"})") == vec3(0.25f));
  CHECK(color(R"("space": "object", )" + gradient + "}") == vec3(0.25f));
  CHECK(color(R"("space": "object", )" + gradient + R"(, "space": "world"})") == vec3(0.75f));
  const std::string nested = R"("color": {"pattern": "gradient", "to": [2, 0, 0], "a": 0, "b": "x/2")";
  CHECK(color(nested + R"(, "space": "object"})") == vec3(0.25f * 0.25f));
  CHECK(color(nested + "}") == vec3(0.75f * 0.75f));
}

TEST_CASE("object space: far from zero the grain is the node's as well", "[march][object_space]") {
  const CompiledScene moved = scene_of("{" + kBox + R"(, "material": "oak", "translate": [100000, 3, 0]})");
  CHECK(moved.origin != dvec3(0));
  check_grain(moved, kOnBox + dvec3(100000, 3, 0), kOnBox);
  // The union has no transform, so its coordinates are the scene's.
  const CompiledScene pair =
      scene_of(R"({"type": "union", "material": "oak", "of": [{)" + kBox + R"(, "translate": [100000, 3, 0]}, {)" +
               kBox + R"(, "translate": [100002, 3, 0]}]})");
  CHECK(pair.origin != dvec3(0));
  check_grain(pair, kOnBox + dvec3(100000, 3, 0), kOnBox + dvec3(100000, 3, 0));
}

TEST_CASE("object space: a scene without it has the programs it had", "[march][object_space]") {
  const std::string object = "{" + kBox + R"(, "material": "m", "translate": [1, 2, 3]})";
  const CompiledScene world = scene_of(object, R"("m": {"type": "diffuse", "color": ")" + std::string("x") + "\"}");
  CHECK(world.surface.program().words == world.distance.program().words);
  const CompiledScene own = scene_of(object, R"("m": {"type": "diffuse", "space": "object", "color": "x"})");
  CHECK(own.distance.program().words == world.distance.program().words);
  CHECK(own.surface.program().words != world.surface.program().words);
}

// Balls of a lamp and of noise, one alone and two in a blend. `ball`, `left`, `right` and `lamp` are appended to the
// materials and place their patterns.
struct Spaces {
  const char *ball, *left, *right, *lamp;
};

CompiledScene room(const Spaces& spaces, const std::string& right = "right") {
  const std::string noise =
      R"({"type": "diffuse", "color": {"pattern": "noise", "a": [0.9, 0.4, 0.1], "b": [0.1, 0.2, 0.9], "scale": 0.3)";
  const auto of = [&](const char* space) { return noise + space + "}}"; };
  return test::compiled(R"({"version": 1, "materials": {"white": {"type": "diffuse"}, "ball": )" + of(spaces.ball) +
                        R"(, "left": )" + of(spaces.left) + R"(, "right": )" + of(spaces.right) +
                        R"(, "lamp": {"type": "emissive", "emission":
      {"pattern": "gradient", "from": [-0.4, 0, 0], "to": [0.4, 0, 0], "a": [9, 1, 1], "b": [1, 1, 9])" +
                        spaces.lamp + R"(}}}, "camera": {"position": [0, 1.5, 5], "target": [0, 0.6, 0]}, "objects": [
      {"type": "plane", "normal": [0, 1, 0], "material": "white"},
      {"type": "sphere", "radius": 0.6, "translate": [-1.2, 0.6, 0], "material": "ball"},
      {"type": "smooth_union", "k": 0.5, "of": [
        {"type": "sphere", "radius": 0.5, "translate": [0.5, 0.5, 0], "material": "left"},
        {"type": "sphere", "radius": 0.5, "translate": [1.25, 0.5, 0], "material": ")" +
                        right + R"("}]},
      {"type": "sphere", "radius": 0.4, "translate": [1, 1.75, 0.5], "material": "lamp"}]})");
}

const Spaces kOwn = {R"(, "space": "object")", R"(, "space": "object")", R"(, "space": "object")",
                     R"(, "space": "object")"};
const Spaces kFusedTranslate = {R"(, "translate": [-1.2, 0.6, 0])", R"(, "translate": [0.5, 0.5, 0])",
                                R"(, "translate": [1.25, 0.5, 0])", R"(, "translate": [1, 1.75, 0.5])"};
const Spaces kStill = {"", "", "", ""};

// Returns the largest difference between the albedos of two images.
double apart(const Film& a, const Film& b) {
  double most = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) most = std::max(most, glm::length(a.means(x, y).albedo - b.means(x, y).albedo));
  }
  return most;
}

// The reference moves the patterns by hand, with one material per body.
TEST_CASE("object space: hits, blends and lamps show the patterns of the moved bodies",
          "[march][object_space][render]") {
  RenderOptions options;
  options.width = 48, options.height = 32, options.spp = 4, options.threads = 2;
  const Film moved = render(room(kFusedTranslate), options).film, still = render(room(kStill), options).film;
  CHECK(apart(moved, still) > 0.1);
  // With "left", both balls share a material, but each has its own coordinates.
  for (const char* right : {"right", "left"}) {
    const CompiledScene own = room(kOwn, right);
    CHECK(own.area_lights.size() == 1);
    CHECK(apart(moved, render(own, options).film) < 1e-5);
  }
}

TEST_CASE("object space: light that is sampled and light that is hit are the same",
          "[march][object_space][render][released]") {
  RenderOptions options;
  options.width = 24, options.height = 16, options.spp = 4096, options.threads = 2, options.rr_depth = 2;
  const CompiledScene own = room(kOwn);
  const auto mean = [&](LightSampling way) {
    options.light_sampling = way;
    const Film film = render(own, options).film;
    dvec3 sum(0);
    for (int y = 8; y < 16; ++y) {
      for (int x = 0; x < 24; ++x) sum += film.means(x, y).radiance / (24.0 * 8.0);
    }
    return sum;
  };
  const dvec3 lights = mean(LightSampling::Nee), hits = mean(LightSampling::Bsdf);
  for (int i = 0; i < 3; ++i) CHECK(lights[i] == Approx(hits[i]).epsilon(0.02));
}

// Many blocks, so that regions are built. Every third block is blended with a ball.
std::string blocks(int count) {
  std::string objects;
  for (int i = 0; i < count; ++i) {
    const double x = 0.35 * (i % 20) - 3.5, z = -0.35 * (i / 20);
    const std::string block = fmt::format(R"({{"type": "box", "half_size": [0.1, 0.15, 0.1], "rotate": [0, {}, 0],
        "translate": [{}, 0.1, {}], "material": "oak"}})",
                                          17 * i, x, z);
    objects += i == 0 ? "" : ",";
    objects += i % 3 != 0 ? block
                          : R"({"type": "smooth_union", "k": 0.1, "of": [)" + block +
                                fmt::format(R"(, {{"type": "sphere", "radius": 0.1, "material": "oak",
        "translate": [{}, 0.3, {}]}}]}})",
                                            x, z);
  }
  return objects;
}

TEST_CASE("object space: regions, threads and tiles leave no trace", "[march][object_space][render][threads]") {
  const CompiledScene scene =
      test::compiled(R"({"version": 1, "camera": {"position": [0, 3, 3], "target": [0, 0, -2]},
      "background": [1, 1, 1], "materials": {)" +
                     kOak + R"(}, "objects": [)" + blocks(300) + "]}");
  CHECK(scene.surfaces[0].placed);
  RenderOptions options;
  options.width = 192, options.height = 128, options.spp = 2, options.threads = 1;
  options.crop = {88, 60, 104, 68};
  options.regions = false;
  const std::uint64_t expected = render(scene, options).film.hash();
  options.regions = true;
  const RenderResult cut = render(scene, options);
  CHECK(cut.stats.region_bytes > 0);
  CHECK(cut.film.hash() == expected);
  options.threads = 3, options.tile = 5;
  CHECK(render(scene, options).film.hash() == expected);
}

}  // namespace
}  // namespace fathom::runtime::object_space_test
