// Measures how much regions (runtime/field/regions.h) save: the marcher with regions against the same marcher
// evaluating the whole program for every sample, with all lanes full. The scenes are scattered objects, and objects
// that are all blended into one.
//
//     build/release/bench_culling
#include <cmath>
#include <cstdio>
#include <optional>

#include "bench/clouds.h"
#include "bench/comparison.h"
#include "bench/many_objects.h"
#include "runtime/march/march.h"
#include "runtime/measure/ray_sets.h"

namespace {

using namespace fathom;
using namespace fathom::bench;

// Scene D as a scene file, except for its margin.
std::string scattered(int count) {
  const ManyObjects objects = make_many_objects(count);
  std::string text;
  for (const auto& s : objects.spheres) {
    text +=
        fmt::format("{{\"type\": \"sphere\", \"radius\": {}, \"translate\": [{}, {}, {}]}},\n", s.r, s.x, s.y, s.z);
  }
  for (const auto& b : objects.boxes) {
    text += fmt::format("{{\"type\": \"box\", \"half_size\": [{}, {}, {}], \"translate\": [{}, {}, {}]}},\n", b.hx,
                        b.hy, b.hz, b.x, b.y, b.z);
  }
  text.resize(text.size() - 2);
  return "{\"type\": \"union\", \"of\": [" + text + "]}";
}

// Spheres, boxes and tori in a row, each blended with the one before: as many as in scene B, or more and smaller
// ones.
std::string blended(int count) {
  std::uint32_t state = 12345;
  const auto u = [&] {
    state = state * 1664525u + 1013904223u;
    return ((state >> 8) % 1000) / 1000.0;
  };
  const double size = std::cbrt(30.0 / count);
  std::string text;
  for (int i = 0; i < count; ++i) {
    const double x = -2 + 4 * u(), y = 0.3 + 1.6 * u(), z = -2 + 4 * u();
    const double a = size * (0.25 + 0.35 * u()), b = size * (0.25 + 0.35 * u()), c = size * (0.25 + 0.35 * u());
    const std::string shapes[] = {
        fmt::format("\"sphere\", \"radius\": {:.5f}", a),
        fmt::format("\"box\", \"half_size\": [{:.5f}, {:.5f}, {:.5f}]", a, b, c),
        fmt::format("\"torus\", \"major_radius\": {:.5f}, \"minor_radius\": {:.5f}", a + 0.15 * size, 0.4 * b)};
    text += fmt::format("{}{{\"type\": {}, \"translate\": [{:.4f}, {:.4f}, {:.4f}]}}", i > 0 ? ",\n" : "",
                        shapes[i % 3], x, y, z);
  }
  return fmt::format("{{\"type\": \"smooth_union\", \"k\": {:.4f}, \"of\": [{}]}}", 0.2 * size, text);
}

// A scene with and without regions, and the rays to trace. The whole program traces only every `share`-th ray: enough
// to fill its lanes, in seconds rather than minutes.
class Scene {
 public:
  Scene(const std::string& object, const std::string& camera, std::size_t share)
      : scene_(compile(object, camera)), whole_(runtime::make_field(scene_)), cut_(whole_) {
    runtime::add_regions(cut_, scene_, {});
    sets_ = runtime::make_ray_sets(scene_, cut_, kRays, 1);
    for (const runtime::RaySet& set : sets_) {
      std::vector<runtime::Ray>& some = shares_.emplace_back();
      for (std::size_t i = 0; i < set.rays.size(); i += share) some.push_back(set.rays[i]);
    }
  }

  void compare(const std::string& name, double min_gain, int rounds) const {
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const runtime::RaySet& set = sets_[i];
      if (set.ray_class == "grazing") continue;
      const auto rays = static_cast<double>(set.rays.size()), some = static_cast<double>(shares_[i].size());
      add({.name = name + ", " + set.ray_class,
           .unit = "ns a ray",
           .per_unit = 1e9 / rays,
           .most = 1 / min_gain,
           .rounds = rounds,
           .ours = [&] { march_each(cut_, set.rays); },
           .theirs = [this, i] { march_each(whole_, shares_[i]); },
           .note = [this, &set] { return describe(set); },
           .theirs_times = rays / some});
    }
  }

 private:
  static compiler::CompiledScene compile(const std::string& object, const std::string& camera) {
    const compiler::Source source("generated",
                                  "{\"version\": 1, \"camera\": {" + camera + "}, \"objects\": [" + object + "]}");
    compiler::Diagnostics diagnostics;
    auto scene = compiler::compile(source, diagnostics);
    if (!scene) {
      fmt::print(stderr, "{}", diagnostics.print(source, compiler::ErrorFormat::Text));
      std::exit(1);
    }
    return *std::move(scene);
  }

  static void march_each(const runtime::Field& field, std::span<const runtime::Ray> rays) {
    std::size_t hits = 0;
    runtime::march_each(field, rays, {},
                        [&](const runtime::RayHit& a) { hits += a.status == runtime::RayHit::Status::Hit; });
    benchmark::DoNotOptimize(hits);
  }

  std::string describe(const runtime::RaySet& set) const {
    const runtime::Regions::Summary& summary = cut_.regions->summary();
    const auto a = runtime::march(cut_, set.rays).counters;
    return fmt::format(
        "{:.1f} evaluations of {:.1f} instructions a ray; built in {:.3f} s on one thread, {:.1f} MB, {} far cells, "
        "{} programs of {} skeletons",
        static_cast<double>(a.evaluations) / static_cast<double>(a.rays),
        static_cast<double>(a.instructions) / static_cast<double>(a.evaluations), summary.seconds,
        static_cast<double>(summary.bytes) * 1e-6, summary.far, summary.programs, summary.program_templates);
  }

  compiler::CompiledScene scene_;
  runtime::Field whole_, cut_;
  static constexpr std::size_t kRays = 60000;
  std::vector<runtime::RaySet> sets_;
  std::vector<std::vector<runtime::Ray>> shares_;  // [set]
};

}  // namespace

int main(int argc, char** argv) {
  const std::string cube = "\"position\": [2, 1.5, 2.4], \"target\": [0.5, 0.5, 0.5], \"fov_y\": 35";
  const std::string heap = "\"position\": [4.2, 3.2, 5], \"target\": [0, 1, 0], \"fov_y\": 40";
  const Scene d1000(scattered(1000), cube, 3), d10000(scattered(10000), cube, 15),
      d100000(scattered(100000), cube, 30), b300(blended(300), heap, 3), b1000(blended(1000), heap, 10);
  d1000.compare("1000 scattered", 15, 11);
  d10000.compare("10000 scattered", 80, 5);
  d100000.compare("100000 scattered", 500, 3);
  b300.compare("300 blended", 4, 11);
  b1000.compare("1000 blended", 8, 5);
  return run_benches(argc, argv, "regions against the whole program, ns a ray");
}
