// The C++ interface of the library: compiling, evaluating, marching.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <fathom/fathom.hpp>
#include <filesystem>
#include <limits>
#include <random>
#include <thread>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::library_test {

namespace {

const std::string kScenes = std::string(FATHOM_SOURCE_DIR) + "/scenes/";

Scene compiled(std::string_view text) {
  Compiled out = compile(text);
  INFO(out.error.message);
  REQUIRE(out.scene);
  return out.scene;
}

std::vector<Vec3d> random_points(std::size_t count, double reach) {
  std::mt19937_64 random(7);
  std::vector<Vec3d> points(count);
  const auto number = [&] { return reach * (static_cast<double>(random() >> 11) * 0x1p-52 - 1); };
  for (Vec3d& point : points) point = {number(), number(), number()};
  return points;
}

std::vector<Vec3f> to_float(const std::vector<Vec3d>& points) {
  std::vector<Vec3f> out;
  for (const Vec3d& p : points) {
    out.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  }
  return out;
}

// Prints points for `fathom eval --points -`.
template <class T>
std::string lines_of(const std::vector<Vec3<T>>& points) {
  std::string text;
  for (const auto& p : points) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  return text;
}

// One line of `fathom eval`.
struct Line {
  double distance;
  Vec3d gradient;
  std::string object;
};
std::vector<Line> evaluate_by_program(const std::string& scene, const std::string& number,
                                      const std::string& points) {
  const test::Folder folder;
  const test::Result result = folder.run("eval '" + scene + "' --points - --number " + number, points);
  REQUIRE(result.code == 0);
  std::vector<Line> lines;
  std::istringstream in(result.out);
  for (Line line; in >> line.distance >> line.gradient.x >> line.gradient.y >> line.gradient.z;) {
    std::getline(in >> std::ws, line.object);
    lines.push_back(line);
  }
  return lines;
}

// Compares the library with `fathom eval`, bit for bit.
template <class T>
void compare_with_program(const std::string& path, const std::string& number, const std::vector<Vec3<T>>& points) {
  const Compiled loaded = load(path);
  REQUIRE(loaded.scene);
  std::vector<std::string> objects;
  REQUIRE_FALSE(loaded.scene.objects(objects));
  std::vector<T> distance(points.size()), again(points.size());
  std::vector<Vec3<T>> gradient(points.size());
  std::vector<std::uint32_t> object(points.size());
  REQUIRE_FALSE(loaded.scene.distance(Points(std::span(points)), distance));
  REQUIRE_FALSE(loaded.scene.evaluate(Points(std::span(points)), {again, gradient, object}));
  const std::vector<Line> lines = evaluate_by_program(path, number, lines_of(points));
  REQUIRE(lines.size() == points.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Line& line = lines[i];
    const std::string& name = objects[object[i]].empty() ? "-" : objects[object[i]];
    const bool same = static_cast<T>(line.distance) == distance[i] && distance[i] == again[i] &&
                      static_cast<T>(line.gradient.x) == gradient[i].x &&
                      static_cast<T>(line.gradient.y) == gradient[i].y &&
                      static_cast<T>(line.gradient.z) == gradient[i].z && line.object == name;
    wrong += !same;
  }
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("the library evaluates as fathom eval does", "[library]") {
  for (const std::string scene : {"gallery/toy.fathom", "showcase.json", "gear.fathom", "bench/d1000.json"}) {
    CAPTURE(scene);
    const std::string path = kScenes + scene;
    const std::vector<Vec3d> points = random_points(1500, 3);
    compare_with_program(path, "f64", points);
    compare_with_program(path, "f32", to_float(points));
  }
}

// Native code begins after a million points.
TEST_CASE("a library's distances do not depend on layout and number of points", "[library]") {
  const Scene scene = compiled("fathom 1\nobject \"a\" torus(1, 0.3).translate([0.1, 0.2, 0.3])\n");
  const std::vector<Vec3f> points = to_float(random_points(700'001, 2));
  std::vector<float> x, y, z, first(points.size()), second(points.size()), third(points.size());
  for (const Vec3f& p : points) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  REQUIRE_FALSE(scene.distance(Points(std::span(points)), first));
  REQUIRE_FALSE(scene.distance(Points<float>(x.data(), y.data(), z.data(), x.size()), second));
  const Points<float> backwards(&points.back().x, &points.back().y, &points.back().z, points.size(), -3);
  REQUIRE_FALSE(scene.distance(backwards, third));
  CHECK(first == second);
  std::reverse(third.begin(), third.end());
  CHECK(first == third);
}

TEST_CASE("a scene far from zero has its own coordinates", "[library]") {
  const Scene scene = compiled("fathom 1\nobject \"a\" sphere(1).translate([1e6, 0, 0])\n");
  const Vec3d points[] = {{1e6, 0, 0}, {1e6 + 3, 0, 0}};
  double distance[2];
  REQUIRE_FALSE(scene.distance(Points(std::span<const Vec3d>(points)), distance));
  CHECK(distance[0] == -1);
  CHECK(distance[1] == 2);
  const Ray ray{{1e6, 5, 0}, {0, -2, 0}};
  Hit hit;
  REQUIRE_FALSE(scene.march({&ray, 1}, {&hit, 1}));
  CHECK(hit.hit);
  CHECK(hit.position.x == 1e6);
  CHECK(hit.position.y == Approx(1).margin(1e-5));
  const Box box{{1e6 - 1, -1, -1}, {1e6 + 1, 1, 1}};
  Interval interval{0, 0};
  REQUIRE_FALSE(scene.range({&box, 1}, {&interval, 1}));
  CHECK(interval.lo <= -1);
  CHECK(interval.hi >= std::sqrt(3.0) - 1);
  CHECK(scene.bounds().lo.x == Approx(1e6 - 1));
}

TEST_CASE("rays hit the first surface", "[library]") {
  const Scene scene =
      compiled("fathom 1\nobject \"near\" sphere(1)\nobject \"far\" sphere(1).translate([0, 0, -5])\n");
  const Ray rays[] = {{{0, 0, 4}, {0, 0, -1}},
                      {{0, 0, 0}, {0, 0, -1}},
                      {{0, 0, 4}, {0, 1, 0}},
                      {{0, 0, 4}, {0, 0, -1}, 2.5},
                      {{0, 0, -2.5}, {0, 0, -3}}};
  Hit hits[5];
  REQUIRE_FALSE(scene.march(rays, hits));
  CHECK(hits[0].t == Approx(3));
  CHECK(hits[0].normal.z == Approx(1));
  CHECK_FALSE(hits[0].inside);
  CHECK(hits[1].inside);
  CHECK(hits[1].t == Approx(1));
  CHECK_FALSE(hits[2].hit);
  CHECK_FALSE(hits[3].hit);
  std::vector<std::string> objects;
  REQUIRE_FALSE(scene.objects(objects));
  CHECK(objects[hits[0].object] == "near");
  CHECK(objects[hits[4].object] == "far");
}

TEST_CASE("errors of the library say what is wrong", "[library]") {
  const Compiled bad = compile("fathom 1\nobject \"a\" spere(1)\n");
  CHECK_FALSE(bad.scene);
  CHECK(bad.error.kind == Error::Kind::BadScene);
  REQUIRE(bad.diagnostics.size() == 1);
  CHECK(bad.diagnostics[0].error);
  CHECK(bad.diagnostics[0].line == 2);
  CHECK(bad.diagnostics[0].column == 12);
  CHECK(bad.diagnostics[0].end - bad.diagnostics[0].begin == 5);
  CHECK(to_string(bad.diagnostics).find("sphere") != std::string::npos);

  CHECK(load("no such file").error.kind == Error::Kind::File);
  CompileOptions unknown;
  unknown.parameters = {{"radius", 2.0}};
  CHECK(compile("fathom 1\nobject \"a\" sphere(1)\n", unknown).error.kind == Error::Kind::BadScene);
  CHECK(compile("fathom 1\nimport \"a.fathom\" as a\nobject \"a\" sphere(1)\n").error.kind == Error::Kind::BadScene);

  float one[1];
  CHECK(Scene().distance(Points<float>(), {}).kind == Error::Kind::BadArgument);
  const Scene scene = compiled("fathom 1\nobject \"a\" sphere(1)\n");
  CHECK(scene.distance(Points<float>(), one).kind == Error::Kind::BadArgument);
  CHECK_FALSE(scene.distance(Points<float>(), {}));
  const Ray ray{{0, 0, 0}, {0, 0, 0}};
  Hit hit;
  CHECK(scene.march({&ray, 1}, {&hit, 1}).kind == Error::Kind::BadArgument);
}

// A span without a place was read, and a path ended at its zero byte.
TEST_CASE("arguments of the library are checked and named", "[library]") {
  const Scene scene = compiled("fathom 1\nparam r = 1\nobject \"a\" sphere(r)\n");
  const auto names = [](const Error& error, const std::string& what) {
    CAPTURE(error.message, what);
    CHECK(error.kind == Error::Kind::BadArgument);
    CHECK(error.message.find(what) != std::string::npos);
  };
  std::array<double, 2> out{};
  const Points<double> nowhere{nullptr, nullptr, nullptr, 2, 3};
  names(scene.distance(nowhere, out), "points is null");
  std::array<Hit, 2> hits;
  names(scene.march(std::span<const Ray>(static_cast<const Ray*>(nullptr), 2), hits), "rays is null");
  std::array<Interval, 2> intervals{};
  names(scene.range(std::span<const Box>(static_cast<const Box*>(nullptr), 2), intervals), "boxes is null");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array<Box, 2> boxes = {Box{{0, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0}, {1, 1, nan}}};
  names(scene.range(boxes, intervals), "box 1: z from 0 to nan");
  const std::array<Ray, 1> ray = {Ray{{0, 0, 3}, {0, 0, -1}, nan}};
  names(scene.march(ray, std::span(hits).first(1)), "t_max");
  using std::string_literals::operator""s;
  CompileOptions options;
  options.folder = "a\0b"s;
  names(compile("fathom 1\n", options).error, "folder");
  names(load("a\0b"s).error, "path");
  names(compile({static_cast<const char*>(nullptr), 3}).error, "text is null");
  names(scene.render({.width = 4, .height = 4, .samples = 1}).image.write("x\0.png"s), "path");
  CHECK_FALSE(std::filesystem::exists("x"));
  names(unpack("").error, "bytes");
}

TEST_CASE("a packed scene is the scene", "[library]") {
  const Scene scene = compiled("fathom 1\nparam r = 1\nobject \"a\" sphere(r)\n");
  std::string bytes;
  REQUIRE_FALSE(scene.pack(bytes));
  const Compiled again = unpack(bytes);
  REQUIRE(again.scene);
  std::vector<std::string> objects;
  REQUIRE_FALSE(again.scene.objects(objects));
  CHECK(objects == std::vector<std::string>{"a"});
  CHECK(unpack(bytes.substr(0, bytes.size() / 2)).error.kind == Error::Kind::BadScene);
  CHECK(Scene().pack(bytes).kind == Error::Kind::BadArgument);
}

TEST_CASE("points that are not finite have distances that are not finite", "[library]") {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Vec3f> points = {{nan, 0, 0}, {inf, 0, 0}, {0, -inf, 0}, {1, 1, nan}};
  for (const std::string shape : {"sphere(1)", "box([1, 1, 1])", "plane([0, 1, 0])", "torus(1, 0.2)"}) {
    CAPTURE(shape);
    const Scene scene = compiled("fathom 1\nobject \"a\" " + shape + "\n");
    std::vector<float> distance(points.size());
    REQUIRE_FALSE(scene.distance(Points(std::span(points)), distance));
    for (const float d : distance) CHECK_FALSE(std::isfinite(d));
  }
}

TEST_CASE("parameters replace a scene's numbers", "[library]") {
  const std::string text = "fathom 1\nparam r(min = 0.1, max = 5, doc = \"radius\") = 1\nobject \"a\" sphere(r)\n";
  CompileOptions options;
  options.parameters = {{"r", 2.0}};
  const Compiled large = compile(text, options);
  REQUIRE(large.scene);
  const Vec3d origin{0, 0, 0};
  double distance = 0;
  REQUIRE_FALSE(large.scene.distance(Points(std::span(&origin, 1)), {&distance, 1}));
  CHECK(distance == -2);
  std::vector<Parameter> parameters;
  REQUIRE_FALSE(large.scene.parameters(parameters));
  REQUIRE(parameters.size() == 1);
  CHECK(parameters[0].name == "r");
  CHECK(parameters[0].value == 2);
  CHECK(parameters[0].max == 5);
}

TEST_CASE("a compiled file is the scene that it was made of", "[library]") {
  const test::Folder folder;
  REQUIRE(folder.run("compile '" + kScenes + "gallery/toy.fathom' -o toy.fbc").code == 0);
  const Compiled text = load(kScenes + "gallery/toy.fathom"), file = load((folder.path() / "toy.fbc").string());
  REQUIRE(text.scene);
  INFO(file.error.message);
  REQUIRE(file.scene);
  const std::vector<Vec3d> points = random_points(1000, 3);
  std::vector<double> a(points.size()), b(points.size());
  REQUIRE_FALSE(text.scene.distance(Points(std::span(points)), a));
  REQUIRE_FALSE(file.scene.distance(Points(std::span(points)), b));
  CHECK(a == b);
}

// Data races show under ThreadSanitizer.
TEST_CASE("a hundred threads use one scene", "[library]") {
  const Scene scene = compiled("fathom 1\nobject \"a\" box([1, 0.5, 0.7]).round(0.1)\nobject \"b\" sphere(1)\n");
  const std::vector<Vec3f> points = to_float(random_points(20'000, 2));
  std::vector<float> expected(points.size());
  REQUIRE_FALSE(scene.distance(Points(std::span(points)), expected));
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 100; ++i) {
    threads.emplace_back([&, i] {
      std::vector<float> distance(points.size());
      const Scene copy = scene;
      if (copy.distance(Points(std::span(points)), distance) || distance != expected) ++wrong;
      const Ray ray{{0, 0, 5}, {0, 0.001 * i, -1}};
      Hit hit;
      if (copy.march({&ray, 1}, {&hit, 1}) || !hit.hit) ++wrong;
      RenderOptions small;
      small.width = small.height = 4;
      small.samples = small.threads = 1;
      if (i % 10 == 0 && copy.render(small).error) ++wrong;
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

}  // namespace fathom::library_test
