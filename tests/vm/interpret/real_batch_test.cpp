// Compares evaluation of many points in double with evaluation of one point at a time: same bits on every instruction
// set and at every position in a block.
#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/emitted_programs.h"
#include "tests/vm/interpret/formula.h"
#include "tests/vm/number/float_bits.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::real_batch_test {
namespace {

struct RealCloud {
  std::vector<double> x, y, z;

  vm::RealPoints from(std::size_t first) const { return {x.data() + first, y.data() + first, z.data() + first}; }
};

// Ordinary points. Every so often a coordinate is an extreme or special double.
RealCloud spicy_cloud(Random& random, std::size_t count) {
  constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
  static const double kSpice[] = {0.,   -0.,  5e-324, -1e-310, 1e-200, 1.5,   0x1.fffffffffffffp-1,
                                  1e19, -1e5, 1e155,  -1e300,  kInf,   -kInf, kNan};
  RealCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    double p[3];
    for (double& c : p) c = random.uniform(-2, 2);
    if (random.chance(0.2)) p[random.below(3)] = kSpice[random.below(static_cast<int>(std::size(kSpice)))];
    cloud.x.push_back(p[0]), cloud.y.push_back(p[1]), cloud.z.push_back(p[2]);
  }
  return cloud;
}

// Bits of a double. All NaNs count as equal, since IEEE 754 leaves their sign and payload to the processor.
std::uint64_t real_bits(double d) {
  return std::bit_cast<std::uint64_t>(std::isnan(d) ? std::numeric_limits<double>::quiet_NaN() : d);
}

// Checks a program on every instruction set, from several start indices and for several counts.
void check_bits(const vm::VerifiedProgram& program, std::uint64_t seed, std::size_t points = 150) {
  const IsaGuard guard;
  Random random(seed);
  vm::Workspace workspace;
  const RealCloud cloud = spicy_cloud(random, points);
  std::vector<std::uint64_t> alone;
  for (std::size_t i = 0; i < points; ++i) {
    const double d = vm::evaluate_distance(program, glm::dvec3(cloud.x[i], cloud.y[i], cloud.z[i]), workspace);
    alone.push_back(real_bits(d));
  }
  std::vector<double> together(points + 1);
  for (std::string_view isa : vm::available_isas()) {
    REQUIRE(vm::force_isa(isa));
    for (const std::size_t count : {points, std::size_t{1}, std::size_t{7}, std::size_t{8}, points / 2 + 1}) {
      const std::size_t first = static_cast<std::size_t>(random.below(static_cast<int>(points - count) + 1));
      together[count] = 42;
      vm::evaluate_distance(program, cloud.from(first), count, together.data(), workspace);
      INFO(isa << ", points " << first << " and " << count << " on");
      CHECK(together[count] == 42);
      for (std::size_t i = 0; i < count; ++i) {
        if (real_bits(together[i]) == alone[first + i]) continue;
        const double px = cloud.x[first + i], py = cloud.y[first + i], pz = cloud.z[first + i];
        INFO("at " << px << ' ' << py << ' ' << pz);
        FAIL_CHECK("together " << together[i] << ", alone " << std::bit_cast<double>(alone[first + i]));
        return;
      }
    }
  }
}

}  // namespace

TEST_CASE("in double, one point at a time or many: the same bits of every opcode", "[interpret][evaluate][isa]") {
  const std::vector<EmittedProgram> programs = emitted_programs();
  for (std::size_t n = 0; n < programs.size(); ++n) {
    INFO(programs[n].name);
    check_bits(programs[n].scene.distance, n);
  }
}

TEST_CASE("in double, one point at a time or many: the same bits of random formulas", "[interpret][evaluate][isa]") {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const std::vector<Step> steps = random_formula(seed);
    INFO(text_of(steps));
    check_bits(formula(steps), seed, 40);
  }
}

TEST_CASE("in double, one point at a time or many: the same bits of the scenes that come with Fathom",
          "[interpret][evaluate][isa]") {
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(FATHOM_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "d10000") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    INFO(entry.path());
    check_bits(test::compiled(text.str()).distance, 1, 60);
  }
}

}  // namespace fathom::test::real_batch_test
