// Regions: the same bits as the whole program, and the same image with and without them.
#include "runtime/field/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "compiler/lower/fuse.h"
#include "compiler/shapes/bounds.h"
#include "runtime/field/field.h"
#include "runtime/march/march.h"
#include "runtime/path/surface.h"
#include "runtime/render.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::regions_test {

namespace {

using namespace fathom;
using namespace fathom::runtime;
using test::Random;

std::string place(Random& random, double half) {
  return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", random.uniform(-half, half), random.uniform(-half, half),
                     random.uniform(-half, half));
}

// A square of side x side balls, far wider than high.
std::string grid(int side) {
  std::string objects;
  for (int i = 0; i < side * side; ++i) {
    objects +=
        (i > 0 ? ",\n" : "") + fmt::format("{{\"type\": \"sphere\", \"radius\": 1, \"translate\": [{}, 0, {}]}}",
                                           3 * (i % side), 3 * (i / side));
  }
  return "{\"version\": 1, \"objects\": [" + objects + "]}";
}

// A scene of `count` shapes: `blend` blends groups of three, `ground` adds a ground plane, `materials` alternates
// four materials.
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

// Numbers of points at which the two evaluations of a field differ, in float and in double.
struct Differences {
  std::size_t single = 0, real = 0;
  // Numbers of points with the whole program's exact value, with a rounded one, and without any program.
  std::size_t exact = 0, rounded = 0, far = 0;
};

Differences compare(const vm::VerifiedProgram& program, const Regions& regions, const Sample& at) {
  vm::Workspace workspace;
  RegionScratch scratch;
  RealScratch real_scratch;
  std::vector<float> whole(kMaxPoints), level(kMaxPoints), cut(kMaxPoints);
  vm::evaluate_distance(program, at.points(), kMaxPoints, whole.data(), workspace);
  level = whole;
  regions.far_levels().apply(at.points(), kMaxPoints, level.data());
  regions.evaluate(at.points(), kMaxPoints, cut.data(), scratch, workspace);
  Differences found;
  const auto same = [](auto a, auto b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t i = 0; i < kMaxPoints; ++i) {
    const glm::dvec3 p(static_cast<double>(at.x[i]), static_cast<double>(at.y[i]), static_cast<double>(at.z[i]));
    std::uint64_t instructions = 0;
    const double real = regions.far_levels()(vm::evaluate_distance(program, p, workspace), at.x[i], at.y[i], at.z[i]);
    found.single += !same(cut[i], level[i]);
    found.real += !same(regions.evaluate(p, real_scratch, instructions), real);
    found.exact += level[i] == whole[i], found.rounded += level[i] < whole[i];
    found.far += regions.region(p).part.words.empty();
  }
  return found;
}

}  // namespace

// Regression: with regions, rays took other steps, because regions returned less than the distance where nothing was
// near.
TEST_CASE("regions: the whole program's rounded distances, bit for bit, in float and in double", "[field][regions]") {
  for (const bool blend : {false, true}) {
    for (const bool ground : {false, true}) {
      const compiler::CompiledScene scene = test::compiled(many(400, blend, ground, true));
      const Field field = with_regions(scene);
      Differences all;
      for (int seed = 0; seed < test::scaled_cases(24); ++seed) {
        // Inside, around, and far outside.
        const Sample at = sample(kMaxPoints, seed % 3 == 0 ? 1.1 : seed % 3 == 1 ? 3 : 40, seed);
        const Differences some = compare(scene.distance, *field.regions, at);
        all.single += some.single, all.real += some.real;
        all.exact += some.exact, all.rounded += some.rounded, all.far += some.far;
      }
      INFO("blended " << blend << ", on a ground " << ground);
      CHECK(all.single == 0);
      CHECK(all.real == 0);
      CHECK(all.exact > static_cast<std::size_t>(test::scaled_cases(1000)));
      CHECK(all.rounded > static_cast<std::size_t>(test::scaled_cases(1000)));
      CHECK(all.far > static_cast<std::size_t>(test::scaled_cases(100)));
    }
  }
}

TEST_CASE("regions: random scenes of every kind of node are cut without a wrong value", "[field][regions]") {
  std::size_t built = 0, wrong = 0, rounded = 0;
  for (int seed = 0; seed < test::scaled_cases(60); ++seed) {
    Random random(seed);
    test::GraphOptions options;
    options.depth = 5;
    const compiler::Scene scene = test::random_scene(random, options);
    const compiler::NodeFacts known = compiler::analyse(scene.graph)[scene.root];
    const auto fused = vm::verify(compiler::fuse(test::plain_lowering(scene).program()));
    const auto& program = std::get<vm::VerifiedProgram>(fused);
    const bool bounded = known.box.finite() && !known.box.empty();
    const compiler::Box box = bounded ? known.box : compiler::Box::centred(glm::dvec3(3));
    if (!(known.lipschitz > 0) || box.hi.x - box.lo.x > 1e3) continue;
    const auto regions = Regions::build(
        program, box,
        {.always = true, .room = bounded ? 0 : 3, .cancellation = static_cast<float>(known.cancellation)});
    if (!regions) continue;
    ++built;
    for (const double reach : {1.05, 8.0}) {  // some points lie outside
      Sample at = sample(kMaxPoints, reach, seed);
      const glm::dvec3 middle = (box.lo + box.hi) / 2.0, half = (box.hi - box.lo) / 2.0;
      for (std::size_t i = 0; i < kMaxPoints; ++i) {
        at.x[i] = static_cast<float>(middle.x) + at.x[i] * static_cast<float>(half.x);
        at.y[i] = static_cast<float>(middle.y) + at.y[i] * static_cast<float>(half.y);
        at.z[i] = static_cast<float>(middle.z) + at.z[i] * static_cast<float>(half.z);
      }
      const Differences some = compare(program, *regions, at);
      if (some.single + some.real > 0 && wrong++ < 3) {
        FAIL_CHECK(fmt::format("seed {}: {} points differ in float, {} in double", seed, some.single, some.real));
      }
      rounded += some.rounded;
    }
  }
  CHECK(wrong == 0);
  CHECK(built > static_cast<std::size_t>(test::scaled_cases(40)));
  CHECK(rounded > static_cast<std::size_t>(test::scaled_cases(1000)));
}

TEST_CASE("regions: gradients and surfaces are the whole program's", "[field][regions]") {
  const compiler::CompiledScene scene = test::compiled(many(400, true, true, true));
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
      if (a.d[i] > 0.005f) continue;  // beyond this distance gradients may differ
      ++near;
      CHECK(a.d[i] == b.d[i]);
      CHECK(a.surface[i] == b.surface[i]);
      CHECK((a.gx[i] == b.gx[i] && a.gy[i] == b.gy[i] && a.gz[i] == b.gz[i]));
    }
  }
  CHECK(near > 1000);
}

TEST_CASE("regions: the same tree for any number of threads, the same values on every instruction set",
          "[field][regions]") {
  const compiler::CompiledScene scene = test::compiled(many(400, true, false, false));
  const Sample at = sample(kMaxPoints, 1.1, 5);
  std::vector<std::uint32_t> expected;
  const std::string before(vm::isa_name());
  for (const std::string_view isa : vm::available_isas()) {
    vm::force_isa(isa);
    for (const int threads : {1, 3}) {
      const Field field = with_regions(scene, {.threads = threads});
      vm::Workspace workspace;
      RegionScratch scratch;
      std::vector<float> values(kMaxPoints);
      field.regions->evaluate(at.points(), kMaxPoints, values.data(), scratch, workspace);
      std::vector<std::uint32_t> bits;
      for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value + 0.0f));
      const Regions::Summary& summary = field.regions->summary();
      for (const std::size_t n : {summary.far, summary.programs, summary.program_templates, summary.bytes}) {
        bits.push_back(static_cast<std::uint32_t>(n));
      }
      if (expected.empty()) expected = bits;
      INFO(isa << " " << threads);
      CHECK(bits == expected);
    }
  }
  vm::force_isa(before);
}

TEST_CASE("regions: stay within the memory they are given", "[field][regions]") {
  const compiler::CompiledScene scene = test::compiled(many(400, true, false, false));
  const std::size_t freely = with_regions(scene).regions->summary().bytes;
  std::size_t built = 0;
  for (const std::size_t share : {1, 2, 4, 8, 64}) {
    Field field = make_field(scene);
    add_regions(field, scene, {.memory = freely / share});
    if (!field.regions) continue;
    ++built;
    CHECK(field.regions->summary().bytes <= freely / share);
  }
  CHECK(built >= 2);
  CHECK(built < 5);
}

TEST_CASE("regions: building them stops where it is told to", "[field][regions]") {
  const compiler::CompiledScene scene = test::compiled(many(400, true, false, false));
  for (const int threads : {1, 3}) {
    std::atomic<int> asked = 0;
    RegionOptions options{.threads = threads};
    options.interrupted = [&] { return ++asked >= 20; };
    Field field = make_field(scene);
    add_regions(field, scene, options);
    CHECK_FALSE(field.regions);
    CHECK(asked < 20 + threads);
  }
}

TEST_CASE("regions: a small picture is not worth building them", "[field][regions]") {
  const compiler::CompiledScene scene = test::compiled(many(400, true, false, false));
  Field field = make_field(scene);
  add_regions(field, scene, {.evaluations = 1000});
  CHECK_FALSE(field.regions);
  add_regions(field, scene, {.evaluations = 1e9});
  CHECK(field.regions);
}

TEST_CASE("regions: rays meet what they meet without them, to the bit", "[field][regions]") {
  const compiler::CompiledScene scene = test::compiled(many(400, true, true, true));
  const Field cut = with_regions(scene), whole = make_field(scene);
  Random random(11);
  std::vector<Ray> rays;
  for (int i = 0; i < test::scaled_cases(10000); ++i) {
    rays.push_back({random.in_box(1.5), random.direction()});
  }
  for (const Method method : {Method::Tiered, Method::Sphere}) {
    const MarchResult a = march(whole, rays, {.method = method}), b = march(cut, rays, {.method = method});
    std::size_t different = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const RayHit &x = a.ray_hits[i], &y = b.ray_hits[i];
      different += x.status != y.status || x.side != y.side || x.t != y.t || x.width != y.width ||
                   x.evaluations != y.evaluations || x.certified != y.certified;
    }
    CHECK(different == 0);
    CHECK(b.counters.instructions < a.counters.instructions / 5);
    if (method == Method::Tiered) CHECK(b.counters.region_programs > 0);
  }
}

// Under emulation a picture of 1200 shapes takes minutes.
compiler::CompiledScene large_scene() {
  return test::compiled(many(test::few_cases() ? 400 : 1200, true, true, true));
}

// The middle of an image that is large enough for regions to pay off.
RenderOptions part_of_picture() {
  RenderOptions options;
  options.width = 768, options.height = 512, options.spp = 2, options.threads = 1;
  options.crop = {376, 252, 392, 260};
  return options;
}

// Regression: regions reached their memory limit late enough for another attempt with 1 and 2 threads, but not with
// more. Images with large regions, small ones and none were different.
TEST_CASE("regions: one picture with and without them, near the limit of memory, for any number of threads",
          "[field][regions]") {
  const compiler::CompiledScene scene = large_scene();
  const std::size_t freely = with_regions(scene).regions->summary().bytes;
  RenderOptions options = part_of_picture();
  options.regions = false;
  const std::uint64_t expected = render(scene, options).film.hash();
  options.regions = true;
  std::size_t least = freely, most = 0;
  for (const std::size_t memory : {freely * 2, freely * 9 / 10, freely / 2, freely / 100}) {
    std::vector<std::size_t> bytes;
    for (const int threads : test::few_cases() ? std::vector{1, 3} : std::vector{1, 2, 3, 7}) {
      options.threads = threads, options.region_memory = memory;
      const RenderResult result = render(scene, options);
      CHECK(result.film.hash() == expected);
      bytes.push_back(result.stats.region_bytes);
    }
    INFO(memory << " bytes");
    CHECK(bytes == std::vector<std::size_t>(bytes.size(), bytes[0]));
    least = std::min(least, bytes[0]), most = std::max(most, bytes[0]);
  }
  CHECK(least == 0);
  CHECK(most > 0);
}

// Regression: a time limit did not stop the building of regions, which takes up to half a minute. Another limit gave
// other regions, so a resumed render counted other costs.
TEST_CASE("regions: a limit of time ends building them, except where costs are kept", "[field][regions]") {
  const compiler::CompiledScene scene = large_scene();
  RenderOptions options = part_of_picture();
  const RenderResult freely = render(scene, options);
  options.time_limit = 1000;
  CHECK(render(scene, options).stats.region_bytes == freely.stats.region_bytes);
  options.time_limit = 1e-9;
  CHECK(render(scene, options).stats.region_bytes == 0);
  options.layers.cost = true;
  CHECK(render(scene, options).stats.region_bytes == freely.stats.region_bytes);
  CHECK(freely.stats.region_bytes > 0);
}

// Regression: building took ten times the allowed memory. A cell keeps its pruned program until the cell is split,
// and in a wide scene each cell of the first levels keeps most of the program.
TEST_CASE("regions: scenes that take many times their memory to build have none", "[field][regions][released]") {
  const compiler::CompiledScene scene = test::compiled(grid(100));
  const auto facts_of = [&](std::size_t memory) {
    const auto regions = Regions::build(scene.surface, scene.contents, {.memory = memory});
    return regions ? regions->summary() : Regions::Summary{};
  };
  const Regions::Summary freely = facts_of(64u << 20), less = facts_of(freely.building * 3 / 4);
  CHECK(freely.bytes > 0);
  CHECK((less.bytes > 0 && less.bytes <= freely.bytes));
  CHECK(facts_of(freely.building / 2 - 1).bytes == 0);
}

TEST_CASE("regions: small scenes have none, and scenes that cannot be cut", "[field][regions]") {
  const auto regions_of = [](const std::string& text) {
    const compiler::CompiledScene scene = test::compiled(text);
    Field field = make_field(scene);
    add_regions(field, scene, {});
    return field.regions != nullptr;
  };
  CHECK_FALSE(regions_of(many(20, false, false, false)));
  CHECK(regions_of(many(400, false, false, false)));
}

}  // namespace fathom::regions_test
