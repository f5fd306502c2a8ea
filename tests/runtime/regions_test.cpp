// Regions: min(f, limit) with the whole program's bits, a bound far off, and the same picture with and without them.
#include "runtime/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "compiler/bounds.h"
#include "compiler/fuse.h"
#include "runtime/field.h"
#include "runtime/march.h"
#include "runtime/render.h"
#include "runtime/surface.h"
#include "tests/support/compiled.h"
#include "tests/support/effort.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random_scene.h"
#include "vm/evaluate.h"

namespace {

using namespace fathom;
using namespace fathom::runtime;
using test::Random;

std::string place(Random& random, double half) {
  return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", random.uniform(-half, half), random.uniform(-half, half),
                     random.uniform(-half, half));
}

// A scene of many shapes, of four materials by turns; `blend` makes groups of three that are blended; on a ground
// plane when asked for.
std::string many(int count, bool blend, bool ground, bool materials) {
  Random random(7);
  std::string objects;
  for (int i = 0; i < count; ++i) {
    const double r = random.uniform(0.02, 0.06);
    static const char* kShapes[] = {"\"sphere\", \"radius\": {0:.4f}",
                                    "\"box\", \"half_size\": [{0:.4f}, {1:.4f}, {0:.4f}]",
                                    "\"torus\", \"major_radius\": {1:.4f}, \"minor_radius\": {2:.4f}",
                                    "\"cylinder\", \"radius\": {0:.4f}, \"half_height\": {1:.4f}"};
    const auto shape = [&](int kind) {
      return "{\"type\": " + fmt::format(fmt::runtime(kShapes[kind]), r, 1.5 * r, 0.5 * r) +
             ", \"translate\": " + place(random, 1) + (random.chance(0.3) ? ", \"rotate\": [10, 40, 70]" : "") + "}";
    };
    std::string object = shape(i % 4);
    if (blend && i % 5 == 0) {
      object = fmt::format("{{\"type\": \"smooth_union\", \"k\": 0.05, \"of\": [{}, {}, {}]}}", shape(0), shape(1),
                           shape(2));
    }
    if (materials) object.insert(1, fmt::format("\"material\": \"m{}\", ", i % 4));
    objects += (i > 0 ? ",\n" : "") + object;
  }
  if (ground) objects += ",\n{\"type\": \"plane\", \"normal\": [0, 1, 0], \"offset\": -1.2}";
  const std::string palette =
      "\"materials\": {\"m0\": {\"type\": \"diffuse\", \"color\": [0.8, 0.2, 0.2]}, \"m1\": {\"type\": \"specular\", "
      "\"color\": [0.7, 0.7, 0.2]}, \"m2\": {\"type\": \"diffuse\", \"color\": [0.2, 0.8, 0.2]}, \"m3\": {\"type\": "
      "\"transparent\"}}, ";
  return "{\"version\": 1, \"camera\": {\"position\": [2.2, 1.6, 2.6], \"target\": [0, 0, 0]}, " + palette +
         "\"background\": {\"bottom\": [0.3, 0.3, 0.3], \"top\": [1, 1, 1]}, \"objects\": [" + objects + "]}";
}

struct Sample {
  std::vector<float> x, y, z;
  vm::Points points() const { return {x.data(), y.data(), z.data()}; }
};

Sample sample(std::size_t count, double half, std::uint64_t seed) {
  Random random(seed);
  Sample points;
  for (std::size_t i = 0; i < count; ++i) {
    points.x.push_back(static_cast<float>(random.uniform(-half, half)));
    points.y.push_back(static_cast<float>(random.uniform(-half, half)));
    points.z.push_back(static_cast<float>(random.uniform(-half, half)));
  }
  return points;
}

Field with_regions(const compiler::CompiledScene& scene, RegionOptions options = {}) {
  Field field = make_field(scene);
  add_regions(field, scene, options);
  REQUIRE(field.regions);
  return field;
}

}  // namespace

TEST_CASE("regions: the field cut off at the leaf's limit, bit for bit", "[regions]") {
  for (const bool blend : {false, true}) {
    for (const bool ground : {false, true}) {
      const compiler::CompiledScene scene = tests::compiled(many(400, blend, ground, true));
      const Field field = with_regions(scene);
      vm::Workspace workspace;
      RegionScratch scratch;
      RealScratch real_scratch;
      std::size_t equal = 0, limited = 0, far = 0;
      for (int seed = 0; seed < test::few(24); ++seed) {
        // Within, about, and far outside.
        const Sample at = sample(kMostPoints, seed % 3 == 0 ? 1.1 : seed % 3 == 1 ? 3 : 40, seed);
        std::vector<float> whole(kMostPoints), cut(kMostPoints);
        vm::evaluate_distance(scene.surface, at.points(), kMostPoints, whole.data(), workspace);
        field.regions->evaluate(at.points(), kMostPoints, cut.data(), scratch, workspace);
        for (std::size_t i = 0; i < kMostPoints; ++i) {
          const Regions::Region region = field.regions->region({at.x[i], at.y[i], at.z[i]});
          const bool is_far = region.part.words.empty();
          const float limit = static_cast<float>(region.limit);
          const auto place = [&] {
            return fmt::format("{} {} {}: {} of {}", at.x[i], at.y[i], at.z[i], cut[i], whole[i]);
          };
          if (is_far ? !(cut[i] <= whole[i] && cut[i] > 0) : cut[i] != std::min(whole[i], limit)) {
            FAIL_CHECK("neither the field nor its limit at " << place());
          }
          equal += cut[i] == whole[i], limited += cut[i] < whole[i], far += is_far;
          std::uint64_t instructions = 0;
          const double exact = field.regions->evaluate({at.x[i], at.y[i], at.z[i]}, real_scratch, instructions);
          if (!(std::abs(exact - static_cast<double>(cut[i])) < 1e-5 * std::max(1.0f, std::abs(cut[i])))) {
            FAIL_CHECK("in double " << exact << " at " << place());
          }
        }
      }
      CHECK(equal > static_cast<std::size_t>(test::few(1000)));
      CHECK(limited > static_cast<std::size_t>(test::few(1000)));
      CHECK(far > static_cast<std::size_t>(test::few(100)));
    }
  }
}

TEST_CASE("regions: random scenes of every kind of node are cut without a wrong value", "[regions]") {
  std::size_t built = 0, wrong = 0, cut = 0;
  for (int seed = 0; seed < test::few(60); ++seed) {
    Random random(seed);
    test::GraphOptions options;
    options.depth = 5;
    const compiler::Scene scene = test::random_scene(random, options);
    const compiler::Knowledge known = compiler::analyse(scene.graph)[scene.root];
    const auto fused = vm::verify(compiler::fuse(test::plain_lowering(scene).program()));
    const auto& program = std::get<vm::VerifiedProgram>(fused);
    const bool bounded = known.box.finite() && !known.box.empty();
    const compiler::Box box = bounded ? known.box : compiler::Box::centred(glm::dvec3(3));
    if (!(known.lipschitz > 0) || box.hi.x - box.lo.x > 1e3) continue;
    const auto regions = Regions::build(program, box, known.lipschitz, {.always = true, .room = bounded ? 0 : 3});
    if (!regions) continue;
    ++built;
    vm::Workspace workspace;
    RegionScratch scratch;
    for (const double reach : {1.05, 8.0}) {  // some of them outside
      Sample at = sample(kMostPoints, reach, seed);
      const glm::dvec3 middle = (box.lo + box.hi) / 2.0, half = (box.hi - box.lo) / 2.0;
      for (std::size_t i = 0; i < kMostPoints; ++i) {
        at.x[i] = static_cast<float>(middle.x) + at.x[i] * static_cast<float>(half.x);
        at.y[i] = static_cast<float>(middle.y) + at.y[i] * static_cast<float>(half.y);
        at.z[i] = static_cast<float>(middle.z) + at.z[i] * static_cast<float>(half.z);
      }
      std::vector<float> whole(kMostPoints), part(kMostPoints);
      vm::evaluate_distance(program, at.points(), kMostPoints, whole.data(), workspace);
      regions->evaluate(at.points(), kMostPoints, part.data(), scratch, workspace);
      for (std::size_t i = 0; i < kMostPoints; ++i) {
        const Regions::Region region = regions->region({at.x[i], at.y[i], at.z[i]});
        const float limit = static_cast<float>(region.limit);
        const bool right =
            region.part.words.empty() ? part[i] <= whole[i] && part[i] > 0 : part[i] == std::min(whole[i], limit);
        if (!right && wrong++ < 3) {
          FAIL_CHECK(fmt::format("seed {}, {} {} {}: {} is neither the field, {}, nor its limit", seed, at.x[i],
                                 at.y[i], at.z[i], part[i], whole[i]));
        }
        cut += part[i] < whole[i];
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(built > static_cast<std::size_t>(test::few(40)));
  CHECK(cut > static_cast<std::size_t>(test::few(1000)));
}

TEST_CASE("regions: gradients and surfaces are the whole program's", "[regions]") {
  const compiler::CompiledScene scene = tests::compiled(many(400, true, true, true));
  const Field field = with_regions(scene);
  const Sample at = sample(40000, 1.1, 3);
  vm::Workspace workspace;
  std::size_t near = 0;
  for (std::size_t first = 0; first + 100 <= at.x.size(); first += 100) {
    struct Values {
      std::vector<float> d = std::vector<float>(100), gx = d, gy = d, gz = d;
      std::vector<std::uint32_t> surface = std::vector<std::uint32_t>(100);
      vm::SurfaceValues out() { return {d.data(), gx.data(), gy.data(), gz.data(), surface.data()}; }
    } a, b;
    const vm::Points points{at.x.data() + first, at.y.data() + first, at.z.data() + first};
    vm::evaluate_surface(scene.surface, points, 100, a.out(), workspace);
    field.regions->evaluate_surface(points, 100, b.out(), workspace);
    for (std::size_t i = 0; i < 100; ++i) {
      if (a.d[i] > 0.005f) continue;  // beyond the limits nothing is promised
      ++near;
      CHECK(a.d[i] == b.d[i]);
      CHECK(a.surface[i] == b.surface[i]);
      CHECK((a.gx[i] == b.gx[i] && a.gy[i] == b.gy[i] && a.gz[i] == b.gz[i]));
    }
  }
  CHECK(near > 1000);
}

TEST_CASE("regions: the same tree for any number of threads, the same values on every instruction set", "[regions]") {
  const compiler::CompiledScene scene = tests::compiled(many(400, true, false, false));
  const Sample at = sample(kMostPoints, 1.1, 5);
  std::vector<std::uint32_t> expected;
  const std::string before(vm::isa_name());
  for (const std::string_view isa : vm::available_isas()) {
    vm::force_isa(isa);
    for (const int threads : {1, 3}) {
      const Field field = with_regions(scene, {.threads = threads});
      vm::Workspace workspace;
      RegionScratch scratch;
      std::vector<float> values(kMostPoints);
      field.regions->evaluate(at.points(), kMostPoints, values.data(), scratch, workspace);
      std::vector<std::uint32_t> bits;
      for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value + 0.0f));
      const Regions::Facts& facts = field.regions->facts();
      for (const std::size_t n : {facts.far, facts.programs, facts.skeletons, facts.bytes}) {
        bits.push_back(static_cast<std::uint32_t>(n));
      }
      if (expected.empty()) expected = bits;
      INFO(isa << " " << threads);
      CHECK(bits == expected);
    }
  }
  vm::force_isa(before);
}

TEST_CASE("regions: stay within the memory they are given", "[regions]") {
  const compiler::CompiledScene scene = tests::compiled(many(400, true, false, false));
  const std::size_t freely = with_regions(scene).regions->facts().bytes;
  std::size_t built = 0;
  for (const std::size_t share : {1, 2, 4, 8, 64}) {
    Field field = make_field(scene);
    add_regions(field, scene, {.memory = freely / share});
    if (!field.regions) continue;
    ++built;
    CHECK(field.regions->facts().bytes <= freely / share);
  }
  CHECK(built >= 2);
  CHECK(built < 5);
}

TEST_CASE("regions: rays meet what they meet without them", "[regions]") {
  const compiler::CompiledScene scene = tests::compiled(many(400, true, true, true));
  const Field cut = with_regions(scene);
  Field whole = make_field(scene);
  whole.convex = false;  // to save its evaluations another way
  Random random(11);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    rays.push_back({random.in_box(1.5), random.direction()});
  }
  for (const Method method : {Method::Tiered, Method::Sphere}) {
    const MarchResult a = march(whole, rays, {.method = method}), b = march(cut, rays, {.method = method});
    std::size_t different = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Arrival &x = a.arrivals[i], &y = b.arrivals[i];
      const bool same = x.status == y.status && (x.status != Arrival::Status::Hit ||
                                                 std::abs(x.t - y.t) < (method == Method::Tiered ? 1e-5 : 1e-3));
      different += !same;
    }
    // A sliver between two samples may be seen by one and not by the other (docs/ACCURACY.md), and what passes a
    // surface at just about epsilon is a hit of sphere tracing or not.
    CHECK(different <= (method == Method::Tiered ? 2 : 20));
    CHECK(b.counters.instructions < a.counters.instructions / 5);
    if (method == Method::Tiered) CHECK(b.counters.region_programs > 0);
  }
}

TEST_CASE("regions: small scenes have none, and scenes that cannot be cut", "[regions]") {
  const auto regions_of = [](const std::string& text) {
    const compiler::CompiledScene scene = tests::compiled(text);
    Field field = make_field(scene);
    add_regions(field, scene, {});
    return field.regions != nullptr;
  };
  CHECK_FALSE(regions_of(many(20, false, false, false)));
  CHECK(regions_of(many(400, false, false, false)));
}
